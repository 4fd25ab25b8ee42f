// Nothing passes through anything, however fast and thin it is.

#include "tests/allocation_counter.h"
#include "tests/energy/ledger_check.h"
#include "tests/integrators/throws.h"
#include "tests/model_error.h"
#include "tests/random.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::ledger_closes;

constexpr double h = 1e-3;
const TimeStepping safe{.step = h, .overlaps = {.never_tunnel = true}};
const std::vector<double> speeds{1e2, 1e3, 1e4, 1e5};

BodyId add_disc(System& system, double radius, const Vec<2>& place, const Vec<2>& velocity = Vec<2>::Zero()) {
  const BodyId body =
      system.add(RigidBody{.mass = disc(1.0, radius), .position = place, .velocity = velocity});
  system.add(Disc{.body = body, .radius = radius});
  return body;
}

/// A wall of 1 mm across the way of a bullet.
constexpr double wall_at = 0.0371, half_thickness = 5e-4;

System bullet_before_wall(double speed, double restitution) {
  System system;
  system.add(Wall{.from = Vec<2>(wall_at, -1.0), .to = Vec<2>(wall_at, 1.0), .radius = half_thickness},
             Surface{.friction = 0.0, .normal_restitution = restitution}, "wall");
  system.add(Particle{.mass = 0.01, .velocity = {speed, 0.0}}, "bullet");
  return system;
}

TEST(NeverTunnel, BulletsAndAThinWall) {
  const double surface = wall_at - half_thickness;
  for (const double speed : speeds) {
    Simulation passes(bullet_before_wall(speed, 0.5), TimeStepping{.step = h});
    passes.step();
    EXPECT_GT(passes.state().q[0], wall_at) << speed;
    for (const double e : {0.0, 0.5, 1.0}) {
      Simulation simulation(bullet_before_wall(speed, e), safe);
      simulation.step();
      const double way = speed * h - surface;  // that is left behind the wall
      // It is stopped up to an eighth and a half of the half thickness deep.
      EXPECT_NEAR(simulation.state().q[0], surface - e * way, 0.19 * half_thickness * (1.0 + e)) << speed;
      EXPECT_NEAR(simulation.state().v[0], -e * speed, 1e-12 * speed);
      EXPECT_EQ(simulation.time(), h);
      EXPECT_EQ(simulation.report().step, h);
      EXPECT_EQ(simulation.statistics().impacts, 1);
      EXPECT_TRUE(ledger_closes(simulation.energy()));
    }
  }
}

TEST(NeverTunnel, ABulletBetweenTwoWalls) {
  for (const double speed : speeds) {
    System system = bullet_before_wall(speed, 1.0);
    system.add(planar::Block{.vertices = {{-0.031, -1.0}, {-0.03, -1.0}, {-0.03, 1.0}, {-0.031, 1.0}}},
               Surface{.friction = 0.0, .normal_restitution = 1.0});
    Simulation simulation(system, safe);
    simulation.run_until(0.02);
    EXPECT_LT(simulation.state().q[0], wall_at) << speed;
    EXPECT_GT(simulation.state().q[0], -0.0305) << speed;
    const double bounces = speed * 0.02 / (wall_at - half_thickness + 0.03);
    EXPECT_NEAR(static_cast<double>(simulation.statistics().impacts), bounces, 1.0 + 0.01 * bounces);
    EXPECT_NEAR(std::abs(simulation.state().v[0]), speed, 1e-9 * speed);
  }
}

TEST(NeverTunnel, BothMove) {
  for (const double speed : speeds) {
    System system;
    system.set_default_law({.friction = 0.0, .normal_restitution = 1.0});
    const BodyId left = add_disc(system, 0.01, {-0.4, 0.0}, {speed, 0.0});
    const BodyId right = add_disc(system, 0.01, {0.3, 0.001}, {-speed, 0.0});
    Simulation simulation(system, safe);
    for (int i = 0; i < 20; ++i) {
      simulation.step();
      const Vec<2> apart = simulation.state().position(right) - simulation.state().position(left);
      EXPECT_GT(apart[0], 0.0) << speed;
    }
    EXPECT_EQ(simulation.statistics().impacts, 1);
    // Equal masses, no friction: speeds are exchanged along the normal, sin 0.05 of which is across.
    EXPECT_NEAR(simulation.state().velocity(left)[0], -speed, 0.02 * speed);
    EXPECT_TRUE(ledger_closes(simulation.energy()));
  }
}

