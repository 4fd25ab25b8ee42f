#include <carom/core/assembly.h>
#include <carom/core/largest_coordinate.h>
#include <carom/integrators/time_stepping/gap_rounding.h>

#include <algorithm>
#include <limits>

namespace carom {

double gap_rounding(const Assembly& assembly, const TimeStepping& options) {
  constexpr double usual = 1e-12, roundings = 4.0 * std::numeric_limits<double>::epsilon();
  return std::max(options.tolerance > 0.0 ? options.tolerance : usual,
                  roundings * largest_coordinate(assembly.initial_state()));
}

double turning_rounding(const TimeStepping& options) {
  constexpr double steps = 1e6;
  return options.tolerance / steps;
}

}  // namespace carom
