#pragma once

/// \file
/// Where the distance of two ends passes a given length, as a guard that is smooth everywhere.

#include <carom/core/guard_motion.h>

#include <array>

namespace carom::generic {

/// The guard (l^2 - L^2)/(2 L), l the distance of the ends: near l = L it is l - L, but it is smooth where
/// the ends pass through each other, and a polynomial of time where particles fly freely. For L = 0, which l
/// never passes, the constant 1 m.
template <int D>
[[nodiscard]] double length_guard(const ElementView<D>& at, const End<D>& from, const End<D>& to,
                                  double length) {
  if (length == 0.0) return 1.0;
  const double distance = (at.position(to) - at.position(from)).norm();
  return 0.5 * (distance - length) * (distance + length) / length;
}

/// length_guard() along the motion.
template <int D>
[[nodiscard]] GuardMotion length_guard_motion(const ElementMotion<D>& at, const End<D>& from,
                                              const End<D>& to, double length) {
  GuardMotion out;
  out.value = length_guard<D>(at, from, to, length);
  if (length == 0.0) return out;
  const Vec<D> distance = at.position(to) - at.position(from);
  const Vec<D> velocity = at.velocity(to) - at.velocity(from);
  const Vec<D> acceleration = at.acceleration(to) - at.acceleration(from);
  out.first = distance.dot(velocity) / length;
  out.second = (velocity.squaredNorm() + distance.dot(acceleration)) / length;
  const std::array<double, 2> turning{at.turning(from), at.turning(to)};
  if (turning[0] == 0.0 && turning[1] == 0.0) return out;
  // Bounds of the derivatives of the sum of both levers, and of the distance without them: the k-th of a
  // lever is at most its length times W^k, the distance of the centres is a polynomial of degree 2. While a
  // body turns by 4 rad, the acceleration adds at most 2 |a|/W^2 to the latter: 17 instead of 15 in the sum
  // below.
  const std::array<double, 2> lever{from.point.norm(), to.point.norm()};
  std::array<double, 7> of_levers{};
  for (std::size_t end = 0; end < 2; ++end) {
    double bound = turning[end] == 0.0 ? 0.0 : lever[end];
    for (double& derivative : of_levers) {
      derivative += bound;
      bound *= turning[end];
    }
  }
  const double d0 = distance.norm() + 2.0 * of_levers[0];
  const double d1 = velocity.norm() + 2.0 * of_levers[1];
  const double d2 = acceleration.norm() + 2.0 * of_levers[2];
  // d^6(l^2/2)/dt^6 = d.d6 + 6 d1.d5 + 15 d2.d4 + 10 d3.d3
  out.sixth = (d0 * of_levers[6] + 6.0 * d1 * of_levers[5] + 17.0 * d2 * of_levers[4] +
               10.0 * of_levers[3] * of_levers[3]) /
              length;
  return out;
}

}  // namespace carom::generic
