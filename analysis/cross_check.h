#pragma once

/// \file
/// Cross-check of one model in both modes: do they agree in the limit of small steps?

#include <carom/core/export.h>
#include <carom/core/system.h>
#include <carom/integrators/run/event_driven.h>
#include <carom/integrators/run/stop_request.h>
#include <carom/integrators/run/time_stepping.h>

#include <iosfwd>
#include <limits>
#include <string>
#include <vector>

namespace carom {

/// Options of a cross-check.
struct CrossCheckOptions {
  double end = std::numeric_limits<double>::quiet_NaN();  ///< time up to which, > 0 (required) [s]
  std::vector<double> steps{};  ///< of time stepping, at least five, > 0 (required; see spread_steps()) [s]
  /// Further steps of time stepping, spread between the largest of `steps` and a quarter of it, which is
  /// cheap: a motion that goes astray at one step length in ten shows there even where all of `steps` miss
  /// it. 0: none.
  int probes = 16;
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
  std::string body{};  ///< where the largest difference of a coordinate was; empty where there was none
};

/// A step length at which time stepping goes another way than at the others.
struct CrossCheckOutlier {
  CrossCheckLevel level{};  ///< its differences from the event-driven run
  double expected = 0.0;    ///< position error that the other step lengths lead to expect [m]
};

/// Result of a cross-check. Angles and spins count times the radius of gyration.
struct CrossCheck {
  std::vector<CrossCheckLevel> levels{};      ///< one for every step, in the order given
  std::vector<CrossCheckLevel> probes{};      ///< one for every further step, from the largest on
  std::vector<CrossCheckOutlier> outliers{};  ///< find_outliers() of both
  /// Slopes of the least-squares lines through the logarithms of steps and errors: the orders observed; NaN
  /// where the modes agree to rounding. Across impacts order 1 is expected, in the mean over several steps;
  /// smooth motion has order 2. Outliers are left out.
  double position_order = std::numeric_limits<double>::quiet_NaN();
  /// Order of the velocity error, as position_order.
  double velocity_order = std::numeric_limits<double>::quiet_NaN();
};

/// `count` step lengths from `largest` to about `smallest`, evenly spread in the logarithm except for shifts
/// by the golden ratio: how late an impact is detected depends on the grid of times, and step lengths that
/// divide each other have the same grid points. Throws ModelError unless 0 < smallest < largest and count
/// >= 2.
[[nodiscard]] CAROM_API std::vector<double> spread_steps(double largest, double smallest, int count);

/// Position errors above this many times what is expected are outliers: those across impacts scatter by about
/// 2 and, where there are several impacts, 3.
inline constexpr double outlier_factor = 8.0;

/// Levels whose position error is more than `outlier_factor` times what the line through the logarithms of
/// all steps and errors says, the largest excess first. The line has the median of all slopes between two
/// levels, and of its distances from levels as many lie above as below: a quarter of outliers leaves it where
/// it is.
[[nodiscard]] CAROM_API std::vector<CrossCheckOutlier> find_outliers(
    const std::vector<CrossCheckLevel>& levels);

/// Runs the model in both modes and compares them at every step of time stepping. Throws ModelError for
/// invalid options, and the errors of the runs.
[[nodiscard]] CAROM_API CrossCheck cross_check(const System& system, const CrossCheckOptions& options);

/// Writes the levels and the orders as a table, and names the outliers.
CAROM_API std::ostream& operator<<(std::ostream& out, const CrossCheck& check);

}  // namespace carom
