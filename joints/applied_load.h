#pragma once

/// \file
/// Prescribed forces and torques, functions of time.

#include <carom/core/export.h>
#include <carom/core/force_element.h>

#include <cmath>
#include <functional>
#include <string_view>
#include <vector>

namespace carom {

namespace generic {

/// A force at an end, a given function of time, in the fixed frame. Its work is external work.
template <int D>
struct AppliedForce {
  static constexpr Role role = Role::force;
  static constexpr int dimension = D;
  static constexpr std::string_view label = "applied force";
  /// Its type, for System::add().
  [[nodiscard]] CAROM_API static PartType<ForceKind> part_type();

  End<D> on{};                                 ///< body, or body and point (required)
  std::function<Vec<D>(double time)> force{};  ///< [N] (required)
  std::vector<double> breaks{};  ///< when the function of time jumps or has a kink, ascending [s]

  /// The body that it acts on.
  [[nodiscard]] std::vector<BodyId> bodies() const { return {on.body}; }
  /// Throws ModelError for an invalid end or function.
  void check(const PartCheck& check) const {
    check_end(check, on, "on");
    if (!force) check.refuse("force", "not given", "a function of time");
    const Vec<D> start = force(0.0);
    check.finite({start.data(), static_cast<std::size_t>(D)}, "force at time 0", "N");
  }
  /// Books the load.
  void loads(const ElementView<D>& at, ElementLoads<D>& out) const { out.external(on, force(at.time())); }
  /// Derivatives: the lever of a point away from the centre of mass turns with the body.
  void derivatives(const ElementView<D>& at, ElementDerivatives<D>& out) const {
    out.force(on, force(at.time()), Mat<D>::Zero(), Mat<D>::Zero());
  }
  /// Adds the end (a function cannot be hashed).
  void fingerprint(Fingerprint& print) const { add_to(print, on); }
};

}  // namespace generic

namespace planar {

using AppliedForce = generic::AppliedForce<2>;  ///< generic::AppliedForce in the plane

/// A torque on a rigid body, a given function of time. Its work is external work.
struct CAROM_API AppliedTorque {
  static constexpr Role role = Role::force;
  static constexpr int dimension = 2;
  static constexpr std::string_view label = "applied torque";
  /// Its type, for System::add().
  [[nodiscard]] static PartType<ForceKind> part_type();

  BodyId on{};                                  ///< a rigid body (required)
  std::function<double(double time)> torque{};  ///< counter-clockwise [N m] (required)
  std::vector<double> breaks{};  ///< when the function of time jumps or has a kink, ascending [s]

  /// The body that it acts on.
  [[nodiscard]] std::vector<BodyId> bodies() const;
  /// Throws ModelError for an invalid body or function.
  void check(const PartCheck& check) const;
  /// Books the load.
  void loads(const ElementView<2>& at, ElementLoads<2>& out) const;
  /// Derivatives: none, the torque depends on time only.
  void derivatives(const ElementView<2>&, ElementDerivatives<2>&) const;
  /// Adds nothing to the identity of the body (a function cannot be hashed).
  void fingerprint(Fingerprint&) const;
};

}  // namespace planar

namespace spatial {
using AppliedForce = generic::AppliedForce<3>;  ///< generic::AppliedForce in space
}

}  // namespace carom
