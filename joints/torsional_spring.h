#pragma once

/// \file
/// Torsional spring with a dashpot in parallel.

#include <carom/core/export.h>
#include <carom/core/force_element.h>
#include <carom/joints/line_of_action.h>
#include <carom/joints/mean_line.h>

#include <vector>

namespace carom::planar {

/// Torsional spring-dashpot between two rigid bodies, or one and the ground: with the angle a of `to`
/// relative to `from`, the torque on `to` is -(k (a - A) + c da/dt), and the opposite acts on `from`. Full
/// turns count: after one turn the spring is wound up by 2 pi.
struct CAROM_API TorsionalSpring {
  static constexpr Role role = Role::force;
  static constexpr int dimension = 2;
  static constexpr std::string_view label = "torsional spring";
  static constexpr StoredEnergy stored = StoredEnergy::elastic;
  static constexpr bool depends_on_time = false;
  /// Its type, for System::add().
  [[nodiscard]] static PartType<ForceKind> part_type();

  BodyId from{};            ///< a rigid body or ground (required)
  BodyId to{};              ///< a rigid body or ground (required)
  double stiffness = 0.0;   ///< k >= 0 [N m/rad]
  double damping = 0.0;     ///< c >= 0 [N m s/rad]
  double free_angle = 0.0;  ///< A, counter-clockwise [rad]

  /// The bodies that it connects.
  [[nodiscard]] std::vector<BodyId> bodies() const;
  /// Throws ModelError for invalid bodies or numbers.
  void check(const PartCheck& check) const;
  /// Books spring and dashpot.
  void loads(const ElementView<2>& at, ElementLoads<2>& out) const;
  /// Books spring and dashpot over a step.
  void mean_loads(const ElementStep<2>& step, ElementLoads<2>& out) const;
  /// Derivatives.
  void derivatives(const ElementView<2>&, ElementDerivatives<2>& out) const;
  /// k (a - A)^2 / 2 [J].
  [[nodiscard]] double potential(const ElementView<2>& at) const;
  /// Adds the numbers.
  void fingerprint(Fingerprint& print) const;
};

}  // namespace carom::planar
