// Scenes with all shapes on ground: accounts close, nothing sinks in, and both modes tell the same.

#include "tests/energy/ledger_check.h"
#include "tests/integrators/event_run.h"
#include "tests/model_error.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <random>
#include <string>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::ledger_closes;
using carom_test::LedgerWatch;
using carom_test::tight;

constexpr double g = 9.81;

enum class Form { disc, capsule, brick, rounded, compound };

BodyId add_body(System& system, Form form, const Vec<2>& position, double angle) {
  const RigidBody described{.mass = box(1.0, 0.3, 0.2), .position = position, .angle = angle};
  const BodyId body = system.add(described);
  switch (form) {
    case Form::disc:
      system.add(Disc{.body = body, .radius = 0.12});
      break;
    case Form::capsule:
      system.add(Segment{.body = body, .from = {-0.12, 0.0}, .to = {0.12, 0.0}, .radius = 0.05});
      break;
    case Form::brick:
      system.add(Polygon{.body = body, .vertices = {{-0.15, -0.1}, {0.15, -0.1}, {0.15, 0.1}, {-0.15, 0.1}}});
      break;
    case Form::rounded:
      system.add(
          Polygon{.body = body, .vertices = {{-0.12, -0.08}, {0.12, -0.08}, {0.0, 0.1}}, .radius = 0.03});
      break;
    case Form::compound:
      system.add(Segment{.body = body, .from = {-0.12, -0.08}, .to = {0.12, -0.08}, .radius = 0.02});
      system.add(Disc{.body = body, .radius = 0.06, .centre = {0.05, 0.03}});
      break;
  }
  return body;
}

/// Stairs, pegs, a block, a turning wall and a drum around all: bodies fall through and come to rest below.
void add_ground(System& system, bool moving) {
  Terrain down = stairs({-1.5, 0.5}, 4, 0.45, -0.3);
  system.add(down, "stairs");
  system.add(Peg{.centre = {0.9, 0.7}, .radius = 0.1}, "peg");
  system.add(planar::Block{.vertices = {{1.4, -0.3}, {1.9, 0.2}, {2.2, -0.3}}}, "block");
  Wall paddle{.from = {-0.6, 1.6}, .to = {0.2, 1.6}, .radius = 0.04, .pivot = {-0.2, 1.6}};
  if (moving) {
    paddle.motion.angle = [](double t) { return 0.8 * std::sin(2.0 * t); };
    paddle.motion.spin = [](double t) { return 1.6 * std::cos(2.0 * t); };
    paddle.motion.angular_acceleration = [](double t) { return -3.2 * std::sin(2.0 * t); };
  }
  system.add(paddle, "paddle");
  CircleInside around = drum({0.0, 0.0}, 4.0, moving ? 0.4 : 0.0);
  around.surface_speed = moving ? 0.2 : 0.0;
  system.add(around, "drum");
}

System random_scene(unsigned seed, int bodies, bool moving, bool touching, double restitution) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  System system;
  system.add(Gravity{{0.0, -g}});
  system.set_default_law({.friction = 0.4, .normal_restitution = restitution});
  add_ground(system, moving);
  for (int i = 0; i < bodies; ++i) {
    const double x = -1.2 + 0.5 * (i % 6) + 0.05 * unit(random);
    const double y = 2.0 + 0.4 * (i / 6) + 0.05 * unit(random);
    const double angle = 3.0 * unit(random);
    add_body(system, static_cast<Form>(i % 5), {x, y}, angle);
  }
  if (!touching) {
    const std::vector<BodyId> all = system.bodies();
    for (std::size_t i = 0; i < all.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) system.allow_contact(all[i], all[j], false);
    }
  }
  return system;
}

