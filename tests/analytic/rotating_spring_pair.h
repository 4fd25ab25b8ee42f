#pragma once

// Two equal masses on a spring that turn about their centre at a constant rate w. Each mass moves on a circle
// of radius l/2; the spring carries the centripetal force:
//     k (l - L) = m w^2 l / 2    =>    l = 2 k L / (2 k - m w^2).
// Small radial disturbances at constant angular momentum oscillate with k/mu + 3 w^2, mu = m/2 the reduced
// mass: the effective potential J^2/(2 mu l^2) + k (l - L)^2/2 has second derivative 3 J^2/(mu l^4) + k and
// J = mu l^2 w. Source: Landau and Lifshitz, Mechanics, section 14 (motion in a central field).

#include <carom/core/space.h>

#include <cmath>

namespace analytic {

struct RotatingSpringPair {
  double mass;         // of each [kg]
  double stiffness;    // [N/m]
  double free_length;  // [m]
  double rate;         // counter-clockwise [rad/s]

  double distance() const { return 2.0 * stiffness * free_length / (2.0 * stiffness - mass * rate * rate); }
  double speed() const { return 0.5 * rate * distance(); }
  double radial_frequency() const { return std::sqrt(2.0 * stiffness / mass + 3.0 * rate * rate); }

  /// Position and velocity of the first mass, which starts on the positive x-axis; the other is opposite.
  carom::Vec<2> position(double t) const {
    return 0.5 * distance() * carom::Vec<2>(std::cos(rate * t), std::sin(rate * t));
  }
  carom::Vec<2> velocity(double t) const {
    return speed() * carom::Vec<2>(-std::sin(rate * t), std::cos(rate * t));
  }
  double kinetic_energy() const { return mass * speed() * speed(); }
  double elastic_energy() const {
    const double stretch = distance() - free_length;
    return 0.5 * stiffness * stretch * stretch;
  }
};

}  // namespace analytic
