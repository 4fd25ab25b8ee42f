// A brick on an incline, a little below and a little above the angle of friction.

#include "tests/energy/ledger_check.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace carom;
using namespace carom::planar;

constexpr double g = 9.81, friction = 0.5;

/// A brick at rest on a slope that is `share` of the angle of friction.
System brick_on_incline(double share) {
  const double slope = share * std::atan(friction);
  System system;
  system.add(Gravity{{0.0, -g}});
  system.add(HalfPlane{.normal = incline(slope)}, Surface{.friction = friction, .normal_restitution = 0.0});
  const BodyId brick = system.add(RigidBody{.mass = box(2.0, 0.4, 0.2),
                                            .position = 0.1 * Vec<2>(-std::sin(slope), std::cos(slope)),
                                            .angle = slope});
  system.add(Polygon{.body = brick, .vertices = {{-0.2, -0.1}, {0.2, -0.1}, {0.2, 0.1}, {-0.2, 0.1}}});
  return system;
}

void a_brick_below_it_stays(double seconds) {
  Simulation simulation(brick_on_incline(0.99), TimeStepping{.step = 1e-2});
  const State start = simulation.state();
  simulation.run_until(seconds);
  const State& end = simulation.state();
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(end.q[i], start.q[i], 1e-9);
  EXPECT_TRUE(carom_test::ledger_closes(simulation.energy()));
}

TEST(FrictionAngle, ABrickBelowItStays) { a_brick_below_it_stays(100.0); }

TEST(FrictionAngleLong, ABrickBelowItStaysForAnHour) { a_brick_below_it_stays(3600.0); }

TEST(FrictionAngle, ABrickAboveItSlidesWithItsAcceleration) {
  Simulation simulation(brick_on_incline(1.01), TimeStepping{.step = 1e-2});
  const double slope = 1.01 * std::atan(friction), end = 10.0;
  const double acceleration = g * (std::sin(slope) - friction * std::cos(slope));
  simulation.run_until(end);
  const Vec<2> along(-std::cos(slope), -std::sin(slope));
  const Vec<2> velocity = simulation.state().velocity(simulation.system().bodies()[0]);
  // Constant loads: the step is exact.
  EXPECT_NEAR(velocity.dot(along), acceleration * end, 1e-10);
  EXPECT_NEAR(velocity.norm(), acceleration * end, 1e-10);
}

TEST(FrictionAngle, FromEventToEventABrickBelowItIsExactlyAtRest) {
  Simulation simulation(brick_on_incline(0.99), EventDriven{});
  const State start = simulation.state();
  simulation.run_until(3600.0);
  EXPECT_EQ(simulation.state().q, start.q);
  EXPECT_EQ(simulation.state().v, start.v);
}

}  // namespace
