#pragma once

/// \file
/// A block on an inclined plane that oscillates in its own direction with growing amplitude. Shared by the
/// example, the tests and the benchmarks.

#include <carom/carom.h>

#include <cmath>
#include <numbers>

namespace scenes {

/// Parameters. The displacement of the plane along its tangent is s(t) = growth t sin(omega t).
struct Shaker {
  double slope = -0.1;           ///< of the plane; negative: falls to the right [rad]
  double frequency = 2.0;        ///< omega / 2 pi [1/s]
  double growth = 0.018;         ///< of the amplitude [m/s]
  double static_friction = 0.4;  ///< mu_s
  double friction = 0.3;         ///< mu_k
};

inline constexpr double shaker_gravity = 9.81;                              ///< [m/s^2]
inline constexpr double block_mass = 2.0;                                   ///< [kg]
inline constexpr double block_half_width = 0.1, block_half_height = 0.025;  ///< [m]

/// Displacement of the plane along its tangent [m].
inline double shaker_displacement(const Shaker& shaker, double time) {
  return shaker.growth * time * std::sin(2.0 * std::numbers::pi * shaker.frequency * time);
}

/// Velocity of the plane along its tangent [m/s].
inline double shaker_speed(const Shaker& shaker, double time) {
  const double omega = 2.0 * std::numbers::pi * shaker.frequency;
  return shaker.growth * (std::sin(omega * time) + omega * time * std::cos(omega * time));
}

/// Acceleration of the plane along its tangent [m/s^2].
inline double shaker_acceleration(const Shaker& shaker, double time) {
  const double omega = 2.0 * std::numbers::pi * shaker.frequency;
  return shaker.growth *
         (2.0 * omega * std::cos(omega * time) - omega * omega * time * std::sin(omega * time));
}

/// The whole arrangement; returns the block, which lies on two corners (features 0: left, 1: right).
inline carom::BodyId add_shaker(carom::System& system, const Shaker& shaker) {
  using namespace carom::planar;
  system.add(Gravity{{0.0, -shaker_gravity}});
  const carom::Vec<2> normal = incline(shaker.slope), tangent(normal[1], -normal[0]);
  const PrescribedMotion motion{
      .displacement = [=](double t) { return carom::Vec<2>(shaker_displacement(shaker, t) * tangent); },
      .velocity = [=](double t) { return carom::Vec<2>(shaker_speed(shaker, t) * tangent); },
      .acceleration = [=](double t) { return carom::Vec<2>(shaker_acceleration(shaker, t) * tangent); }};
  system.set_default_law(carom::Surface{
      .friction = shaker.friction, .normal_restitution = 0.0, .static_friction = shaker.static_friction});
  system.add(HalfPlane{.point = {0.0, 0.0}, .normal = normal, .motion = motion}, "plane");
  const double a = block_half_width, b = block_half_height;
  const carom::BodyId block = system.add(
      RigidBody{.mass = box(block_mass, 2.0 * a, 2.0 * b), .position = b * normal, .angle = shaker.slope},
      "block");
  system.add(Polygon{.body = block, .vertices = {{-a, -b}, {a, -b}, {a, b}, {-a, b}}}, "block");
  return block;
}

}  // namespace scenes
