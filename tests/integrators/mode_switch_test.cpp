#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "tests/integrators/throws.h"
#include "tests/model_error.h"

namespace {

using namespace carom;
using namespace carom::planar;

constexpr double gravity = 9.81;

System ball_over_floor(const Surface& surface, const Vec<2>& position, const Vec<2>& velocity) {
  System system;
  system.add(Gravity{{0.0, -gravity}});
  system.add(HalfPlane{.normal = {0.0, 1.0}}, surface);
  system.add(Particle{.mass = 2.0, .position = position, .velocity = velocity}, "ball");
  return system;
}

TEST(ModeSwitch, InFlightNothingChangesButTheMode) {
  const System system = ball_over_floor({.friction = 0.3, .normal_restitution = 0.5}, {0.0, 1.0}, {1.0, 0.0});
  Simulation simulation(system, TimeStepping{.step = 1e-3});
  simulation.run_until(0.2);
  const State before = simulation.state();
  simulation.switch_to(EventDriven{});
  EXPECT_EQ(simulation.state().q, before.q);
  EXPECT_EQ(simulation.state().v, before.v);
  EXPECT_EQ(simulation.energy().flow(EnergyFlow::mode_switch), 0.0);
  simulation.run_until(0.3);
  const BodyId ball = simulation.system().body("ball");
  // Free fall: time stepping is exact in it, and so is the other mode, but for rounding.
  EXPECT_NEAR(simulation.state().position(ball)[1], 1.0 - 0.5 * gravity * 0.09, 1e-13);
  EXPECT_NEAR(simulation.energy().residual(), 0.0, 1e-12);
}

/// Rests on the floor, stands inside a wall that leans over it: moved out of the wall it is above the floor,
/// and falls from there. (The floor was taken for closed, and the body put back into the wall.)
TEST(ModeSwitch, ContactsThatMovingOutOpensAreOpen) {
  for (const bool turns : {false, true}) {
    const double radius = turns ? 0.1 : 0.0, depth = 2.7e-3;
    const Vec<2> normal = Vec<2>(-1.0, 0.5).normalized();
    System system;
    system.add(Gravity{{0.0, -gravity}});
    const Surface smooth{.friction = 0.0, .normal_restitution = 0.0};
    system.add(HalfPlane{.normal = {0.0, 1.0}}, smooth, "floor");
    system.add(HalfPlane{.normal = {-1.0, 0.5}}, smooth, "wall");
    const Vec<2> start((normal[1] * radius - radius + depth) / -normal[0], radius);
    BodyId body;
    if (turns) {
      body = system.add(RigidBody{.mass = disc(1.0, radius), .position = start});
      system.add(Disc{.body = body, .radius = radius});
    } else {
      body = system.add(Particle{.mass = 1.0, .position = start});
    }
    Simulation simulation(std::move(system), TimeStepping{.step = 1e-2});
    simulation.step();
    ASSERT_EQ(simulation.report().contacts.size(), 2U);
    simulation.switch_to(EventDriven{});
    const auto wall_gap = [&] { return normal.dot(simulation.state().position(body)) - radius; };
    const double height = simulation.state().position(body)[1] - radius;
    EXPECT_NEAR(wall_gap(), 0.0, 1e-14);
    EXPECT_NEAR(height, depth * normal[1], 1e-12);  // the shortest way out is along the normal
    simulation.run_until(simulation.time() + 1e-9);
    EXPECT_NEAR(simulation.state().position(body)[1] - radius, height, 1e-12);
    simulation.run_until(simulation.time() + 1e-3);
    EXPECT_GE(wall_gap(), -1e-12);
    // Down along the wall, without friction.
    const double along = Vec<2>(normal[1], -normal[0]).normalized()[1];
    EXPECT_NEAR(height - (simulation.state().position(body)[1] - radius),
                0.5 * gravity * along * along * 1e-6, 1e-10);
    EXPECT_NEAR(simulation.energy().flow(EnergyFlow::projection), 0.0, 1e-12);
    EXPECT_NEAR(simulation.energy().residual(), 0.0, 1e-12);
  }
}

TEST(ModeSwitch, ViolationThatApproachesIsResolvedByAnImpactAndMovedOut) {
  const System system =
      ball_over_floor({.friction = 0.3, .normal_restitution = 0.5}, {0.0, 0.05}, {1.0, -3.0});
  Simulation simulation(system, TimeStepping{.step = 1e-2});
  simulation.run_until(0.02);
  const BodyId ball = simulation.system().body("ball");
  const double depth = -simulation.state().position(ball)[1];
  const double speed = simulation.state().velocity(ball)[1];
  ASSERT_GT(depth, 1e-3);
  ASSERT_LT(speed, -3.0);
  simulation.switch_to(EventDriven{});
  EXPECT_NEAR(simulation.state().velocity(ball)[1], -0.5 * speed, 1e-12);
  EXPECT_NEAR(simulation.state().position(ball)[1], 0.0, 1e-14);
  EXPECT_NEAR(simulation.report().projected, depth, 1e-14);
  ASSERT_EQ(simulation.events().size(), 1U);
  EXPECT_EQ(simulation.events().front().kind, EventKind::mode_switch);
  // Energy of the impact, less the potential energy that lifting the ball out brought in.
  const double taken = simulation.energy().flow(EnergyFlow::mode_switch);
  const double friction =
      std::min(1.0, 0.3 * 1.5 * -speed);  // change of the tangential velocity, 1 if it sticks
  const double kinetic =
      0.5 * 2.0 * (speed * speed * (1.0 - 0.25) + 1.0 - (1.0 - friction) * (1.0 - friction));
  ASSERT_LT(0.0, friction);
  EXPECT_NEAR(taken, kinetic - 2.0 * gravity * depth, 1e-12);
  EXPECT_NEAR(simulation.energy().residual(), 0.0, 1e-12);
  simulation.run_until(5.0);
  EXPECT_EQ(simulation.state().velocity(ball)[1], 0.0);
  EXPECT_NEAR(simulation.energy().residual(), 0.0, 1e-10);
}

// A disc that a long step leaves in the floor while it approaches.
TEST(ModeSwitch, RecordsAreAsCompleteAsThoseOfImpacts) {
  System system;
  const ObstacleId floor =
      system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = 0.0, .normal_restitution = 0.5});
  const BodyId ball =
      system.add(RigidBody{.mass = disc(1.0, 0.1), .position = {0.3, 0.2}, .velocity = {1.0, -6.0}});
  system.add(Disc{.body = ball, .radius = 0.1});
  Simulation simulation(system, TimeStepping{.step = 0.03, .impacts = ImpactTimes::at_step_start});
  simulation.step();
  simulation.switch_to(EventDriven{});
  ASSERT_EQ(simulation.events().size(), 1U);
  const EventRecord event = simulation.events().front();
  EXPECT_EQ(event.kind, EventKind::mode_switch);
  EXPECT_EQ(event.body, ball);
  EXPECT_EQ(event.obstacle, floor);
  EXPECT_NEAR(event.velocity_before[0], -6.0, 1e-14);
  EXPECT_NEAR(event.velocity_after[0], 3.0, 1e-14);
  EXPECT_NEAR(event.impulse[0], 9.0, 1e-14);
  // 0.18 m down from 0.1 m over the floor; the ball came 0.03 m along it.
  EXPECT_NEAR(event.gap, -0.08, 1e-14);
  EXPECT_NEAR(event.normal[1], 1.0, 1e-15);
  EXPECT_NEAR(event.point[0], 0.33, 1e-14);
  EXPECT_NEAR(event.motions[0].velocity_after[1], 3.0, 1e-14);
  EXPECT_NEAR(event.energy_before, 18.5, 1e-13);
  EXPECT_NEAR(event.energy_after, 5.0, 1e-13);
  EXPECT_NEAR(event.contact_work, -13.5, 1e-13);
}