void accounts_close_in_time_stepping(unsigned first, unsigned last) {
  for (const bool moving : {false, true}) {
    for (unsigned seed = first; seed <= last; ++seed) {
      const double restitution = seed % 2 == 0 ? 0.3 : 0.0;
      Simulation simulation(random_scene(seed, 15, moving, true, restitution), TimeStepping{.step = 1e-3});
      double most_work = 0.0;  // of the ground so far; in the end works of several shapes may nearly cancel
      simulation.observe([&](const Simulation& now) {
        most_work = std::max(most_work, std::abs(now.energy().flow(EnergyFlow::external)));
      });
      simulation.run_until(3.0);
      EXPECT_TRUE(ledger_closes(simulation.energy())) << simulation.energy();
      EXPECT_GT(simulation.statistics().deepest_gap, -0.02);  // two steps of the fastest
      EXPECT_GT(simulation.report().contacts.size(), 10U);
      for (const BodyId body : simulation.system().bodies()) {
        EXPECT_LT(simulation.state().position(body).norm(), 4.0);
      }
      EXPECT_TRUE(moving ? most_work > 0.01 : most_work == 0.0) << most_work;
    }
  }
}

TEST(GroundScenes, AccountsCloseInTimeStepping) { accounts_close_in_time_stepping(1, 1); }

TEST(GroundScenesLong, AccountsCloseInTimeStepping) { accounts_close_in_time_stepping(2, 4); }

TEST(GroundScenes, AccountsCloseFromEventToEvent) {
  for (const bool moving : {false, true}) {
    for (unsigned seed = 1; seed <= 3; ++seed) {
      Simulation simulation(random_scene(seed, 5, moving, false, 0.3), tight());
      const LedgerWatch watch(simulation);
      simulation.run_until(2.0);
      EXPECT_TRUE(watch.closes());
      EXPECT_GT(simulation.statistics().impacts, 10);
      for (const BodyId body : simulation.system().bodies()) {
        EXPECT_LT(simulation.state().position(body).norm(), 4.0);
      }
    }
  }
}

/// One body that falls on the ground; where it is after a time, in time stepping with located impacts the
/// closer the shorter the steps.
Vec<3> after(Form form, const Vec<2>& start, double time, const Mode& mode) {
  System system;
  system.add(Gravity{{0.0, -g}});
  system.set_default_law({.friction = 0.3, .normal_restitution = 0.4});
  add_ground(system, false);
  const BodyId body = add_body(system, form, start, 0.3);
  Simulation simulation(system, mode);
  simulation.run_until(time);
  const Vec<2> place = simulation.state().position(body);
  return {place[0], place[1], simulation.state().angle(body)};
}

void both_modes_tell_the_same(std::initializer_list<Form> forms) {
  for (const Form form : forms) {
    for (const Vec<2>& start : {Vec<2>(-0.9, 1.0), Vec<2>(0.85, 1.2), Vec<2>(1.75, 0.9), Vec<2>(0.0, -3.4)}) {
      const double time = 0.4;
      const Vec<3> exact = after(form, start, time, tight());
      const Vec<3> coarse = after(form, start, time, TimeStepping{.step = 1e-4});
      const Vec<3> fine = after(form, start, time, TimeStepping{.step = 1e-5});
      EXPECT_LE((fine - exact).norm(), 3e-3) << static_cast<int>(form) << " at " << start.transpose();
      EXPECT_LE((fine - exact).norm(), 0.4 * (coarse - exact).norm() + 2e-5)
          << static_cast<int>(form) << " at " << start.transpose();
    }
  }
}

TEST(GroundScenes, BothModesTellTheSame) { both_modes_tell_the_same({Form::compound}); }

TEST(GroundScenesLong, BothModesTellTheSame) {
  both_modes_tell_the_same({Form::disc, Form::capsule, Form::brick, Form::rounded});
}

