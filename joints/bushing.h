#pragma once

/// \file
/// Compliant joint of two rigid bodies.

#include <carom/core/export.h>
#include <carom/core/force_element.h>

#include <string_view>
#include <vector>

namespace carom {

namespace generic {

/// Compliant joint between points of two rigid bodies, or one and the ground, elastic in all directions at
/// once. In the frame of the body `from`,
///
///     d = (R^T (x_to - x_from), angle_to - angle_from) - rest,     V = d^T K d / 2,
///
/// with R the rotation of `from`. The force -R (K d)_xy acts on `to` at its point, and so does the torque
/// -(K d)_angle. The opposites act on `from`, the force at the same point of space (the point of `to`): this
/// is the gradient of V (R turns with `from`), and moments balance. The dashpot acts in the same places with
/// C times the rate of d in the place of K d.
template <int D>
struct CAROM_API Bushing {
  static constexpr Role role = Role::force;
  static constexpr int dimension = D;
  static constexpr int coordinates = D == 2 ? 3 : 6;  ///< of d
  static constexpr std::string_view label = "bushing";
  static constexpr StoredEnergy stored = StoredEnergy::elastic;
  static constexpr bool depends_on_time = false;
  /// Its type, for System::add().
  [[nodiscard]] static PartType<ForceKind> part_type();

  End<D> from{};  ///< a rigid body or ground, whose frame is that of K and C (required)
  End<D> to{};    ///< a rigid body or ground (required)
  /// K over (x, y, angle), symmetric, no eigenvalue < 0 [N/m, N/rad; N m/m, N m/rad]
  Mat<coordinates> stiffness = filled_matrix<coordinates>(0.0);
  Mat<coordinates> damping = filled_matrix<coordinates>(0.0);  ///< C over (x, y, angle) [units of K, times s]
  Vec<coordinates> rest = filled<coordinates>(0.0);  ///< is subtracted from d: the unloaded state [m, m, rad]

  /// The bodies that it connects.
  [[nodiscard]] std::vector<BodyId> bodies() const { return {from.body, to.body}; }
  /// Throws ModelError for invalid ends or matrices.
  void check(const PartCheck& check) const;
  /// Books spring and dashpot.
  void loads(const ElementView<D>& at, ElementLoads<D>& out) const;
  /// Books spring and dashpot over a step: with the mean of the axes of the frame, and the increase of d for
  /// its rate, the work of the loads is exactly the decrease of the potential.
  void mean_loads(const ElementStep<D>& step, ElementLoads<D>& out) const;
  /// Derivatives. With B = dd/ds over the coordinates s of both bodies, the load is -B^T w, w = K d + C
  /// dd/dt; it changes with d, with dd/dt = B ds/dt, and with B.
  void derivatives(const ElementView<D>& at, ElementDerivatives<D>& out) const;
  /// d^T K d / 2 [J].
  [[nodiscard]] double potential(const ElementView<D>& at) const;
  /// Adds ends and numbers.
  void fingerprint(Fingerprint& print) const;
};

}  // namespace generic

namespace planar {
using Bushing = generic::Bushing<2>;  ///< generic::Bushing in the plane
}

}  // namespace carom
