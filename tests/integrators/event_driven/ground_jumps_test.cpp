// Velocities of shapes on ground that jump at a time of `breaks`, under bodies that rest on them: these are
// hit, left behind or begin to slip, with closed forms.

#include "tests/integrators/event_driven/body_scenes.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace {

using namespace body_scenes;

constexpr double jump = 0.2, end = 0.25, after = end - jump;  // [s]
constexpr double friction = 0.3;

/// A box of 1 kg on a table that stands still up to `jump`, and has a velocity from then on.
struct BoxOnTable {
  System system;
  BodyId box;

  BoxOnTable(const Vec<2>& velocity, double restitution) {
    system.add(Gravity{{0.0, -g}});
    const auto moves = [=](double t) -> Vec<2> { return std::max(0.0, t - jump) * velocity; };
    const auto rate = [=](double t) -> Vec<2> { return t < jump ? Vec<2>(0.0, 0.0) : velocity; };
    const auto none = [](double) { return Vec<2>(0.0, 0.0); };
    system.add(
        HalfPlane{
            .normal = {0.0, 1.0},
            .motion = {.displacement = moves, .velocity = rate, .acceleration = none, .breaks = {jump}}},
        Surface{.friction = friction, .normal_restitution = restitution}, "table");
    box = add_box(system, 1.0, 0.4, 0.2, {0.0, 0.1});
  }
};

std::int64_t count(const Simulation& simulation, EventKind kind) {
  return simulation.statistics().events[static_cast<std::size_t>(kind)];
}

// It did not approach before, so nothing is given back.
TEST(GroundJumps, TableThatRisesTakesTheBoxAlong) {
  for (const double restitution : {0.0, 0.5}) {
    for (const double speed : {1e-6, 1e-3, 1.0}) {
      const BoxOnTable scene({0.0, speed}, restitution);
      Simulation simulation(scene.system, EventDriven{});
      simulation.run_until(end);
      EXPECT_NEAR(simulation.state().position(scene.box)[1], 0.1 + speed * after, 1e-12) << speed;
      EXPECT_NEAR(simulation.state().velocity(scene.box)[1], speed, 1e-12) << speed;
      // The work of the weight's reaction, and of the impulse m v.
      const double work = speed * speed + g * speed * after;
      // Steps have the tolerance 1e-11 J each.
      EXPECT_NEAR(simulation.energy().flow(EnergyFlow::external), work, 1e-9) << speed;
      EXPECT_NEAR(simulation.energy().residual(), 0.0, 1e-9);
    }
  }
}

TEST(GroundJumps, TableThatFallsLeavesTheBoxBehind) {
  for (const Vec<2>& velocity : {Vec<2>(0.0, -1.0), Vec<2>(1.0, -0.5)}) {
    const BoxOnTable scene(velocity, 0.5);
    Simulation simulation(scene.system, EventDriven{});
    simulation.run_until(end);
    EXPECT_NEAR(simulation.state().position(scene.box)[1], 0.1 - 0.5 * g * after * after, 1e-12);
    EXPECT_NEAR(simulation.state().velocity(scene.box)[0], 0.0, 1e-12);
    EXPECT_EQ(count(simulation, EventKind::lift_off), 2);
    EXPECT_EQ(count(simulation, EventKind::impact), 0);
  }
}

TEST(GroundJumps, TableThatIsPulledAwaySlipsBelowTheBox) {
  const BoxOnTable scene({1.0, 0.0}, 0.5);
  Simulation simulation(scene.system, EventDriven{});
  simulation.run_until(end);
  EXPECT_NEAR(simulation.state().velocity(scene.box)[0], friction * g * after, 1e-12);
  EXPECT_NEAR(simulation.state().position(scene.box)[0], 0.5 * friction * g * after * after, 1e-12);
  EXPECT_NEAR(simulation.energy().flow(EnergyFlow::external), friction * g * after, 1e-11);
  EXPECT_EQ(count(simulation, EventKind::slip), 2);
}

// A piston that is accelerated, and stops: it throws what lies on it.
TEST(GroundJumps, PistonThatStopsThrowsTheBall) {
  constexpr double acceleration = 20.0, thrown = acceleration * jump, height = 0.5 * thrown * jump;
  const auto rises = [](double t) {
    return Vec<2>(0.0, 0.5 * acceleration * std::min(t, jump) * std::min(t, jump));
  };
  const auto rate = [](double t) { return Vec<2>(0.0, t < jump ? acceleration * t : 0.0); };
  const auto second = [](double t) { return Vec<2>(0.0, t < jump ? acceleration : 0.0); };
  System system;
  system.add(Gravity{{0.0, -g}});
  system.add(
      HalfPlane{
          .normal = {0.0, 1.0},
          .motion = {.displacement = rises, .velocity = rate, .acceleration = second, .breaks = {jump}}},
      Surface{.friction = friction, .normal_restitution = 0.5}, "piston");
  const BodyId ball = add_disc(system, 1.0, 0.1, {0.0, 0.1});
  Simulation simulation(system, EventDriven{});
  const double flight = 0.3;
  simulation.run_until(jump + flight);
  // Of a velocity of 4 m/s steps leave a part of 1e-9 each.
  constexpr double left = 10.0 * 1e-9 * thrown;
  EXPECT_NEAR(simulation.state().position(ball)[1],
              0.1 + height + thrown * flight - 0.5 * g * flight * flight, left * flight);
  EXPECT_NEAR(simulation.energy().flow(EnergyFlow::external), 0.5 * thrown * thrown + g * height,
              left * thrown);
  simulation.run_until(4.0);  // it bounces to rest
  EXPECT_NEAR(simulation.state().position(ball)[1], 0.1 + height, 1e-9);
}

}  // namespace
