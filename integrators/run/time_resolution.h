#pragma once

/// \file
/// Times are doubles: far from zero short steps are lost in their rounding.

#include <cmath>
#include <limits>

namespace carom {

/// Shortest step that still moves a time [s]: four times the distance to the next number, so that lengths of
/// steps are right to an eighth.
[[nodiscard]] inline double shortest_step_at(double time) {
  constexpr double steps_apart = 4.0;
  const double size = std::abs(time);
  return steps_apart * (std::nextafter(size, std::numeric_limits<double>::infinity()) - size);
}

}  // namespace carom
