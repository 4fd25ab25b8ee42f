#pragma once

/// \file
/// Sizes below which gaps, velocities and forces of a clock group are rounding, from its state at the start
/// of a phase.

#include <carom/core/constraint.h>
#include <carom/core/export.h>
#include <carom/integrators/event_driven/smooth_motion.h>

#include <span>

namespace carom {

/// Scales of one clock group.
struct EventScales {
  double force = 0.0;           ///< largest load [N]
  double force_rounding = 0.0;  ///< forces that count as zero, against those around them
  double speed = 0.0;           ///< largest velocity [m/s]
  double gap_noise = 0.0;       ///< rounding of gaps [m]
  double speed_noise = 0.0;     ///< velocities that count as zero [m/s]
  double guard_noise = 0.0;     ///< guards nearer to zero than this have not passed it

  /// Tangential velocities of a contact that count as zero [m/s]; of rolling resistance spins [rad/s].
  [[nodiscard]] double noise_of(const SmoothMotion& motion, const Constraint& contact) const;
};

/// Length to which rounding is counted where all coordinates are smaller [m]: of what moves by this much
/// `gap_tolerance` is a billionth. 1 m by default.
[[nodiscard]] CAROM_API double unit_length(const EventDriven& options);
/// Size of the numbers that gaps of a body are made of, for its radius of gyration [m].
[[nodiscard]] inline double size_of_body(double length) { return 2.0 * length; }
/// Gaps above this neither touch nor are captured at an event [m].
[[nodiscard]] inline double near_gap(const EventDriven& options) { return 16.0 * options.gap_tolerance; }
/// A gap this far off the polynomial still counts as found [m].
[[nodiscard]] inline double fine_gap(const EventDriven& options) { return 0.1 * options.gap_tolerance; }
/// Rounding of gaps between places [m]. \param size of their coordinates and of bodies [m]
[[nodiscard]] CAROM_API double gap_noise_of(double size, const EventDriven& options);
/// Velocities that count as zero [m/s]. \param velocity of the motion [m/s] \param absolute_tolerance of the
/// mode
[[nodiscard]] CAROM_API double speed_noise_of(double velocity, double absolute_tolerance);

/// A margin of a feature is found to be zero to this [m].
[[nodiscard]] inline double margin_noise(const EventScales& scales) { return scales.gap_noise / 16.0; }

/// Scales at a state. \param contacts of all pairs there
[[nodiscard]] CAROM_API EventScales event_scales(const SmoothMotion& motion, const MotionSample& at,
                                                 std::span<const Constraint> contacts);

}  // namespace carom