TEST(ModeSwitch, BackAndForthWhileSliding) {
  System system;
  system.add(Gravity{{0.0, -gravity}});
  system.add(HalfPlane{.normal = incline(-0.3)}, Surface{.friction = 0.2, .normal_restitution = 0.0});
  const Vec<2> down(std::cos(0.3), -std::sin(0.3));
  const BodyId block = system.add(Particle{.mass = 1.0, .velocity = 2.0 * down});
  const double acceleration = gravity * (std::sin(0.3) - 0.2 * std::cos(0.3));
  Simulation simulation(system, EventDriven{});
  const auto expect_on_its_way = [&](double tolerance) {
    const double t = simulation.time();
    EXPECT_NEAR(simulation.state().position(block).dot(down), 2.0 * t + 0.5 * acceleration * t * t,
                tolerance);
    EXPECT_NEAR(simulation.energy().residual(), 0.0, 1e-10);
  };
  simulation.run_until(0.5);
  expect_on_its_way(1e-10);
  simulation.switch_to(TimeStepping{.step = 1e-3});
  simulation.run_until(1.0);
  // Lasting contact is found a step late at most once, at the change: h^2 g.
  expect_on_its_way(1e-4);
  simulation.switch_to(EventDriven{});
  simulation.run_until(1.5);
  expect_on_its_way(1e-4);
}

