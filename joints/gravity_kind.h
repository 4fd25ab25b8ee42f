#pragma once

/// \file
/// The kind of uniform fields.

#include <carom/core/force_kind.h>
#include <carom/joints/gravity.h>

#include <memory>
#include <span>
#include <string_view>
#include <vector>

namespace carom::generic {

/// All uniform fields of a system.
template <int D>
class CAROM_API GravityKind final : public ForceKind {
public:
  static constexpr int part_dimension() { return D; }
  static constexpr std::string_view part_label() { return "gravity"; }

  /// Checks and stores a field. Throws ModelError.
  void add(const Gravity<D>& part, const PartCheck& check);

  [[nodiscard]] std::unique_ptr<ForceKind> clone() const override;
  [[nodiscard]] std::unique_ptr<ForceKind> arranged(std::span<const Index> order,
                                                    const Layout& layout) const override;
  void remove(Index slot) override { parts_.erase(parts_.begin() + slot); }
  [[nodiscard]] std::string_view label() const override { return part_label(); }
  [[nodiscard]] int dimension() const override { return D; }
  [[nodiscard]] Index size() const override { return static_cast<Index>(parts_.size()); }
  [[nodiscard]] bool is_field() const override { return true; }
  void ends(Index, std::vector<BodyId>&) const override {}
  [[nodiscard]] StoredEnergy stored_as() const override { return StoredEnergy::gravity; }
  [[nodiscard]] bool books_external() const override { return false; }
  [[nodiscard]] bool books_dissipative() const override { return false; }
  [[nodiscard]] bool works_in_parts() const override { return true; }
  [[nodiscard]] bool needs_rotations() const override { return false; }
  void evaluate(const EvaluationContext& at, Range elements, const Loads& loads) const override;
  [[nodiscard]] bool uses_middle() const override { return false; }
  [[nodiscard]] bool depends_on_time() const override { return false; }
  [[nodiscard]] bool is_constant() const override { return true; }
  void evaluate_mean(const StepContext& at, Range elements, const Loads& loads) const override {
    evaluate(at.end, elements, loads);  // it is everywhere the same
  }
  [[nodiscard]] double potential(const EvaluationContext& at, Range elements) const override;
  /// Nothing: the load does not depend on position or velocity.
  void derivatives(const EvaluationContext&, Index, std::vector<LoadDerivative>&) const override {}
  [[nodiscard]] bool has_derivatives() const override { return true; }
  void fingerprint(Fingerprint& print) const override;

private:
  std::vector<Gravity<D>> parts_;
};

extern template class GravityKind<2>;
extern template class GravityKind<3>;

}  // namespace carom::generic
