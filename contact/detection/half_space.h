#pragma once

/// \file
/// Half-planes and half-spaces: shapes on ground, where a half-plane may move as prescribed.

#include <carom/contact/detection/prescribed_motion.h>
#include <carom/core/ground_shape_kind.h>
#include <carom/core/part.h>
#include <carom/core/part_check.h>
#include <carom/core/space.h>

#include <cmath>
#include <limits>
#include <vector>

namespace carom {

namespace generic {

/// Everything behind a plane is solid.
template <int D>
struct HalfSpace {
  static constexpr Role role = Role::obstacle;
  /// Its type, for System::add().
  [[nodiscard]] CAROM_API static PartType<GroundShapeKind> part_type();

  Vec<D> point = filled<D>(0.0);                                        ///< a point of the boundary [m]
  Vec<D> normal = filled<D>(std::numeric_limits<double>::quiet_NaN());  ///< into free space, any length > 0
  MaterialId material{};                                                ///< for laws between materials
  ContactFilter filter{};                                               ///< what it may touch
};

/// Everything behind a line is solid; the line may move.
template <>
struct HalfSpace<2> {
  static constexpr Role role = Role::obstacle;
  /// Its type, for System::add().
  [[nodiscard]] CAROM_API static PartType<GroundShapeKind> part_type();

  Vec<2> point = filled<2>(0.0);  ///< a point of the boundary, about which it turns [m]
  Vec<2> normal = filled<2>(std::numeric_limits<double>::quiet_NaN());  ///< into free space, any length > 0
  MaterialId material{};                                                ///< for laws between materials
  planar::PrescribedMotion motion{};  ///< of `point`, and about it; empty: at rest
  double surface_speed =
      0.0;                 ///< of a conveyor along itself; positive to the right of who stands on it [m/s]
  ContactFilter filter{};  ///< what it may touch
};

}  // namespace generic

namespace planar {

using HalfPlane = generic::HalfSpace<2>;  ///< generic::HalfSpace in the plane

/// Normal of a plane through which the ground rises with +x at the angle `slope` [rad].
[[nodiscard]] inline Vec<2> incline(double slope) { return {-std::sin(slope), std::cos(slope)}; }

}  // namespace planar

namespace spatial {
using HalfSpace = generic::HalfSpace<3>;  ///< generic::HalfSpace in space
}

}  // namespace carom
