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

/// The motion along a direction with a velocity that turns round every `jump`, from +1 m/s on.
PrescribedMotion to_and_fro(const Vec<2>& along) {
  const auto half_period = [](double t) {
    double k = std::floor(t / jump);
    if (jump * (k + 1.0) <= t) k += 1.0;
    return jump * k <= t ? k : k - 1.0;
  };
  const auto sign = [=](double t) { return std::fmod(half_period(t), 2.0) == 0.0 ? 1.0 : -1.0; };
  PrescribedMotion motion;
  motion.displacement = [=](double t) -> Vec<2> {
    const double since = t - jump * half_period(t);
    return (sign(t) > 0.0 ? since : jump - since) * along;
  };
  motion.velocity = [=](double t) -> Vec<2> { return sign(t) * along; };
  motion.acceleration = [](double) { return Vec<2>(0.0, 0.0); };
  for (int k = 0; k < 10; ++k) motion.breaks.push_back(jump * k);
  return motion;
}

// A body that slides when the ground turns round slides the other way at once: the end of a step at the jump
// belongs to the motion before it.
TEST(GroundJumps, TableThatTurnsRoundTurnsTheFrictionRound) {
  System system;
  system.add(Gravity{{0.0, -g}});
  system.add(HalfPlane{.normal = {0.0, 1.0}, .motion = to_and_fro({1.0, 0.0})},
             Surface{.friction = friction, .normal_restitution = 0.0});
  const BodyId ball = system.add(Particle{.mass = 1.0});
  const BodyId box = add_box(system, 1.0, 0.4, 0.2, {2.0, 0.1});
  Simulation simulation(system, EventDriven{});
  // It is accelerated and slowed down in turns, and is never as fast as the table.
  const double fastest = friction * g * jump, way = fastest * jump;
  for (int k = 1; k <= 7; ++k) {
    simulation.run_until(jump * k);
    EXPECT_NEAR(simulation.state().velocity(ball)[0], k % 2 == 1 ? fastest : 0.0, 1e-10) << k;
    EXPECT_NEAR(simulation.state().position(ball)[0], 0.5 * k * way, 1e-10) << k;
    EXPECT_NEAR(simulation.state().position(box)[0], 2.0 + 0.5 * k * way, 1e-10) << k;
  }
  EXPECT_EQ(count(simulation, EventKind::discontinuity), 2 * 7);
}

// 3 * 0.2 is no double: the end of the step before it is another one.
TEST(GroundJumps, TimesOfJumpsMayBeRounded) {
  System system;
  system.add(Gravity{{0.0, -g}});
  constexpr double speed = 0.1;
  system.add(HalfPlane{.normal = {0.0, 1.0}, .motion = to_and_fro({0.0, speed})},
             Surface{.friction = friction, .normal_restitution = 0.0});
  const BodyId ball = add_disc(system, 1.0, 0.1, {0.0, 0.1});
  Simulation simulation(system, EventDriven{});
  simulation.run_until(5.5 * jump);
  EXPECT_NEAR(simulation.state().position(ball)[1], 0.1 + 0.5 * jump * speed, 1e-10);
  EXPECT_NEAR(simulation.state().velocity(ball)[1], -speed, 1e-10);
}

// Two parts jump at times that differ by their rounding only.
TEST(GroundJumps, JumpsMayFollowEachOtherByTheRoundingOfTime) {
  const BoxOnTable scene({1.0, 0.0}, 0.0);
  System system = scene.system;
  constexpr double push = 2.0;
  for (const double later : {std::nextafter(jump, 1.0), jump * (1.0 + 1e-15), jump * (1.0 + 4e-15)}) {
    const auto force = [=](double t) { return Vec<2>(t < later ? 0.0 : push, 0.0); };
    system.add(AppliedForce{.on = scene.box, .force = force, .breaks = {later}});
  }
  Simulation simulation(system, EventDriven{});
  simulation.run_until(end);
  EXPECT_NEAR(simulation.state().velocity(scene.box)[0], (friction * g + 3.0 * push) * after, 1e-11);
  EXPECT_EQ(count(simulation, EventKind::discontinuity), 4);
}

}  // namespace