TEST(ModeSwitch, StickingStaysSticking) {
  System system;
  system.add(Gravity{{0.0, -gravity}});
  system.add(HalfPlane{.normal = incline(0.2)}, Surface{.friction = 0.5, .normal_restitution = 0.3});
  const BodyId brick =
      system.add(RigidBody{.mass = box(1.0, 0.4, 0.2), .position = 0.1 * incline(0.2), .angle = 0.2});
  system.add(Polygon{.body = brick, .vertices = {{-0.2, -0.1}, {0.2, -0.1}, {0.2, 0.1}, {-0.2, 0.1}}});
  Simulation simulation(system, EventDriven{});
  const State start = simulation.state();
  for (int i = 1; i <= 3; ++i) {
    simulation.run_until(0.2 * i - 0.1);
    simulation.switch_to(TimeStepping{.step = 1e-3});
    simulation.run_until(0.2 * i);
    simulation.switch_to(EventDriven{});
  }
  for (std::size_t i = 0; i < start.q.size(); ++i) {
    EXPECT_NEAR(simulation.state().q[i], start.q[i], 1e-4) << i;  // h^2 g at every change
  }
  simulation.run_until(1.0);
  for (const double v : simulation.state().v) EXPECT_NEAR(v, 0.0, 1e-12);
}

/// The block of a run that comes to rest, switched after every step: what sticks has its tangential
/// restitution in time stepping, which no contact that holds can take along. (The projection onto such
/// contacts took more than `largest_projection`, and the run ended.)
TEST(ModeSwitch, WhatSticksWithARestitutionIsNotHeld) {
  System system;
  system.add(Gravity{{0.0, -gravity}});
  const double friction = 0.3;
  system.add(HalfPlane{.normal = {0.0, 1.0}},
             Surface{.friction = friction, .normal_restitution = 0.5, .tangential_restitution = 0.5});
  const BodyId block = system.add(
      RigidBody{.mass = box(1.0, 0.4, 0.2), .position = {0.0, 0.1}, .velocity = {0.1, 0.0}}, "block");
  system.add(Polygon{.body = block, .vertices = {{-0.2, -0.1}, {0.2, -0.1}, {0.2, 0.1}, {-0.2, 0.1}}});
  Simulation steps(system, TimeStepping{.step = 1e-3});
  int held = 0;
  for (int i = 0; i < 60; ++i) {  // it rests after 34
    steps.step();
    Simulation simulation(system, TimeStepping{.step = 1e-3});
    simulation.run_until(steps.time());
    simulation.switch_to(EventDriven{});
    const Vec<2> start = simulation.state().position(block), velocity = simulation.state().velocity(block);
    if (velocity[0] < 0.0) ++held;  // came back, by half of what it had
    simulation.run_until(simulation.time() + 0.1);
    const double way = velocity[0] * std::abs(velocity[0]) / (2.0 * friction * gravity);
    EXPECT_NEAR(simulation.state().position(block)[0], start[0] + way, 1e-9) << i;
    EXPECT_NEAR(simulation.energy().residual(), 0.0, 1e-10) << i;
  }
  EXPECT_GT(held, 2);
}

