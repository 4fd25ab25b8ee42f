// Captures that would move bodies: contacts that are slow together close together only where that moves
// nothing.

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace carom;
using namespace carom::planar;

// A disc falls slowly to the first of two planes, 5e-5 rad apart, and comes to rest 1e-10 m above the second.
// Both gaps close only 2e-6 m further to the left, within a wall.
TEST(EventCaptures, PlanesThatAreAlmostParallelMoveNothingIntoAWall) {
  constexpr double radius = 0.1, angle = 5e-5, fall = 1e-7, left = 1e-10, wall = 1e-6;
  System system;
  system.add(Gravity{{0.0, -0.01}});
  system.set_default_law({.friction = 0.3, .normal_restitution = 0.5});
  const Vec<2> inclined(std::sin(angle), std::cos(angle)), rest(0.0, radius);
  system.add(HalfPlane{.normal = {0.0, 1.0}}, "first");
  system.add(HalfPlane{.point = rest - (radius + left) * inclined, .normal = inclined}, "second");
  system.add(HalfPlane{.point = {-radius - wall, 0.0}, .normal = {1.0, 0.0}}, "wall");
  const BodyId body = system.add(RigidBody{.mass = disc(1.0, radius), .position = {0.0, radius + fall}});
  system.add(Disc{.body = body, .radius = radius});
  Simulation simulation(system, EventDriven{.interval = 1e-3});
  simulation.run_until(0.1);
  EXPECT_GT(simulation.statistics().events[static_cast<std::size_t>(EventKind::accumulation)], 0);
  // It was to move by the gap over the angle.
  EXPECT_NEAR(simulation.state().position(body)[0], 0.0, 1e-3 * left / angle);
  EXPECT_NEAR(simulation.state().position(body)[1], radius, EventDriven{}.gap_tolerance);
}

}  // namespace
