#pragma once

/// \file
/// Cross-check of one model in both modes: do they agree in the limit of small steps?

#include <carom/core/export.h>
#include <carom/core/system.h>
#include <carom/integrators/event_driven.h>
#include <carom/integrators/stop_request.h>
#include <carom/integrators/time_stepping.h>

#include <iosfwd>
#include <limits>
#include <vector>

namespace carom {

/// Options of a cross-check.
struct CrossCheckOptions {
  double end = std::numeric_limits<double>::quiet_NaN();  ///< time up to which, > 0 (required) [s]
  std::vector<double> steps{};   ///< of time stepping, at least five, > 0 (required; see spread_steps()) [s]
  TimeStepping time_stepping{};  ///< its other options; `step` is taken from `steps`, `control` must be empty
  EventDriven event_driven{};    ///< of the run that is the reference
  StopFunction stop_when{};      ///< of all runs: Simulation::stop_when()
};

/// Differences of one run of time stepping from the event-driven one.
struct CrossCheckLevel {
  double step = 0.0;            ///< [s]
  double position_error = 0.0;  ///< largest difference of any coordinate at any step [m]
  /// Integral over time of the largest difference of any velocity [m]. Near an impact, which time stepping
  /// detects late, velocities always differ: they agree only in the mean.
  double velocity_error = 0.0;
};

/// Result of a cross-check. Angles and spins count times the radius of gyration.
struct CrossCheck {
  std::vector<CrossCheckLevel> levels{};  ///< one for every step, in the order given
  /// Slopes of the least-squares lines through the logarithms of steps and errors: the orders observed; NaN
  /// where the modes agree to rounding. Across impacts order 1 is expected, in the mean over several steps;
  /// smooth motion has order 2.
  double position_order = std::numeric_limits<double>::quiet_NaN();
  double velocity_order = std::numeric_limits<double>::quiet_NaN();  ///< likewise
};

/// `count` step lengths from `largest` to about `smallest`, evenly spread in the logarithm except for shifts
/// by the golden ratio: how late an impact is detected depends on the grid of times, and step lengths that
/// divide each other have the same grid points. Throws ModelError unless 0 < smallest < largest and count
/// >= 2.
[[nodiscard]] CAROM_API std::vector<double> spread_steps(double largest, double smallest, int count);

/// Runs the model in both modes and compares them at every step of time stepping. Throws ModelError for
/// invalid options, and the errors of the runs.
[[nodiscard]] CAROM_API CrossCheck cross_check(const System& system, const CrossCheckOptions& options);

/// Writes the levels and the orders as a table.
CAROM_API std::ostream& operator<<(std::ostream& out, const CrossCheck& check);

}  // namespace carom