TEST(GroundScenes, ReportsNameTheGroundAndThePlace) {
  System system;
  system.add(Gravity{{0.0, -g}});
  system.set_default_law({.friction = 0.3, .normal_restitution = 0.0});
  system.add(CircleInside{.radius = 2.0}, "bowl");
  const BodyId body = system.add(RigidBody{.mass = disc(1.0, 0.5), .position = {0.0, -1.5}});
  system.add(Disc{.body = body, .radius = 0.5}, "ball");
  Simulation simulation(system, TimeStepping{.step = 1e-3});
  const StepReport& report = simulation.step();
  ASSERT_EQ(report.contacts.size(), 1U);
  EXPECT_EQ(report.contacts[0].obstacle, system.obstacle("bowl"));
  EXPECT_EQ(simulation.name(report.contacts[0].key),
            "disc 'ball' (feature 0) of rigid body #0 on inside of a circle 'bowl'");
  EXPECT_NEAR(report.contacts[0].point[1], -2.0, 1e-14);
  EXPECT_EQ(report.contacts[0].normal[1], 1.0);
  EXPECT_NEAR(report.contacts[0].impulse[0], g * 1e-3, 1e-14);
}

TEST(GroundScenes, WhatCannotTouchIsRefusedByName) {
  System system;
  system.add(Peg{.radius = 0.1}, "peg");
  const BodyId body = system.add(RigidBody{.mass = disc(1.0, 0.5), .position = {0.0, 2.0}});
  system.add(Disc{.body = body, .radius = 0.5}, "ball");
  EXPECT_MODEL_ERROR(Simulation(system, TimeStepping{}), "disc 'ball'", "peg 'peg'", "law is not given");
  system.set_default_law({.friction = 0.0, .normal_restitution = 0.0});
  system.add(Polygon{.body = body, .vertices = {{0, 0}, {1, 0}, {0.2, 0.2}, {0, 1}}}, "boomerang");
  EXPECT_MODEL_ERROR(Simulation(system, TimeStepping{}), "polygon 'boomerang'", "not convex");
}

TEST(GroundScenes, FiltersHold) {
  System system;
  system.add(Gravity{{0.0, -g}});
  system.set_default_law({.friction = 0.0, .normal_restitution = 0.0});
  system.add(Terrain{.vertices = {{-1, 0}, {1, 0}}, .depth = 0.5, .filter = {.groups = 2}});
  system.add(Terrain{.vertices = {{-1, -2}, {1, -2}}, .depth = 0.5});
  const BodyId body = system.add(RigidBody{.mass = disc(1.0, 0.1), .position = {0.0, 0.1}});
  system.add(Disc{.body = body, .radius = 0.1, .filter = {.touches = 1}});
  for (const Mode& mode : {Mode(TimeStepping{}), Mode(tight())}) {
    Simulation simulation(system, mode);
    simulation.run_until(1.0);
    EXPECT_NEAR(simulation.state().position(body)[1], -1.9, 1e-2);
  }
}

TEST(GroundScenes, BuildersRefuseWhatIsNotAllowed) {
  const double nan = std::nan("");
  EXPECT_MODEL_ERROR(static_cast<void>(stairs({0, 0}, 0, 0.3, 0.2)), "stairs: number of steps is 0",
                     "at least 1");
  EXPECT_MODEL_ERROR(static_cast<void>(stairs({0, 0}, 2, -0.3, 0.2)), "tread is -0.3 m", "> 0");
  EXPECT_MODEL_ERROR(static_cast<void>(stairs({0, nan}, 2, 0.3, 0.2)), "start is nan m");
  EXPECT_MODEL_ERROR(static_cast<void>(stairs({0, 0}, 2, 0.3, 0.0)), "rise is 0 m", "not 0");
  EXPECT_MODEL_ERROR(static_cast<void>(hopper({0, 0}, 0.5, 0.4, 1, 0.1)), "width is 0.4 m", "wider");
  EXPECT_MODEL_ERROR(static_cast<void>(drum({0, 0}, 1.0, nan)), "spin is nan rad/s");
  EXPECT_MODEL_ERROR(static_cast<void>(open_box({0, 0}, 1.0, 0.0, 0.1)), "height is 0 m");
}

}  // namespace
