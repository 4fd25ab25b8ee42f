#pragma once

/// \file
/// A ball in a box of inclined planes, in which it comes to rest. Shared by the example, the tests and the
/// benchmarks.

#include <carom/carom.h>

#include <cmath>

namespace scenes {

/// Parameters. The floor falls to the right, the walls lean outwards.
struct Box {
  double floor_slope = 0.2;  ///< by which the floor falls to the right [rad]
  double wall_lean = 0.15;   ///< of both walls, from upright [rad]
  double width = 1.0;        ///< of the floor, along x [m]
  double friction = 0.1;
  double normal_restitution = 0.5;
  double tangential_restitution = 0.0;
  carom::Vec<2> position{0.25, 0.7};  ///< of the ball at the start; the lower corner is at (width, 0) [m]
  carom::Vec<2> velocity{1.0, 0.0};   ///< [m/s]
  double spin = 80.0;                 ///< counter-clockwise [rad/s]
};

inline constexpr double box_gravity = 9.81;      ///< [m/s^2]
inline constexpr double box_ball_mass = 0.5;     ///< [kg]
inline constexpr double box_ball_radius = 0.05;  ///< [m]

/// The whole arrangement; returns the ball, a disc of uniform density.
inline carom::BodyId add_box(carom::System& system, const Box& box) {
  using namespace carom::planar;
  system.add(Gravity{{0.0, -box_gravity}});
  const carom::Surface surface{.friction = box.friction,
                               .normal_restitution = box.normal_restitution,
                               .tangential_restitution = box.tangential_restitution};
  const carom::Vec<2> lower(box.width, 0.0), upper(0.0, box.width * std::tan(box.floor_slope));
  system.add(HalfPlane{.point = lower, .normal = incline(-box.floor_slope)}, surface, "floor");
  system.add(HalfPlane{.point = upper, .normal = {std::cos(box.wall_lean), std::sin(box.wall_lean)}}, surface,
             "left wall");
  system.add(HalfPlane{.point = lower, .normal = {-std::cos(box.wall_lean), std::sin(box.wall_lean)}},
             surface, "right wall");
  const carom::BodyId ball = system.add(RigidBody{.mass = disc(box_ball_mass, box_ball_radius),
                                                  .position = box.position,
                                                  .velocity = box.velocity,
                                                  .spin = box.spin},
                                        "ball");
  system.add(Disc{.body = ball, .radius = box_ball_radius}, "ball");
  return ball;
}

}  // namespace scenes
