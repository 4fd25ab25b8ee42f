// Contacts that contradict each other: the error names them, what they do and what is allowed, and the
// simulation stands at its last good state. What could not even start is refused at once.

#include "tests/integrators/same_run.h"
#include "tests/integrators/throws.h"
#include "tests/model_error.h"

#include <carom/carom.h>
#include <carom/integrators/run/companion.h>

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::bits_of;

constexpr double radius = 0.2, speed = 0.1;

/// A disc on a floor, and a press that comes down on it, inclined by an angle: friction holds the disc where
/// mu > tan(angle/2).
System press(double friction, double restitution, double angle) {
  const Surface surface{.friction = friction, .normal_restitution = restitution};
  System system;
  system.add(Gravity{{0.0, -9.81}});
  system.add(HalfPlane{.normal = {0.0, 1.0}}, surface, "floor");
  system.add(
      HalfPlane{.point = {0.0, 0.5},
                .normal = {std::sin(angle), -std::cos(angle)},
                .motion = PrescribedMotion{.displacement = [](double t) { return Vec<2>(0.0, -speed * t); },
                                           .velocity = [](double) { return Vec<2>(0.0, -speed); },
                                           .acceleration = [](double) { return Vec<2>(0.0, 0.0); }}},
      surface, "press");
  const BodyId disc =
      system.add(RigidBody{.mass = planar::disc(1.0, radius), .position = {0.0, radius}}, "disc");
  system.add(Disc{.body = disc, .radius = radius});
  return system;
}

TEST(EventUnboundedForces, ADiscThatIsSqueezed) {
  for (const double restitution : {0.0, 0.5, 1.0}) {
    for (const double friction : {0.0, 0.5}) {
      SCOPED_TRACE(testing::Message() << restitution << ", " << friction);
      Simulation simulation(press(friction, restitution, 0.0), EventDriven{.interval = 0.03});
      // From 0.5 m down to the disc's top at 0.4 m: one second.
      EXPECT_THROWS(
          SolverError, simulation.run_until(2.0), "event-driven at t = 1 s", "no solution",
          "rigid body 'disc'", "on half-plane 'floor'",
          "on half-plane 'press' approaches at 0.1 m/s; allowed: what impulses of all that touch can stop");
      EXPECT_NEAR(simulation.time(), 0.99, 1e-12);
      const BodyId disc = simulation.system().body("disc");
      EXPECT_NEAR(simulation.state().position(disc)[1], radius, 1e-12);
      EXPECT_NEAR(simulation.state().velocity(disc).norm(), 0.0, 1e-12);
      // It can be looked at and continued: without the press it rests.
      const auto before = bits_of(simulation);
      EXPECT_THROWS(SolverError, simulation.run_until(2.0), "half-plane 'press'");
      EXPECT_EQ(bits_of(simulation), before);
      simulation.edit([](System& system) { system.remove(system.obstacle("press")); });
      simulation.run_until(2.0);
      EXPECT_NEAR(simulation.state().position(disc)[1], radius, 1e-12);
    }
  }
}

TEST(EventUnboundedForces, AreRecordedAsData) {
  Simulation simulation(press(0.5, 0.0, 0.1), EventDriven{});
  try {
    simulation.run_until(2.0);
    FAIL() << "nothing was thrown";
  } catch (const SolverError& error) {
    EXPECT_EQ(error.failure().time, simulation.time());
    EXPECT_NEAR(error.failure().time + error.failure().step, 0.98996, 1e-5);  // (0.3 cos - 0.2)/(0.1 cos)
    ASSERT_EQ(error.failure().parts.size(), 2u);
    ASSERT_TRUE(error.has_problem());
    EXPECT_EQ(error.problem().groups().size(), 2u);
  }
}

TEST(EventUnboundedForces, WithoutFrictionAWedgeIsLeft) {
  Simulation simulation(press(0.0, 0.0, 0.1), EventDriven{});
  simulation.run_until(1.5);
  // Driven out sideways, away from where the press is nearer to the floor.
  const BodyId disc = simulation.system().body("disc");
  EXPECT_NEAR(simulation.state().position(disc)[1], radius, 1e-9);
  EXPECT_GT(std::abs(simulation.state().position(disc)[0]), 0.1);
}