TEST(NeverTunnel, AFastDiscAndALineOfDiscs) {
  for (const double speed : speeds) {
    System system;
    system.set_default_law({.friction = 0.0, .normal_restitution = 1.0});
    std::vector<BodyId> line{add_disc(system, 0.01, {-0.1, 0.0}, {speed, 0.0})};
    for (int i = 0; i < 10; ++i) line.push_back(add_disc(system, 0.01, {0.05 * i, 0.0}));
    Simulation simulation(system, safe);
    simulation.run_until(1.0 / speed + 5.0 * h);
    for (std::size_t i = 1; i < line.size(); ++i) {
      const double gap =
          simulation.state().position(line[i])[0] - simulation.state().position(line[i - 1])[0] - 0.02;
      EXPECT_GT(gap, -0.004) << speed << " between " << i - 1 << " and " << i;  // of 0.02 m: 0.19 of 2 radii
      EXPECT_NEAR(simulation.state().velocity(line[i - 1])[0], 0.0, 1e-9 * speed);
    }
    EXPECT_NEAR(simulation.state().velocity(line.back())[0], speed, 1e-9 * speed);
    EXPECT_EQ(simulation.statistics().impacts, 10);
  }
}

TEST(NeverTunnel, AWallThatMoves) {
  // It sweeps over a particle at rest, which it takes along.
  for (const double speed : speeds) {
    System system;
    Wall wall{.from = Vec<2>(0.0, -1.0), .to = Vec<2>(0.0, 1.0), .radius = half_thickness};
    wall.motion.displacement = [=](double t) { return Vec<2>(speed * t, 0.0); };
    wall.motion.velocity = [=](double) { return Vec<2>(speed, 0.0); };
    wall.motion.acceleration = [](double) { return Vec<2>(0.0, 0.0); };
    system.add(wall, Surface{.friction = 0.0, .normal_restitution = 0.0});
    system.add(Particle{.mass = 1.0, .position = {0.0123, 0.2}});
    Simulation simulation(system, safe);
    for (int i = 0; i < 10; ++i) {
      simulation.step();
      const double ahead = simulation.state().q[0] - speed * simulation.time();
      EXPECT_GT(ahead, 0.5 * half_thickness) << speed;
    }
    EXPECT_NEAR(simulation.state().v[0], speed, 1e-12 * speed);
  }
}

TEST(NeverTunnel, ABarThatTurns) {
  // A bar of 2 mm, 1 m long, turns by more than a whole turn in a step; a disc of 4 mm stands in its way.
  for (const double spin : {1e2, 1e3, 1e4}) {
    System system;
    system.set_default_law({.friction = 0.0, .normal_restitution = 0.0});
    const BodyId bar = system.add(RigidBody{.mass = rod(10.0, 1.0), .spin = spin}, "bar");
    system.add(Segment{.body = bar, .from = {-0.5, 0.0}, .to = {0.5, 0.0}, .radius = 1e-3});
    const BodyId stone = add_disc(system, 2e-3, {0.0, 0.4});
    Simulation simulation(system, safe);
    while (simulation.time() < 2.0 / spin + h) simulation.step();
    EXPECT_EQ(simulation.statistics().impacts > 0, true) << spin;
    EXPECT_LT(simulation.state().velocity(stone)[0], -0.1 * spin) << spin;
    EXPECT_TRUE(ledger_closes(simulation.energy()));
  }
}

TEST(NeverTunnel, ShapesInABoxOfThinWalls) {
  // Discs, capsules, bricks and triangles fly about in a box of 1 m whose walls are 2 mm thick.
  std::int64_t impacts = 0;
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    SCOPED_TRACE(seed);
    carom_test::Random random(seed);
    System system;
    system.set_default_law({.friction = random.uniform(0.0, 0.5), .normal_restitution = 0.6});
    const std::vector<Vec<2>> corners{{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}};
    for (std::size_t i = 0; i < 4; ++i) {
      system.add(Wall{.from = corners[i], .to = corners[(i + 1) % 4], .radius = 1e-3});
    }
    const double speed = std::pow(10.0, random.uniform(1.0, 4.0));
    for (int i = 0; i < 4; ++i) {
      const BodyId body = system.add(RigidBody{.mass = box(random.uniform(0.5, 2.0), 0.1, 0.06),
                                               .position = {0.4 * (i % 2) - 0.2, 0.4 * (i / 2) - 0.2},
                                               .angle = random.uniform(-3.0, 3.0),
                                               .velocity = random.vec<2>(speed),
                                               .spin = random.uniform(-speed, speed)});
      if (i == 0) system.add(Disc{.body = body, .radius = 0.05});
      if (i == 1) system.add(Segment{.body = body, .from = {-0.05, 0.0}, .to = {0.05, 0.0}, .radius = 0.01});
      if (i == 2) {
        system.add(
            Polygon{.body = body, .vertices = {{-0.05, -0.03}, {0.05, -0.03}, {0.05, 0.03}, {-0.05, 0.03}}});
      }
      if (i == 3) system.add(Polygon{.body = body, .vertices = {{-0.04, -0.03}, {0.05, 0.0}, {-0.04, 0.03}}});
    }
    Simulation simulation(system, safe);
    for (int i = 0; i < 30; ++i) {
      ASSERT_NO_THROW(simulation.step());
      for (const BodyId body : simulation.system().bodies()) {
        EXPECT_LT(simulation.state().position(body).lpNorm<Eigen::Infinity>(), 0.5);
      }
    }
    impacts += simulation.statistics().impacts;
    EXPECT_TRUE(ledger_closes(simulation.energy()));
  }
  EXPECT_GT(impacts, 1000);  // else hardly anything was tried
}

