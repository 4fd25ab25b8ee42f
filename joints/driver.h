#pragma once

/// \file
/// Parts that act on the coordinate of a joint: drivers prescribe it, motors apply a load along it,
/// stops limit it.

#include <carom/core/force_kind.h>
#include <carom/core/joint_kind.h>
#include <carom/core/part.h>
#include <carom/joints/actuator.h>

#include <functional>
#include <limits>
#include <string_view>
#include <vector>

namespace carom {

/// Prescribes the coordinate of a joint as a function of time. Its work is external work. Rates that are not
/// given are computed by differences (core/numerics/time_difference.h); functions must then be smooth between
/// breaks.
struct Driver {
  static constexpr Role role = Role::joint;
  /// Its type, for System::add().
  [[nodiscard]] CAROM_API static PartType<JointKind> part_type();

  JointId joint{};                                    ///< whose coordinate (required)
  std::function<double(double time)> position{};      ///< the coordinate [rad, m] (required)
  std::function<double(double time)> velocity{};      ///< rate of the coordinate
  std::function<double(double time)> acceleration{};  ///< rate of the velocity
  /// When the velocity or acceleration jumps or a function has a kink, ascending [s]. The position is
  /// continuous: a jump of it is a SolverError.
  std::vector<double> breaks{};
};

/// A load along the coordinate of a joint as a function of time, coordinate and rate: the torque on `to` of a
/// revolute joint, the force on `to` along the axis of a prismatic one. Its work is external work.
struct Motor {
  static constexpr Role role = Role::force;
  /// Its type, for System::add().
  [[nodiscard]] CAROM_API static PartType<ForceKind> part_type();

  JointId joint{};               ///< along whose coordinate (required)
  ActuatorLaw torque{};          ///< [N m, N] (required)
  std::vector<double> breaks{};  ///< when the law jumps or has a kink in time, ascending [s]
};

/// Limits of the coordinate of a joint, lower <= x <= upper: unilateral, with a coefficient of restitution,
/// in both modes. The impulse or force of a stop acts along the coordinate, and is positive where it opens
/// the gap.
struct Stop {
  static constexpr Role role = Role::joint;
  /// Its type, for System::add().
  [[nodiscard]] CAROM_API static PartType<JointKind> part_type();

  JointId joint{};                                          ///< whose coordinate (required)
  double lower = -std::numeric_limits<double>::infinity();  ///< [rad, m]; one of the two is required
  double upper = std::numeric_limits<double>::infinity();   ///< [rad, m]
  double restitution = 0.0;                                 ///< e in [0, 1]
};

namespace planar {
using carom::Driver;
using carom::Motor;
using carom::Stop;
}  // namespace planar
namespace spatial {
using carom::Driver;
using carom::Motor;
using carom::Stop;
}  // namespace spatial

}  // namespace carom
