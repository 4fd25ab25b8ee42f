// Contact far from the origin, where places are known to less than the tolerance: what rests goes on resting.

#include <carom/carom.h>
#include <carom/core/assembly.h>
#include <carom/integrators/time_stepping/gap_rounding.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;

constexpr double width = 0.3, height = 0.1;  // of a brick [m]

/// Bricks that lie on each other on an incline that holds them by friction, each a little further up than the
/// one below.
System bricks(Vec<2> origin, double slope, int count) {
  System system;
  const MaterialId stone = system.material("stone");
  system.between(stone, stone, Surface{.friction = 0.8, .normal_restitution = 0.0});
  system.add(Gravity{{0.0, -9.81}});
  const Vec<2> along(std::cos(slope), std::sin(slope)), up(-std::sin(slope), std::cos(slope));
  system.add(HalfPlane{.point = origin, .normal = up, .material = stone});
  for (int i = 0; i < count; ++i) {
    const Vec<2> place = origin + (0.5 + i) * height * up + 0.1 * width * i * along;
    const BodyId brick =
        system.add(RigidBody{.mass = box(2.0, width, height), .position = place, .angle = slope});
    const double x = 0.5 * width, y = 0.5 * height;
    system.add(Polygon{.body = brick, .vertices = {{-x, -y}, {x, -y}, {x, y}, {-x, y}}, .material = stone});
  }
  return system;
}

/// Largest distance of a body from where it started.
double moved(const State& now, const State& start) {
  double most = 0.0;
  for (std::size_t i = 0; i < start.q.size(); ++i) most = std::max(most, std::abs(now.q[i] - start.q[i]));
  return most;
}

TEST(FarFromTheOrigin, WhatRestsGoesOnResting) {
  // Some roundings of places, of both bodies of a contact; a contact that is lost for a step moves them by
  // 1e-3 m.
  constexpr double roundings = 4.0 * std::numeric_limits<double>::epsilon();
  for (const double far : {1.0, 1e3, 1e4, 1e5, 1e6, 5e6}) {
    for (int i = 0; i < 8; ++i) {
      const Vec<2> origin = far * (1.0 + 0.0371 * i) * Vec<2>(1.0, -0.7);
      for (const double slope : {0.0, 0.3 + 0.003 * i}) {
        for (const int count : {1, 3}) {
          Simulation simulation(bricks(origin, slope, count), TimeStepping{.step = 1e-2});
          const State start = simulation.state();
          for (int step = 0; step < 50; ++step) simulation.step();
          EXPECT_LE(moved(simulation.state(), start), 1e-13 + roundings * far)
              << moved(simulation.state(), start) << "; " << far << " m away, slope " << slope << ", "
              << count << " bricks, case " << i;
        }
      }
    }
  }
}

TEST(GapRounding, IsTheToleranceOrWhatPlacesAreKnownTo) {
  const auto at = [](double far, double tolerance) {
    const Assembly assembly(bricks({-far, 0.0}, 0.0, 1));
    return gap_rounding(assembly, TimeStepping{.tolerance = tolerance});
  };
  EXPECT_EQ(at(0.0, 1e-10), 1e-10);
  EXPECT_EQ(at(1e3, 1e-12), 1e-12);
  EXPECT_EQ(at(1e3, 0.0), 1e-12);
  EXPECT_EQ(at(1e5, 1e-12), 4.0 * std::numeric_limits<double>::epsilon() * 1e5);
  EXPECT_EQ(at(1e5, 1e-9), 1e-9);
}

}  // namespace