// Discs that lie on each other, and one that flies to and fro between walls in a step: no part of it
// allocates.
TEST(NeverTunnel, TakesNoMemoryOnceItWasSeen) {
  for (const double speed : {1.0, 5e3}) {
    System system;
    system.set_default_law({.friction = 0.1, .normal_restitution = 1.0, .tangential_restitution = 1.0});
    system.add(Gravity{{0.0, -9.81}});
    for (const double y : {-0.5, 0.5}) {
      system.add(Wall{.from = {-1.0, y}, .to = {1.0, y}, .radius = 1e-3});
    }
    const int discs = speed > 1.0 ? 1 : 4;
    for (int i = 0; i < discs; ++i) add_disc(system, 0.05, {0.2 * i - 0.3, -0.2}, {0.0, speed});
    Simulation simulation(system, safe);
    simulation.run_until(2.0);
    const std::int64_t before = carom_test::allocations();
    int made = 0;
    for (int i = 0; i < 200; ++i) made += simulation.step().steps_made;
    EXPECT_EQ(carom_test::allocations() - before, 0) << speed;
    EXPECT_EQ(made > 400, speed > 1.0) << speed;  // phases
  }
}

TEST(NeverTunnel, ChangesNothingWhereNothingIsFast) {
  // Beside that impacts are resolved at the start of steps, as EnergyGain::limit has them.
  System system;
  system.add(Gravity{{0.0, -9.81}});
  system.set_default_law({.friction = 0.3, .normal_restitution = 0.4});
  system.add(planar::Block{.vertices = {{-2.0, -1.0}, {2.0, -1.0}, {2.0, 0.0}, {-2.0, 0.0}}});
  add_disc(system, 0.2, {0.0, 0.5}, {1.0, 0.0});
  add_disc(system, 0.2, {0.1, 1.1});
  Simulation with(system, safe),
      without(system, TimeStepping{.step = h, .impact_rules = {.energy_gain = EnergyGain::limit}});
  with.run_until(1.0);
  without.run_until(1.0);
  EXPECT_EQ(with.state().q, without.state().q);
  EXPECT_EQ(with.statistics().steps, 1000);
}

TEST(NeverTunnel, TurningDoesNotBringADiscNearer) {
  // A step looks again after each way that could end it: by the speed of its rim, 1e10 m in a step, this disc
  // would be looked at 1e10 times.
  System system;
  system.set_default_law(Surface{.friction = 0.0, .normal_restitution = 1.0});
  const BodyId top = system.add(RigidBody{.mass = disc(1.0, 0.1), .spin = 1e14}, "top");
  system.add(Disc{.body = top, .radius = 0.1});
  const BodyId other =
      system.add(RigidBody{.mass = disc(1.0, 0.1), .position = {0.3, 0.0}, .velocity = {-1e3, 0.0}});
  system.add(Disc{.body = other, .radius = 0.1});
  Simulation simulation(system, TimeStepping{.step = 1e-3, .overlaps = {.never_tunnel = true}});
  simulation.step();
  // Central, without friction, of equal masses: velocities are exchanged.
  EXPECT_NEAR(simulation.state().velocity(top)[0], -1e3, 1e-9);
  EXPECT_NEAR(simulation.state().velocity(other)[0], 0.0, 1e-9);
}

