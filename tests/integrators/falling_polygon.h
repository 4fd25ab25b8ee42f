#pragma once

// Convex polygons of random form that fall.

#include "tests/random.h"

#include <carom/carom.h>

#include <cmath>
#include <vector>

namespace carom_test {

/// Adds a sharp polygon of 3 to 6 corners, 0.15 m from its middle, that turns and falls near x = 0.
inline void add_falling_polygon(carom::System& system, Random& random, double height) {
  using namespace carom::planar;
  std::vector<carom::Vec<2>> vertices;
  const unsigned corners = 3 + random.below(4);
  for (unsigned k = 0; k < corners; ++k) {
    const double at = 6.283185307179586 * (k + random.uniform(0.0, 0.5)) / corners;
    vertices.emplace_back(0.15 * std::cos(at), 0.15 * std::sin(at));
  }
  const auto mass = polygon(random.uniform(0.3, 3.0), vertices);
  for (carom::Vec<2>& vertex : vertices) vertex -= mass.centre;
  const carom::BodyId body = system.add(RigidBody{.mass = centred(mass),
                                                  .position = {random.uniform(-0.05, 0.05), height},
                                                  .angle = random.uniform(-3.0, 3.0),
                                                  .spin = random.uniform(-10.0, 10.0)});
  system.add(Polygon{.body = body, .vertices = vertices});
}

}  // namespace carom_test