/// A disc between a floor and a lid.
System between(double height) {
  const Surface surface{.friction = 0.3, .normal_restitution = 0.5};
  System system;
  system.add(HalfPlane{.normal = {0.0, 1.0}}, surface, "floor");
  system.add(HalfPlane{.point = {0.0, height}, .normal = {0.0, -1.0}}, surface, "lid");
  const BodyId disc =
      system.add(RigidBody{.mass = planar::disc(1.0, radius), .position = {0.0, radius}}, "disc");
  system.add(Disc{.body = disc, .radius = radius});
  return system;
}

TEST(EventUnboundedForces, AtAStartThatContradictsItself) {
  EXPECT_MODEL_ERROR(Simulation(between(0.375), EventDriven{}), "rigid body 'disc'", "half-plane 'lid'",
                     "is -0.025", "allowed: not below -gap_tolerance", "1e-09 m");
  // It fits.
  Simulation simulation(between(0.4), EventDriven{});
  simulation.run_until(0.1);
  const auto before = bits_of(simulation);
  EXPECT_MODEL_ERROR(simulation.edit([](System& system) {
    system.add(HalfPlane{.point = {0.0, 0.375}, .normal = {0.0, -1.0}},
               Surface{.friction = 0.0, .normal_restitution = 0.0}, "lower lid");
  }),
                     "rigid body 'disc'", "half-plane 'lower lid'", "is -0.025", "allowed");
  EXPECT_EQ(bits_of(simulation), before);
  // Time stepping starts anywhere.
  EXPECT_NO_THROW(Simulation(between(0.375), TimeStepping{}).step());
}

// Options that allow less than the last ones did.
TEST(EventUnboundedForces, ASmallerToleranceOfGaps) {
  Simulation simulation(between(0.4 - 1e-6), EventDriven{.gap_tolerance = 1e-5});
  const auto before = bits_of(simulation);
  EXPECT_MODEL_ERROR(simulation.switch_to(EventDriven{}), "half-plane 'lid'", "gap_tolerance", "allowed");
  EXPECT_EQ(bits_of(simulation), before);
  EXPECT_EQ(std::get<EventDriven>(simulation.mode()).gap_tolerance, 1e-5);
}

// A state that is set has no modes: what stuck is decided anew, by the speeds and forces that it has.
TEST(EventUnboundedForces, ModesOfAStateThatIsSet) {
  // A block on a slope between mu_k and mu_s: at rest it sticks, once it slides it goes on.
  const double slope = std::atan(0.4);
  System system;
  system.add(Gravity{{0.0, -9.81}});
  system.add(HalfPlane{.normal = incline(slope)},
             Surface{.friction = 0.3, .normal_restitution = 0.0, .static_friction = 0.5}, "slope");
  const BodyId block = system.add(Particle{.mass = 1.0}, "block");
  Simulation simulation(system, EventDriven{});
  simulation.run_until(0.5);
  const auto mode = [&] { return simulation.companion().modes.at(0).second; };
  ASSERT_EQ(mode(), ContactMode::stick);
  const State rest = simulation.state();

  State sliding = rest;
  const Vec<2> down = -Vec<2>(std::cos(slope), std::sin(slope));
  sliding.v[0] = 0.1 * down[0];
  sliding.v[1] = 0.1 * down[1];
  simulation.set_state(sliding);
  EXPECT_TRUE(simulation.companion().modes.empty());
  simulation.clear_events();
  simulation.run_until(1.0);
  ASSERT_EQ(simulation.events().size(), 1u);
  EXPECT_EQ(simulation.events()[0].kind, EventKind::closing);
  EXPECT_NE(mode(), ContactMode::stick);
  const double acceleration = 9.81 * (std::sin(slope) - 0.3 * std::cos(slope));
  EXPECT_NEAR(simulation.state().velocity(block).dot(down), 0.1 + 0.5 * acceleration, 1e-9);

  // Put back to rest while it slides, it sticks: nothing of the sliding is left.
  State back = rest;
  back.time = simulation.time();
  simulation.set_state(back);
  simulation.run_until(1.5);
  EXPECT_EQ(mode(), ContactMode::stick);
  EXPECT_EQ(simulation.state().velocity(block).norm(), 0.0);
}

}  // namespace
