#pragma once

// A ball dropped from rest at height h over a floor, restitution e < 1. Falling takes t1 = sqrt(2h/g); each
// flight between impacts takes e times as long as the one before, the first 2 e t1; so impact n is at
//     t_n = t1 (1 + 2 (e + ... + e^(n-1))),    accumulating at  t1 (1 + e)/(1 - e).
// Source: sums of the geometric series; Brogliato, Nonsmooth Mechanics (2016), section 2.2 (Zeno).

#include <cmath>

namespace analytic {

struct BouncingBall {
  double height;       // at the start [m]
  double gravity;      // downwards [m/s^2]
  double restitution;  // e in [0, 1)

  double first_impact() const { return std::sqrt(2.0 * height / gravity); }
  /// Time of impact n = 1, 2, ...
  double impact_time(int n) const {
    return first_impact() *
           (1.0 + 2.0 * restitution * (1.0 - std::pow(restitution, n - 1)) / (1.0 - restitution));
  }
  /// Speed at which impact n ends, upwards.
  double speed_after(int n) const { return std::pow(restitution, n) * gravity * first_impact(); }
  /// Time at which the impacts accumulate; at rest from then on.
  double end() const { return first_impact() * (1.0 + restitution) / (1.0 - restitution); }

  struct Motion {
    double height, speed;
  };
  Motion at(double t) const {
    if (t >= end()) return {0.0, 0.0};
    if (t <= first_impact()) return {height - 0.5 * gravity * t * t, -gravity * t};
    int n = 1;
    while (impact_time(n + 1) < t) ++n;
    const double since = t - impact_time(n);
    return {speed_after(n) * since - 0.5 * gravity * since * since, speed_after(n) - gravity * since};
  }
};

}  // namespace analytic
