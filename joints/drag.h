#pragma once

/// \file
/// Resistance of a medium at rest.

#include <carom/core/force_element.h>

#include <vector>

namespace carom {

namespace generic {

/// Viscous and quadratic drag at an end, with v its velocity in the fixed frame: F = -(c1 + c2 |v|) v. It
/// dissipates the power (c1 + c2 |v|) |v|^2 >= 0.
template <int D>
struct Drag {
  static constexpr Role role = Role::force;
  static constexpr int dimension = D;
  static constexpr std::string_view label = "drag";
  static constexpr bool depends_on_time = false;
  /// Its type, for System::add().
  [[nodiscard]] CAROM_API static PartType<ForceKind> part_type();

  End<D> on{};             ///< body, or body and point (required)
  double linear = 0.0;     ///< c1 >= 0 [N s/m]
  double quadratic = 0.0;  ///< c2 >= 0 [N s^2/m^2]

  /// The body that it acts on.
  [[nodiscard]] std::vector<BodyId> bodies() const { return {on.body}; }
  /// Throws ModelError for an invalid end or invalid numbers.
  void check(const PartCheck& check) const {
    check_end(check, on, "on");
    check.non_negative(linear, "linear", "N s/m");
    check.non_negative(quadratic, "quadratic", "N s^2/m^2");
  }
  /// Books the load.
  void loads(const ElementView<D>& at, ElementLoads<D>& out) const {
    const Vec<D> velocity = at.velocity(on);
    out.dissipative(on, -(linear + quadratic * velocity.norm()) * velocity);
  }
  /// Derivatives.
  void derivatives(const ElementView<D>& at, ElementDerivatives<D>& out) const {
    const Vec<D> velocity = at.velocity(on);
    const double speed = velocity.norm();
    const double resistance = linear + quadratic * speed;
    Mat<D> by_velocity = -resistance * Mat<D>::Identity();
    if (speed > 0.0) by_velocity -= (quadratic / speed) * velocity * velocity.transpose();
    out.force(on, -resistance * velocity, Mat<D>::Zero(), by_velocity);
  }
  /// Adds the end and the numbers.
  void fingerprint(Fingerprint& print) const {
    add_to(print, on);
    print.add(linear);
    print.add(quadratic);
  }
};

}  // namespace generic

namespace planar {
using Drag = generic::Drag<2>;  ///< generic::Drag in the plane
}
namespace spatial {
using Drag = generic::Drag<3>;  ///< generic::Drag in space
}

}  // namespace carom