/// A disc that stands in a wall is moved out of it at the end of a step, into the next one: that way does not
/// grow shorter with the step, and is no passage. (The step was parted without end.)
TEST(NeverTunnel, WhatIsMovedOutPassesThroughNothing) {
  System system;
  system.set_default_law({.friction = 0.3, .normal_restitution = 0.3});
  system.add(HalfPlane{.normal = {-1.0, 0.0}}, "wall");
  const double radius = 0.1, depth = 0.09, room = 1e-3;
  const BodyId disc_id = add_disc(system, radius, {depth - radius, 0.0});
  const BodyId next = add_disc(system, radius, {depth - 3.0 * radius - room, 0.0});
  TimeStepping options = safe;
  options.project_gaps = true;
  Simulation simulation(system, options);
  simulation.step();
  simulation.step();  // they touch now, and come apart
  // Rounding of places, on the closed side.
  EXPECT_NEAR(simulation.state().position(disc_id)[0], -radius, 1e-14);
  EXPECT_NEAR(simulation.state().position(next)[0], -3.0 * radius, 1e-14);
  EXPECT_TRUE(ledger_closes(simulation.energy()));
}

/// Discs that fly about within 1 m around the origin, in a box or in a circle.
System fast_discs(bool in_box, int count, double speed, double restitution) {
  System system;
  system.set_default_law(Surface{.friction = 0.3, .normal_restitution = restitution});
  if (in_box) system.add(BoxInside{.lower = {-1.0, -1.0}, .upper = {1.0, 1.0}});
  if (!in_box) system.add(CircleInside{.radius = 1.0});
  for (int i = 0; i < count; ++i) {
    const double angle = 0.8 + 2.3 * i;
    add_disc(system, 0.1, Vec<2>(-0.4 + 0.4 * (i % 3), -0.4 + 0.4 * (i / 3)),
             speed * Vec<2>(std::cos(angle), std::sin(angle)));
  }
  return system;
}

/// How deep the deepest disc of fast_discs() is in the ground.
double depth_in_ground(const Simulation& simulation, bool in_box) {
  constexpr double free = 0.9;
  double deepest = 0.0;
  for (std::size_t i = 0; i < simulation.state().q.size(); i += 3) {
    const Vec<2> at(simulation.state().q[i], simulation.state().q[i + 1]);
    deepest = std::max(deepest, (in_box ? at.cwiseAbs().maxCoeff() : at.norm()) - free);
  }
  return deepest;
}

// Ground without a far side cannot be passed, and was not looked at: discs ended steps metres outside.
TEST(NeverTunnel, FastDiscsEndNoStepFarOutsideABoxOrACircle) {
  // An eighth and a half of the radius, or of two that push each other, one after the other.
  constexpr double most = 2.0 * 0.19 * 0.1;
  for (const bool in_box : {true, false}) {
    for (const int count : {1, 3, 9}) {
      for (const double speed : {3e2, 3e3, 3e4}) {
        for (const double e : {0.5, 1.0}) {
          // A disc that slides fast along the inside of a circle sinks into it in each part: there it is
          // moved out.
          TimeStepping options = safe;
          options.project_gaps = !in_box;
          Simulation simulation(fast_discs(in_box, count, speed, e), options);
          double deepest = 0.0;
          for (int step = 0; step < 20; ++step) {
            simulation.step();
            deepest = std::max(deepest, depth_in_ground(simulation, in_box));
          }
          EXPECT_LT(deepest, most) << in_box << ", " << count << " discs at " << speed << " m/s, e = " << e;
        }
      }
    }
  }
}

TEST(NeverTunnel, AStepWithoutEndIsRefusedByName) {
  // 1 mm between two walls at 1e8 m/s: 1e8 bounces a step.
  System system = bullet_before_wall(1e8, 1.0);
  system.add(Wall{.from = Vec<2>(-0.002, -1.0), .to = Vec<2>(-0.002, 1.0), .radius = half_thickness},
             Surface{.friction = 0.0, .normal_restitution = 1.0}, "other wall");
  Simulation simulation(system, safe);
  const State before = simulation.state();
  EXPECT_THROWS(SolverError, simulation.step(), "never_tunnel", "'bullet'");
  EXPECT_EQ(simulation.state().q, before.q);
  EXPECT_EQ(simulation.time(), 0.0);
}

TEST(NeverTunnel, ExcludesStepControlAndLocatedImpacts) {
  TimeStepping controlled = safe, located = safe;
  controlled.control = StepControl{};
  located.impacts = ImpactTimes::located;
  const System system = bullet_before_wall(1.0, 0.0);
  EXPECT_MODEL_ERROR(Simulation(system, controlled), "never_tunnel", "control");
  EXPECT_MODEL_ERROR(Simulation(system, located), "never_tunnel", "located");
}

}  // namespace
