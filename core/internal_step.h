#pragma once

/// \file
/// Internal variables over a step, the motion given:  z1 = z0 + (h/2) (r(t0, z0) + r(t1, z1)),  solved by
/// Newton's method with difference derivatives, so that fast variables set no limit to the step.

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace carom {

/// Solves for `z` (N numbers; in: a guess). `rates_at_end(const double* z, double* rates)` writes r(t1, z);
/// it may read `z` through other ways too, since z is the memory that is being changed. Returns false if the
/// iteration does not settle.
template <int N, class F>
[[nodiscard]] bool advance_trapezoidal(double step, const double* z0, const double* rates0, F&& rates_at_end,
                                       double* z) {
  using Vector = Eigen::Matrix<double, N, 1>;
  constexpr int most_steps = 50;
  // Changes of this part of the variables are their rounding.
  constexpr double negligible = 1e-15;
  constexpr double difference = 1e-7;  // relative, for one-sided differences

  const double half = 0.5 * step;
  const Eigen::Map<const Vector> start(z0), start_rates(rates0);
  Eigen::Map<Vector> now(z);
  Vector rates;
  double last = 0.0;
  for (int i = 0; i < most_steps; ++i) {
    rates_at_end(z, rates.data());
    const Vector gap = now - start - half * (start_rates + rates);
    if (!gap.allFinite()) return false;
    Eigen::Matrix<double, N, N> slope = Eigen::Matrix<double, N, N>::Identity();
    for (int column = 0; column < N; ++column) {
      const double kept = z[column];
      const double size = std::max({std::abs(kept), std::abs(z0[column]), half * std::abs(rates[column])});
      const double move = size > 0.0 ? difference * size : difference;
      z[column] = kept + move;
      Vector moved;
      rates_at_end(z, moved.data());
      z[column] = kept;
      slope.col(column) -= half / move * (moved - rates);
    }
    const Vector change = slope.partialPivLu().solve(gap);
    if (!change.allFinite()) return false;
    now -= change;
    const double size = now.template lpNorm<Eigen::Infinity>() + start.template lpNorm<Eigen::Infinity>();
    const double moved = change.template lpNorm<Eigen::Infinity>();
    // Rounding of the rates may keep the change above that of the variables: then it stops shrinking.
    constexpr double nearly = 1e-9;
    if (moved <= negligible * size || (i > 1 && moved >= last && moved <= nearly * size)) return true;
    last = moved;
  }
  return false;
}

}  // namespace carom
