#pragma once

/// \file
/// The ball between two tables of Johansson (1999), section 4. Shared by the example, tests and benchmarks.

#include <carom/carom.h>

namespace scenes {

/// Parameters. The paper prints no initial velocity, but a spin of 567 rad/s after the first impact,
/// which fixes the incoming horizontal speed for each e_t. Vertical speed and height are assumptions, chosen
/// so that the ball bounces low, high, low within the paper's twelve flashes.
struct Tables {
  double tangential_restitution = 0.91;
  double horizontal_speed = 5.444387434554974;  ///< for e_t = 0.91; 6.18975 for 0.68 [m/s]
  double vertical_speed = -5.0;                 ///< [m/s]
  double height = 0.25;                         ///< of the centre at the start [m]
  double spin = 0.0;                            ///< [rad/s]
};

inline constexpr double ball_mass = 0.00859;       ///< [kg]
inline constexpr double ball_radius = 0.0131;      ///< [m]
inline constexpr double table_distance = 0.530;    ///< [m]
inline constexpr double table_restitution = 0.91;  ///< e_n
inline constexpr double lower_friction = 1.13;
inline constexpr double upper_friction = 0.95;
inline constexpr double tables_step = 0.000309;    ///< the paper's [s]
inline constexpr double strobe_interval = 0.0309;  ///< between flashes [s]
inline constexpr int flashes = 12;

/// The whole arrangement; returns the ball.
inline carom::BodyId add_tables(carom::System& system, const Tables& tables) {
  using namespace carom::planar;
  system.add(Gravity{{0.0, -9.81}});
  const auto table = [&](double height, double normal, double friction, const char* name) {
    system.add(HalfPlane{.point = {0.0, height}, .normal = {0.0, normal}},
               carom::Surface{.friction = friction,
                              .normal_restitution = table_restitution,
                              .tangential_restitution = tables.tangential_restitution},
               name);
  };
  table(0.0, 1.0, lower_friction, "lower table");
  table(table_distance, -1.0, upper_friction, "upper table");
  const carom::BodyId ball =
      system.add(RigidBody{.mass = solid_sphere(ball_mass, ball_radius),
                           .position = {0.0, tables.height},
                           .velocity = {tables.horizontal_speed, tables.vertical_speed},
                           .spin = tables.spin},
                 "ball");
  system.add(Disc{.body = ball, .radius = ball_radius}, "ball");
  return ball;
}

}  // namespace scenes
