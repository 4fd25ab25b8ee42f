#pragma once

/// \file
/// Times are doubles: far from zero short steps are lost in their rounding.

#include <bit>
#include <cmath>
#include <cstdint>

namespace carom {

/// Shortest step that still moves a time [s]: four times the distance to the next number, so that lengths of
/// steps are right to an eighth.
[[nodiscard]] inline double shortest_step_at(double time) {
  constexpr double steps_apart = 4.0;
  const double size = std::abs(time);
  // Doubles >= 0 are in the order of their bits.
  const auto next = std::bit_cast<double>(std::bit_cast<std::uint64_t>(size) + 1);
  return steps_apart * (next - size);
}

}  // namespace carom
