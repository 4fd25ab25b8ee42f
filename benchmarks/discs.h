#pragma once

/// \file
/// Where the discs of the benchmarks start, and what they are.

#include <carom/core/space.h>

namespace benchmarks {

inline constexpr double disc_gravity = 9.81;  ///< [m/s^2]
inline constexpr double disc_density = 30.0;  ///< mass over the square of the radius [kg/m^2]
inline constexpr double disc_speed = 0.1;     ///< to the right, at the start [m/s]
inline constexpr double disc_spin = 1.0;      ///< at the start [rad/s]

/// Centre of a disc at the start: a row, a diameter apart.
inline carom::Vec<2> disc_position(int disc, double radius, double height) {
  return {4.0 * radius * disc, height};
}

}  // namespace benchmarks
