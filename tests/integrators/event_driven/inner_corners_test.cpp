// Bodies that slide into an inner corner of the ground: rounding holds their corners a little below the face
// that they slide on, where they are beyond the end of the other one, and still they meet that.

#include "tests/integrators/event_run.h"
#include "tests/random.h"
#include "tests/shares.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <exception>
#include <vector>

namespace {

using namespace carom_test;
using namespace carom;
using namespace carom::planar;

constexpr double g = 9.81;

struct Start {
  std::vector<Vec<2>> vertices;
  Vec<2> position, velocity;
  double angle = 0.0, spin = 0.0;
};

System falling(const Start& start, const Terrain& ground, Surface law) {
  System system;
  system.add(Gravity{{0.0, -g}});
  system.set_default_law(law);
  system.add(ground);
  const MassProperties<2> mass = polygon(1.0, start.vertices);
  std::vector<Vec<2>> vertices = start.vertices;
  for (Vec<2>& vertex : vertices) vertex -= mass.centre;
  const BodyId body = system.add(RigidBody{.mass = centred(mass),
                                           .position = start.position,
                                           .angle = start.angle,
                                           .velocity = start.velocity,
                                           .spin = start.spin});
  system.add(Polygon{.body = body, .vertices = vertices});
  return system;
}

Terrain corner_of_two_faces() { return {.vertices = {{0.0, 4.0}, {0.0, 0.0}, {3.0, 0.0}}, .depth = 0.4}; }

// At 0.16 s a corner of the triangle lies at y = -1e-17 m on the floor and comes to the wall.
TEST(InnerCorners, AWallIsMetByWhatSlidesAlongTheFloor) {
  const Start start{.vertices = {{0.087194518, 0.00124325784},
                                 {-0.0329732271, 0.0654724258},
                                 {-0.0542212909, -0.0667156837}},
                    .position = {0.220763215, 0.182346404},
                    .velocity = {-0.885825113, -1.73202835},
                    .angle = -0.832183862,
                    .spin = 3.79590531};
  Simulation simulation(falling(start, corner_of_two_faces(), {.friction = 0.0, .normal_restitution = 0.0}),
                        EventDriven{});
  const LedgerWatch ledger(simulation);
  simulation.run_until(2.0);
  EXPECT_TRUE(ledger.closes());
}

/// A triangle near the corner at the origin.
Start random_start(Random& random) {
  Start start;
  const double size = random.uniform(0.05, 0.2), turn = random.uniform(0.0, 6.28);
  for (int k = 0; k < 3; ++k) {
    const double at = turn + 2.0944 * (k + random.uniform(0.0, 0.5));
    start.vertices.emplace_back(size * std::cos(at), size * std::sin(at));
  }
  start.position = {random.uniform(0.35, 0.6), random.uniform(0.35, 0.7)};
  start.velocity = {random.uniform(-2.0, 1.0), random.uniform(-3.0, 1.0)};
  start.angle = random.uniform(-3.0, 3.0);
  start.spin = random.uniform(-6.0, 6.0);
  return start;
}

/// Number of runs that end with an error, of triangles that fall beside an inner corner.
int failures(SeedRange range) {
  int failed = 0;
  for (std::uint64_t seed = range.first; seed < range.last; ++seed) {
    Random random(seed);
    const Start start = random_start(random);
    const Surface law{.friction = seed % 3 == 2 ? 0.3 : 0.0, .normal_restitution = 0.0};
    const Terrain ground = seed % 2 == 0 ? corner_of_two_faces() : open_box({1.5, 0.0}, 3.0, 4.0, 0.4);
    Simulation simulation(falling(start, ground, law), EventDriven{});
    try {
      simulation.run_until(2.0);
    } catch (const std::exception& error) {
      ++failed;
      ADD_FAILURE() << "seed " << seed << ": " << error.what();
    }
  }
  return failed;
}

// Without friction one in nine of them came through the wall.
TEST(InnerCorners, TrianglesStayInTheCorner) { EXPECT_EQ(failures(seeds_from(1, 40)), 0); }

TEST(InnerCornersLong, TrianglesStayInTheCorner) { EXPECT_EQ(failures(seeds_from(100, 800, 8000)), 0); }

}  // namespace
