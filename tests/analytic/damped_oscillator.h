#pragma once

// Two masses on a vertical line, joined by a spring and a dashpot, in free fall: the centre of mass is a
// projectile, the stretch s = y2 - y1 - L a damped oscillator of the reduced mass m = m1 m2/(m1 + m2):
//     m s'' + c s' + k s = 0.
// With a = c/(2m) and w = sqrt(k/m - a^2) (underdamped):
//     s(t) = exp(-a t) (s0 cos wt + (s0' + a s0)/w sin wt).
// Source: Landau and Lifshitz, Mechanics, sections 13 (reduced mass) and 25 (damped oscillations).

#include <array>
#include <cmath>

namespace analytic {

struct DampedOscillator {
  double lower_mass, upper_mass;    // [kg]
  double stiffness, damping;        // [N/m], [N s/m]
  double free_length;               // [m]
  double gravity;                   // downwards [m/s^2]
  double lower, upper;              // heights at the start [m]
  double lower_speed, upper_speed;  // upwards, at the start [m/s]

  /// Heights and speeds (lower, upper, lower speed, upper speed).
  std::array<double, 4> state(double t) const {
    const double total = lower_mass + upper_mass;
    const double reduced = lower_mass * upper_mass / total;
    const double a = 0.5 * damping / reduced;
    const double w = std::sqrt(stiffness / reduced - a * a);
    const double s0 = upper - lower - free_length;
    const double rate0 = upper_speed - lower_speed;
    const double b = (rate0 + a * s0) / w;
    const double decay = std::exp(-a * t);
    const double s = decay * (s0 * std::cos(w * t) + b * std::sin(w * t));
    const double rate = -a * s + decay * w * (b * std::cos(w * t) - s0 * std::sin(w * t));

    const double centre_speed0 = (lower_mass * lower_speed + upper_mass * upper_speed) / total;
    const double centre =
        (lower_mass * lower + upper_mass * upper) / total + centre_speed0 * t - 0.5 * gravity * t * t;
    const double centre_speed = centre_speed0 - gravity * t;
    const double distance = free_length + s;
    return {centre - upper_mass / total * distance, centre + lower_mass / total * distance,
            centre_speed - upper_mass / total * rate, centre_speed + lower_mass / total * rate};
  }
  /// Energy that the dashpot has taken until t: c int s'^2 dt, from the energy of the oscillator.
  double dashpot_loss(double t) const {
    const double reduced = lower_mass * upper_mass / (lower_mass + upper_mass);
    const auto energy = [&](double time) {
      const auto at = state(time);
      const double s = at[1] - at[0] - free_length;
      const double rate = at[3] - at[2];
      return 0.5 * reduced * rate * rate + 0.5 * stiffness * s * s;
    };
    return energy(0.0) - energy(t);
  }
};

}  // namespace analytic
