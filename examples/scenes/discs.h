#pragma once

/// \file
/// Discs of slightly different sizes that fall into a box and come to rest on each other. Shared by the
/// example, the tests and the benchmarks.

#include <carom/carom.h>

#include <cmath>
#include <vector>

namespace scenes {

/// Parameters.
struct Discs {
  int count = 500;
  double width = 2.0;       ///< of the box [m]
  double radius = 0.05;     ///< in the mean [m]
  double spread = 0.1;      ///< of the radii, to either side
  double density = 1000.0;  ///< of the discs, one metre thick [kg/m^3]
  double friction = 0.5;
  double restitution = 0.0;  ///< in both directions
  double rows_apart = 2.4;   ///< distance of the rows at the start, in radii; far apart they fall one by one
};

inline constexpr double discs_gravity = 9.81;  ///< [m/s^2]

/// Numbers between -1 and 1 that repeat no pattern: multiples of the golden section, without their integers.
inline double scattered(int i) {
  constexpr double golden = 0.6180339887498949;
  const double multiple = golden * (i + 1);
  return 2.0 * (multiple - std::floor(multiple)) - 1.0;
}

/// The whole arrangement; returns the discs, row by row from below.
inline std::vector<carom::BodyId> add_discs(carom::System& system, const Discs& discs) {
  using namespace carom::planar;
  constexpr double pi = 3.14159265358979323846;
  system.add(Gravity{{0.0, -discs_gravity}});
  system.set_default_law({.friction = discs.friction,
                          .normal_restitution = discs.restitution,
                          .tangential_restitution = discs.restitution});
  system.add(HalfPlane{.normal = {0.0, 1.0}}, "floor");
  system.add(HalfPlane{.normal = {1.0, 0.0}}, "left wall");
  system.add(HalfPlane{.point = {discs.width, 0.0}, .normal = {-1.0, 0.0}}, "right wall");
  const double pitch = 2.4 * discs.radius, rows_apart = discs.rows_apart * discs.radius;
  const int in_a_row = static_cast<int>(discs.width / pitch);
  std::vector<carom::BodyId> all;
  for (int i = 0; i < discs.count; ++i) {
    const double radius = discs.radius * (1.0 + discs.spread * scattered(i));
    const carom::Vec<2> place((0.5 + i % in_a_row) * pitch + 0.08 * discs.radius * scattered(3 * i + 1),
                              (0.5 + i / in_a_row) * rows_apart);
    const double mass = discs.density * pi * radius * radius;
    all.push_back(system.add(RigidBody{.mass = disc(mass, radius), .position = place}));
    system.add(Disc{.body = all.back(), .radius = radius});
  }
  return all;
}

}  // namespace scenes
