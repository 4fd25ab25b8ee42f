#pragma once

/// \file
/// The bar and the particle-spring pair of Johansson (1999), section 6, over an inclined plane. Shared by
/// the example, the tests and the benchmarks.

#include <carom/carom.h>

namespace scenes {

/// Parameters. The paper prints neither the starting angle nor which way the plane slopes: the plane
/// goes through the origin and rises with +x for positive slopes, the bodies start upright for angle 0.
struct Incline {
  double slope = 0.1;    ///< [rad]
  double angle = 0.0;    ///< of the bodies at the start, counter-clockwise from upright [rad]
  double speed = 10.0;   ///< to the right [m/s]
  double height = 20.0;  ///< of the centre [m]
  double friction = 0.1;
  double normal_restitution = 1.0;
  double tangential_restitution = 1.0;
};

inline constexpr double gravity = 9.81;     ///< [m/s^2]
inline constexpr double bar_mass = 2.0;     ///< [kg]
inline constexpr double bar_length = 2.0;   ///< [m]
inline constexpr double bar_inertia = 2.0;  ///< printed by the paper; a uniform bar would have 2/3 [kg m^2]
inline constexpr double pair_mass = 1.0;    ///< of each particle [kg]
inline constexpr double pair_stiffness = 1000.0;  ///< [N/m]

/// Gravity and the plane.
inline void add_plane(carom::System& system, const Incline& incline) {
  using namespace carom::planar;
  system.add(Gravity{{0.0, -gravity}});
  system.set_default_law(carom::Surface{.friction = incline.friction,
                                        .normal_restitution = incline.normal_restitution,
                                        .tangential_restitution = incline.tangential_restitution});
  system.add(HalfPlane{.point = {0.0, 0.0}, .normal = carom::planar::incline(incline.slope)}, "plane");
}

/// The bar: a rigid body named "bar" with contact at its two ends (feature 0: lower at the start).
inline carom::BodyId add_bar(carom::System& system, const Incline& incline) {
  using namespace carom::planar;
  const carom::BodyId bar = system.add(RigidBody{.mass = {.mass = bar_mass, .inertia = bar_inertia},
                                                 .position = {0.0, incline.height},
                                                 .angle = incline.angle,
                                                 .velocity = {incline.speed, 0.0}},
                                       "bar");
  system.add(Segment{.body = bar, .from = {0.0, -0.5 * bar_length}, .to = {0.0, 0.5 * bar_length}}, "bar");
  return bar;
}

/// The pair: particles "lower" and "upper" on a spring.
struct Pair {
  carom::BodyId lower, upper;
};
inline Pair add_pair(carom::System& system, const Incline& incline) {
  using namespace carom::planar;
  const carom::Vec<2> half(-0.5 * bar_length * std::sin(incline.angle),
                           0.5 * bar_length * std::cos(incline.angle));
  const carom::Vec<2> centre(0.0, incline.height);
  const carom::Vec<2> velocity(incline.speed, 0.0);
  Pair pair;
  pair.lower =
      system.add(Particle{.mass = pair_mass, .position = centre - half, .velocity = velocity}, "lower");
  pair.upper =
      system.add(Particle{.mass = pair_mass, .position = centre + half, .velocity = velocity}, "upper");
  system.add(
      SpringDamper{
          .from = pair.lower, .to = pair.upper, .stiffness = pair_stiffness, .free_length = bar_length},
      "spring");
  return pair;
}

}  // namespace scenes
