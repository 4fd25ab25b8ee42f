#pragma once

/// \file
/// Rolling resistance of a planar contact: a moment |M| <= rho P_n against the relative spin of its bodies.

#include <carom/contact/detection/detector.h>
#include <carom/core/constraint.h>
#include <carom/core/export.h>
#include <carom/core/ground_shape_kind.h>

namespace carom {

/// Writes the row of the rolling resistance of a contact, which it follows in every list: the spin of its
/// first body less that of the second, times an arm (Constraint::OfJoint::length), so that the row has
/// velocities in m/s and forces in N as its contact has. The law of the row is that along the spin, with the
/// same coefficient at rest and at any speed. The ground stands still, or turns as `motion` says,
/// null if it is at rest. Bodies without orientation have no spin. `row` may be the contact itself.
CAROM_API void write_rolling_resistance(const Constraint& contact, const GroundMotion* motion,
                                        Constraint& row);
/// Motion of the shape on ground that a contact touches; null if there is none or it is at rest.
[[nodiscard]] CAROM_API const GroundMotion* ground_motion_of(const Detector& detector,
                                                             const Constraint& contact,
                                                             const GroundPlaces& places);

}  // namespace carom
