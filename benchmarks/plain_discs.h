#pragma once

/// \file
/// Free discs over a floor as one would write them by hand for this purpose alone: flat arrays, one loop.

#include <cstddef>
#include <vector>

namespace benchmarks {

/// Discs under gravity. Arrays over the discs; coordinates and velocities are interleaved: x, y, angle, ...
struct PlainDiscs {
  std::vector<double> q, v, mass, inertia, load;
  std::vector<float> carried;  ///< what rounding cut off the velocities
  double kinetic = 0.0;        ///< [J]
  double potential = 0.0;      ///< [J]
  double work = 0.0;           ///< of the loads over the last step [J]
  double lowest = 0.0;         ///< least height of a centre less the radius [m]

  /// \param count discs, in a row \param radius [m] \param height of their centres [m]
  PlainDiscs(int count, double radius, double height);

  [[nodiscard]] std::size_t size() const { return mass.size(); }
};

/// One step of the trapezoidal rule with carried rounding, v += h F/m, q += h (v0 + v)/2, and its account:
/// kinetic and potential energy, work of the loads. No contact. Compiled as the library is.
void plain_step(PlainDiscs& discs, double step);
/// One step of the trapezoidal rule with carried rounding, its account, and the least height over the floor.
void plain_step_with_gaps(PlainDiscs& discs, double radius, double step);

}  // namespace benchmarks
