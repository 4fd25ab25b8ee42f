// Prescribed displacements that jump end a run with an error that names the part, the time and the size, in
// both modes, at the last good state; fast, rough and steep ones do not.

#include "tests/integrators/same_run.h"
#include "tests/integrators/throws.h"
#include "tests/random.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::bits_of;

std::vector<Mode> modes() {
  return {TimeStepping{.step = 1e-3}, TimeStepping{.step = 7.3e-4}, EventDriven{}};
}

/// A ball that lies on a table.
System ball_on(const PrescribedMotion& motion) {
  System system;
  system.add(Gravity{{0.0, -9.81}});
  system.add(HalfPlane{.normal = {0.0, 1.0}, .motion = motion},
             Surface{.friction = 0.3, .normal_restitution = 0.5}, "table");
  system.add(Particle{.mass = 1.0}, "ball");
  return system;
}

void expect_jump(const System& system, const Mode& mode, double at, const std::string& part,
                 const std::string& quantity) {
  Simulation simulation(system, mode);
  auto before = bits_of(simulation);
  simulation.observe([&](const Simulation& now) { before = bits_of(now); });
  try {
    simulation.run_until(1.0);
    ADD_FAILURE() << part << " jumps unseen";
  } catch (const SolverError& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find(part + ": " + quantity + " jumps at t = "), std::string::npos) << message;
    EXPECT_NE(message.find("allowed: a continuous one"), std::string::npos) << message;
    ASSERT_EQ(error.failure().parts.size(), 1U);
    EXPECT_EQ(error.failure().parts.front(), part);
    EXPECT_LE(error.failure().time, at);
  }
  EXPECT_EQ(bits_of(simulation), before);
  // A step or an interval before it, or one more where differences feel it ahead.
  EXPECT_LE(simulation.time(), at);
  EXPECT_GE(simulation.time(), at - 0.015);
}

TEST(LawJumps, OfObstacles) {
  constexpr double at = 0.5003;
  const auto jumping = [](double t) { return Vec<2>(0.0, t > at ? 0.01 : 0.0); };
  const auto still = [](double) { return Vec<2>(0.0, 0.0); };
  for (const Mode& mode : modes()) {
    const std::string table = "half-plane 'table'";
    expect_jump(ball_on({.displacement = jumping}), mode, at, table, "displacement");
    expect_jump(ball_on({.displacement = jumping, .velocity = still}), mode, at, table, "displacement");
    expect_jump(ball_on({.displacement = jumping, .velocity = still, .acceleration = still}), mode, at, table,
                "displacement");
    // Breaks are for rates.
    expect_jump(ball_on({.displacement = jumping, .breaks = {at}}), mode, at, table, "displacement");
    expect_jump(ball_on({.angle = [](double t) { return t > at ? 0.02 : 0.0; }}), mode, at, table, "angle");
  }
}

