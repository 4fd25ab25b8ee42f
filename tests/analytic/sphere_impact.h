#pragma once

// Impact of a body whose contact point lies on the normal through its centre of mass (sphere, disc, point):
// normal and tangential directions decouple.
// Source: Johansson (1999), equations 14, 17, 20, 22; the same law as Walton's three-parameter model. With
// y < 0 the normal and x the tangential contact speed before, 1/m1 = 1/m + r1^2/I:
//     P_n = -m (1 + e_n) y
//     stick, if m1 (1 + e_t) |x| <= mu P_n:   P_t = -m1 (1 + e_t) x
//     slip, otherwise:                        P_t = -mu P_n x/|x|
// In space x and P_t are vectors of the tangent plane; friction acts along the direction of x, so the law is
// the planar one along that direction.

#include <carom/core/space.h>

#include <algorithm>
#include <limits>

namespace analytic {

struct SphereImpact {
  double mass;          // m [kg]
  double contact_mass;  // m1 [kg]; that of a point is m
  double friction;
  double normal_restitution, tangential_restitution;

  double normal_impulse(double normal_speed) const {
    return -mass * (1.0 + normal_restitution) * normal_speed;
  }
  bool sticks(double normal_speed, double tangential_speed) const {
    return contact_mass * (1.0 + tangential_restitution) * tangential_speed <=
           friction * normal_impulse(normal_speed);
  }
  /// Factor of P_t = -factor * x, for the tangential speed |x| > 0.
  double tangential_factor(double normal_speed, double tangential_speed) const {
    const double stick = contact_mass * (1.0 + tangential_restitution);
    return std::min(stick, friction * normal_impulse(normal_speed) / tangential_speed);
  }
};

/// Change of kinetic energy where r1 = r, r2 = -r, I = m r^2, mu = 1, contact speeds x = v0, y = -2 v0, no
/// spin: the paper's example of a law with e_n != e_t that gains energy (Johansson 1999, after equation 23).
inline double inconsistent_impact_energy(double mass, double speed, double e_n, double e_t) {
  return mass * speed * speed / 3.0 * (4.0 * e_n * e_n - 2.0 * e_n * e_t + e_t * e_t - 3.0);
}

}  // namespace analytic
