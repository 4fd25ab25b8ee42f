#pragma once

/// \file
/// Linear spring with a dashpot in parallel.

#include <carom/core/end.h>
#include <carom/core/force_kind.h>
#include <carom/core/part.h>

#include <limits>
#include <vector>

namespace carom {

namespace generic {

template <int D>
class SpringDamperKind;

/// Spring and dashpot between two ends, along the line between them: with d from `from` to `to`, l = |d|,
/// the force on `to` is -(k (l - L) + c dl/dt) d/l. At l = 0 the direction is undefined: for L = 0 the
/// spring's force is zero there by continuity, for L > 0 it is set to zero, as is the dashpot's.
template <int D>
struct SpringDamper {
  static constexpr Role role = Role::force;
  using Kind = SpringDamperKind<D>;

  End<D> from{};             ///< required
  End<D> to{};               ///< required
  double stiffness = 0.0;    ///< k >= 0 [N/m]
  double damping = 0.0;      ///< c >= 0 [N s/m]
  double free_length = 0.0;  ///< L >= 0 [m]
};

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
  void remove(Index slot) override { parts_.erase(parts_.begin() + slot); }
  [[nodiscard]] std::string_view label() const override { return part_label(); }
  [[nodiscard]] int dimension() const override { return D; }
  [[nodiscard]] Index size() const override { return static_cast<Index>(parts_.size()); }
  void ends(Index element, std::vector<BodyId>& out) const override;
  [[nodiscard]] StoredEnergy stored_as() const override { return StoredEnergy::elastic; }
  void evaluate(const EvaluationContext& at, Range elements, const Loads& loads) const override;
  [[nodiscard]] double potential(const EvaluationContext& at, Range elements) const override;
  double evaluate_with_potential(const EvaluationContext& at, Range elements,
                                 const Loads& loads) const override;
  void evaluate_mean(const StepContext& at, Range elements, const Loads& loads) const override;
  [[nodiscard]] bool uses_middle() const override { return false; }
  void derivatives(const EvaluationContext& at, Index element,
                   std::vector<LoadDerivative>& out) const override;
  [[nodiscard]] bool has_derivatives() const override { return true; }
  void fingerprint(Fingerprint& print) const override;

private:
  /// A spring between centres of mass; ends that are not centres stand in the side table.
  struct Spring {
    double stiffness, damping, free_length;
    Index from_q, from_v, to_q, to_v;
    Index ends;  ///< place in the side table, `none` if both ends are centres of mass
  };
  struct Ends {
    Attachment<D> from, to;
  };

  [[nodiscard]] Ends ends_of(const Spring& spring) const;
  template <bool Together, bool WithPotential>
  double sweep(const EvaluationContext& at, Range elements, const Loads& loads) const;

  std::vector<SpringDamper<D>> parts_;
  std::vector<Spring> springs_;  // packed for running, empty until arranged
  std::vector<Ends> side_table_;
};

extern template class SpringDamperKind<2>;
extern template class SpringDamperKind<3>;

}  // namespace generic

namespace planar {
using SpringDamper = generic::SpringDamper<2>;
}
namespace spatial {
using SpringDamper = generic::SpringDamper<3>;
}

}  // namespace carom
