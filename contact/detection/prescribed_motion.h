#pragma once

/// \file
/// The motion of a shape on ground as given by its user: functions of time.

#include <carom/core/export.h>
#include <carom/core/ground_shape_kind.h>
#include <carom/core/part_check.h>
#include <carom/core/space.h>

#include <functional>
#include <vector>

namespace carom::planar {

/// How a shape on ground moves: its point o by a displacement, about o by an angle. Empty: at rest. Functions
/// must depend on the time alone, not on what was asked before; those not given follow from those that are,
/// accelerations from velocities, else velocities and accelerations from positions, by differences whose
/// accuracy core/numerics/time_difference.h states (they look some milliseconds ahead and back, before time 0
/// too). A fingerprint cannot tell functions apart.
struct CAROM_API PrescribedMotion {
  std::function<Vec<2>(double time)> displacement{};          ///< of o from where it is described [m]
  std::function<Vec<2>(double time)> velocity{};              ///< rate of the displacement [m/s]
  std::function<Vec<2>(double time)> acceleration{};          ///< rate of the velocity [m/s^2]
  std::function<double(double time)> angle{};                 ///< from how it is described [rad]
  std::function<double(double time)> spin{};                  ///< rate of the angle [rad/s]
  std::function<double(double time)> angular_acceleration{};  ///< rate of the spin [rad/s^2]
  /// Times at which velocities jump or functions are not smooth, ascending [s]. At a break functions are
  /// taken for what holds after it. Displacement and angle are continuous, at breaks too: a jump of them, or
  /// a rate that is not theirs, is a SolverError that names the shape and the time (core/law_jump.h).
  std::vector<double> breaks{};

  /// True if there is no motion.
  [[nodiscard]] bool empty() const { return !displacement && !angle; }
  /// Where a shape with its point described at `point` is at a time [s].
  [[nodiscard]] GroundMotion at(double time, const Vec<2>& point) const;
  /// Throws ModelError for functions without the one that they are rates of, breaks out of order, or values
  /// at time 0 that are not finite.
  void check(const PartCheck& check) const;
};

}  // namespace carom::planar

namespace carom {

/// The first number of a motion that is not finite.
struct NonFiniteMotion {
  const char* quantity = nullptr;  ///< its name; null if all are finite
  double value = 0.0;              ///< the number
  const char* unit = "";           ///< its unit
};
/// Looks for the first number of a motion that is not finite.
[[nodiscard]] CAROM_API NonFiniteMotion find_non_finite(const GroundMotion& motion);

}  // namespace carom
