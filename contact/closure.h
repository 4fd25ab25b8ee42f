#pragma once

/// \file
/// Projection of a state onto the constraints of joints and closed contacts, by the smallest change in the
/// sense of the masses.

#include <carom/core/export.h>
#include <carom/integrators/event_driven/motion_sample.h>
#include <carom/integrators/event_driven/smooth_motion.h>

#include <span>
#include <string>
#include <vector>

namespace carom {

/// Result of a projection.
struct ConstraintProjection {
  bool changed = false;  ///< the state was
  double lost = 0.0;     ///< energy taken out [J]
  /// Kinetic energy of the change of velocities [J]: positive, and what it took where nothing is prescribed.
  double velocity_energy = 0.0;
  double shift = 0.0;  ///< largest displacement [m]
};

/// Finds the smallest changes that take a sample onto the constraints: MotionMemory::of_position and
/// of_velocity. False where there is nothing to change. \param at the sample that the motion made last
[[nodiscard]] CAROM_API bool find_corrections(SmoothMotion& motion, const MotionSample& at);

/// Projects y. \param at the sample of y that the motion made last; it is out of date if y was changed
CAROM_API ConstraintProjection project_onto_constraints(SmoothMotion& motion, const MotionSample& at,
                                                        std::span<double> y);

/// Names of the joints that change the velocities of a sample most in a projection, else of the closed
/// contacts. \param at the sample that the motion made last
[[nodiscard]] CAROM_API std::vector<std::string> causes_of_projection(SmoothMotion& motion,
                                                                      const MotionSample& at);

}  // namespace carom
