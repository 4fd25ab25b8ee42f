#pragma once

/// \file
/// Rigid bodies: position of the centre of mass and orientation.

#include <carom/bodies/mass_properties.h>
#include <carom/core/body_kind.h>
#include <carom/core/part.h>
#include <carom/core/part_check.h>
#include <carom/core/space.h>

#include <vector>

namespace carom {

namespace generic {

/// A rigid body. The origin of its frame is the centre of mass. Without shapes it has no contacts.
template <int D>
struct RigidBody;

/// In the plane. Coordinates: position and angle; velocities: velocity and spin.
template <>
struct RigidBody<2> {
  static constexpr Role role = Role::body;
  /// Its type, for System::add().
  [[nodiscard]] CAROM_API static PartType<BodyKind> part_type();

  MassProperties<2> mass{};          ///< made by disc(), rod(), ... (required)
  Vec<2> position = filled<2>(0.0);  ///< of the centre of mass, at the start [m]
  double angle = 0.0;                ///< at the start, counter-clockwise [rad]
  Vec<2> velocity = filled<2>(0.0);  ///< of the centre of mass, at the start [m/s]
  double spin = 0.0;                 ///< at the start, counter-clockwise [rad/s]
};

}  // namespace generic

namespace planar {
using RigidBody = generic::RigidBody<2>;  ///< generic::RigidBody in the plane
}

}  // namespace carom
