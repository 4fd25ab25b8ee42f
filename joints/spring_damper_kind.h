#pragma once

/// \file
/// The kind of spring-dampers.

#include <carom/core/column.h>
#include <carom/core/force_kind.h>
#include <carom/core/numerics/pair.h>
#include <carom/joints/spring_damper.h>

#include <memory>
#include <span>
#include <string_view>
#include <vector>

namespace carom::generic {

/// All spring-dampers of a system.
template <int D>
class CAROM_API SpringDamperKind final : public ForceKind {
public:
  static constexpr int part_dimension() { return D; }
  static constexpr std::string_view part_label() { return "spring-damper"; }

  /// Checks and stores a spring. Throws ModelError.
  void add(const SpringDamper<D>& part, const PartCheck& check);

  [[nodiscard]] std::unique_ptr<ForceKind> clone() const override;
  [[nodiscard]] std::unique_ptr<ForceKind> arranged(std::span<const Index> order,
                                                    const Layout& layout) const override;
  void remove(Index slot) override;
  [[nodiscard]] std::string_view label() const override { return part_label(); }
  [[nodiscard]] int dimension() const override { return D; }
  [[nodiscard]] Index size() const override { return stiffness_.size(); }
  void ends(Index element, std::vector<BodyId>& out) const override;
  [[nodiscard]] StoredEnergy stored_as() const override { return StoredEnergy::elastic; }
  [[nodiscard]] bool books_external() const override { return false; }
  [[nodiscard]] bool needs_rotations() const override { return !ends_.empty(); }
  void evaluate(const EvaluationContext& at, Range elements, const Loads& loads) const override;
  [[nodiscard]] double potential(const EvaluationContext& at, Range elements) const override;
  double evaluate_with_potential(const EvaluationContext& at, Range elements,
                                 const Loads& loads) const override;
  void evaluate_mean(const StepContext& at, Range elements, const Loads& loads) const override;
  [[nodiscard]] bool uses_middle() const override { return false; }
  [[nodiscard]] bool depends_on_time() const override { return false; }
  void derivatives(const EvaluationContext& at, Index element,
                   std::vector<LoadDerivative>& out) const override;
  [[nodiscard]] bool has_derivatives() const override { return true; }
  [[nodiscard]] Index first_without_direction(const EvaluationContext& at, Range elements,
                                              double fastest) const override;
  void fingerprint(Fingerprint& print) const override;

private:
  /// Points off the centre of mass, of a described spring.
  struct Points {
    Index element;
    Vec<D> from, to;
  };
  /// Ends of an arranged spring that are not both centres of mass with equal places in q and v.
  struct Ends {
    Index element;
    Attachment<D> from, to;
  };

  [[nodiscard]] SpringDamper<D> described(Index element) const;
  [[nodiscard]] Ends ends_of(Index element) const;
  /// Calls centres(range) and other(ends) for the springs of a range, in order.
  template <class Centres, class Other>
  void for_springs(Range elements, Centres&& centres, Other&& other) const;
  template <bool Together, bool WithPotential>
  double sweep(const EvaluationContext& at, Range elements, const Loads& loads) const;
  template <bool Together, bool WithPotential>
  void sweep_centres(const StateView& state, Range elements, const Loads& loads, PairSum& potential) const;

  // By element. Ends: serial numbers of the bodies as described, first coordinates and velocities arranged.
  Column<double> stiffness_, damping_, free_length_;
  std::vector<Index> from_, to_;
  const Layout* layout_ = nullptr;  // arranged, of the assembly that owns this kind
  Index token_ = 0;                 // of the bodies' identities
  std::vector<Points> points_;      // described, by element
  std::vector<Ends> ends_;          // arranged, by element
};

extern template class SpringDamperKind<2>;
extern template class SpringDamperKind<3>;

}  // namespace carom::generic