/// Discs on each other on the floor, which time stepping leaves in each other and in the floor.
System tower(int count) {
  System system;
  system.add(Gravity{{0.0, -gravity}});
  system.set_default_law(Surface{.friction = 0.4, .normal_restitution = 0.3, .tangential_restitution = 0.3});
  system.add(HalfPlane{.normal = {0.0, 1.0}}, "floor");
  for (int i = 0; i < count; ++i) {
    const BodyId disc_id = system.add(RigidBody{.mass = disc(1.0, 0.1), .position = {0.0, 0.105 + 0.21 * i}});
    system.add(Disc{.body = disc_id, .radius = 0.1});
  }
  return system;
}

TEST(ModeSwitch, BodiesThatStandInEachOtherComeApart) {
  Simulation simulation(tower(3), TimeStepping{.step = 2e-3});
  simulation.run_until(0.5);
  const State before = simulation.state();
  const auto gap = [&](const State& state, std::size_t i) {
    return state.q[3 * i + 1] - (i == 0 ? 0.1 : state.q[3 * i - 2] + 0.2);
  };
  double lift = 0.0, lifts = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    ASSERT_LT(gap(before, i), -1e-4);  // deeper than the event-driven mode starts with
    lifts += lift -= gap(before, i);
  }
  simulation.switch_to(EventDriven{});
  // All upwards: the floor is under them.
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(gap(simulation.state(), i), 0.0, 1e-14);
  EXPECT_NEAR(simulation.report().projected, lift, 1e-14);
  EXPECT_NEAR(simulation.energy().flow(EnergyFlow::mode_switch), -gravity * lifts, 1e-12);
  EXPECT_NEAR(simulation.energy().residual(), 0.0, 1e-12);
  const double height = simulation.state().q[7];
  simulation.run_until(1.0);
  EXPECT_NEAR(simulation.state().q[7], height, 1e-9);
  EXPECT_NEAR(simulation.energy().residual(), 0.0, 1e-10);
}

TEST(ModeSwitch, BodiesWithoutRoomKeepTheMode) {
  // Three discs of 0.2 m side by side, 0.59 m between the walls.
  System system;
  system.set_default_law(Surface{.friction = 0.3, .normal_restitution = 0.0});
  system.add(HalfPlane{.normal = {1.0, 0.0}}, "left wall");
  system.add(HalfPlane{.point = {0.59, 0.0}, .normal = {-1.0, 0.0}}, "right wall");
  system.add(HalfPlane{.point = {0.0, -5.0}, .normal = {0.0, 1.0}}, "floor");
  for (const double x : {0.1, 0.295, 0.49}) {
    const BodyId disc_id = system.add(RigidBody{.mass = disc(1.0, 0.1), .position = {x, 0.0}});
    system.add(Disc{.body = disc_id, .radius = 0.1});
  }
  Simulation simulation(std::move(system), TimeStepping{});
  const State before = simulation.state();
  EXPECT_THROWS(SolverError, simulation.switch_to(EventDriven{}), "no displacement opens the gaps of",
                "half-plane 'right wall'", "disc #1", "and 1 more", "bodies that have room");
  EXPECT_TRUE(std::holds_alternative<TimeStepping>(simulation.mode()));
  EXPECT_EQ(simulation.state().q, before.q);
  EXPECT_EQ(simulation.energy().flow(EnergyFlow::mode_switch), 0.0);
  simulation.step();
}

TEST(ModeSwitch, ImpossibleOptionsChangeNothing) {
  Simulation simulation(ball_over_floor({.friction = 0.0, .normal_restitution = 1.0}, {0.0, 1.0}, {0.0, 0.0}),
                        TimeStepping{});
  simulation.run_until(0.1);
  EXPECT_MODEL_ERROR(simulation.switch_to(EventDriven{.relative_tolerance = 0.0}), "relative_tolerance is 0");
  EXPECT_TRUE(std::holds_alternative<TimeStepping>(simulation.mode()));
  simulation.run_until(0.2);
  EXPECT_EQ(simulation.time(), 0.2);
}

}  // namespace