// A step goes ahead of the interval whose laws were looked at, and searches what hits a body behind a jump.
TEST(LawJumps, RightBehindAnIntervalIsNamed) {
  System system;
  system.add(Gravity{{0.0, -9.81}});
  const auto jumping = [](double t) {
    return Vec<2>(0.0, 0.1 * std::sin(20.0 * t) + (t > 0.15 ? 0.5 : 0.0));
  };
  const auto rate = [](double t) { return Vec<2>(0.0, 2.0 * std::cos(20.0 * t)); };
  system.add(
      HalfPlane{
          .point = {0.0, 1.0}, .normal = {0.0, 1.0}, .motion = {.displacement = jumping, .velocity = rate}},
      Surface{.friction = 0.3, .normal_restitution = 0.5}, "table");
  const BodyId ball = system.add(RigidBody{.mass = disc(1.0, 0.1), .position = {0.0, 1.3}});
  system.add(Disc{.body = ball, .radius = 0.1});
  Simulation simulation(system, EventDriven{.evaluation_limit = 100'000});
  EXPECT_THROWS(SolverError, simulation.run_until(0.5),
                "half-plane 'table': displacement jumps at t = 0.15 s");
  EXPECT_LE(simulation.time(), 0.15);
}

/// A crank turned by a law of time.
System driven_crank(const std::function<double(double)>& law, const std::vector<double>& breaks = {}) {
  System system;
  const BodyId crank = system.add(RigidBody{.mass = rod(1.0, 1.0)});
  const JointId pin = system.add(Revolute{.from = ground, .to = crank});
  system.add(Driver{.joint = pin, .position = law, .breaks = breaks}, "motor");
  return system;
}

TEST(LawJumps, OfDrivers) {
  constexpr double at = 0.5003;
  for (const Mode& mode : modes()) {
    const auto law = [](double t) { return 0.3 * t + (t > at ? 0.01 : 0.0); };
    expect_jump(driven_crank(law), mode, at, "driver 'motor'", "position");
    expect_jump(driven_crank(law, {at}), mode, at, "driver 'motor'", "position");
    Simulation good(driven_crank([](double t) { return std::sin(40.0 * t) + std::max(0.0, t - 0.3); }, {0.3}),
                    mode);
    EXPECT_NO_THROW(good.run_until(1.0));
  }
}

// Bodies would move by the one and be struck by the other.
TEST(LawJumps, RatesThatContradictTheirPositionsAreNamed) {
  System crank = driven_crank([](double t) { return t; });
  crank.remove(crank.joints().back());
  const auto way = [](double t) { return Vec<2>(0.0, 0.1 * std::sin(3.0 * t)); };
  for (const Mode& mode : modes()) {
    for (const double rate : {0.0, -1.0, 2.0}) {
      System system = crank;
      system.add(Driver{.joint = system.joints().front(),
                        .position = [](double t) { return t; },
                        .velocity = [=](double) { return rate; }},
                 "false motor");
      Simulation simulation(system, mode);
      const auto before = bits_of(simulation);
      EXPECT_THROWS(SolverError, simulation.run_until(0.1), "driver 'false motor'",
                    "not the rate of position");
      EXPECT_EQ(bits_of(simulation), before);
    }
    const PrescribedMotion shaker{.displacement = way,
                                  .velocity = [](double t) { return Vec<2>(0.0, 0.3 * std::sin(3.0 * t)); }};
    Simulation shaken(ball_on(shaker), mode);
    EXPECT_THROWS(SolverError, shaken.run_until(1.0), "half-plane 'table'", "velocity",
                  "not the rate of displacement", "m/s");
    const PrescribedMotion wheel{.angle = [](double t) { return 0.1 * t; },
                                 .spin = [](double) { return 1.0; }};
    Simulation turned(ball_on(wheel), mode);
    EXPECT_THROWS(SolverError, turned.run_until(1.0), "half-plane 'table'", "spin",
                  "not the rate of angle, off by 0.9", "rad/s");
  }
}

TEST(LawJumps, ContinuousMotionsOfAnySpeedRun) {
  carom_test::Random random(1705);
  for (int repeat = 0; repeat < 6; ++repeat) {
    const double w = random.uniform(10.0, 250.0), size = random.uniform(1e-4, 0.1),
                 kink = random.uniform(0.05, 0.2);
    const PrescribedMotion shaker{
        .displacement =
            [=](double t) { return Vec<2>(0.0, size * std::sin(w * t) + std::max(0.0, t - kink)); },
        .breaks = {kink}};
    for (const Mode& mode : modes()) {
      Simulation simulation(ball_on(shaker), mode);
      EXPECT_NO_THROW(simulation.run_until(0.3)) << w << " rad/s";
    }
    // A step longer than a period sees little of the motion, and no jump in it.
    Simulation coarse(ball_on(shaker), TimeStepping{.step = 0.05});
    EXPECT_NO_THROW(coarse.run_until(0.5));
  }
}

TEST(LawJumps, AnAngleMayCountWholeTurnsAnewWhereItsSpinIsGiven) {
  constexpr double spin = 30.0, turn = 2.0 * 3.14159265358979323846;
  const PrescribedMotion wheel{.angle = [=](double t) { return std::fmod(spin * t, turn); },
                               .spin = [=](double) { return spin; },
                               .angular_acceleration = [](double) { return 0.0; }};
  System system;
  system.add(HalfPlane{.normal = {0.0, 1.0}, .motion = wheel},
             Surface{.friction = 0.0, .normal_restitution = 0.5});
  system.add(Particle{.mass = 1.0, .position = {0.0, 1.0}, .contact = false});
  for (const Mode& mode : modes()) {
    Simulation simulation(system, mode);
    EXPECT_NO_THROW(simulation.run_until(1.0));
  }
}

}  // namespace
