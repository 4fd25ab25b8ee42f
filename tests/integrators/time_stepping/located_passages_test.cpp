// Located impacts with steps that are long against what happens in them: nothing passes through anything, and
// what is cut is counted.

#include "tests/energy/ledger_check.h"
#include "tests/integrators/time_stepping/located_runs.h"
#include "tests/random.h"
#include "tests/shares.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::ledger_closes;
using carom_test::located;

constexpr double radius = 0.1;

enum class Form { ball, block };

BodyId add_body(System& system, Form form, double mass, double place, double speed) {
  const BodyId body =
      system.add(RigidBody{.mass = disc(mass, radius), .position = {place, 0.0}, .velocity = {speed, 0.0}});
  if (form == Form::ball) {
    system.add(Disc{.body = body, .radius = radius});
  } else {
    system.add(
        Polygon{.body = body,
                .vertices = {{-radius, -radius}, {radius, -radius}, {radius, radius}, {-radius, radius}}});
  }
  return body;
}

/// A light body between a wall at x = 0 and a heavy one that comes along a line.
struct LineOfTwo {
  System system;
  BodyId light, heavy;

  LineOfTwo(Form form, double mass, double restitution, double light_at, double heavy_at, double speed) {
    system.set_default_law({.friction = 0.0, .normal_restitution = restitution});
    system.add(HalfPlane{.normal = {1.0, 0.0}});
    light = add_body(system, form, 1.0, light_at, 0.0);
    heavy = add_body(system, form, mass, heavy_at, -speed);
  }
};

// The digits of pi: the bodies meet, or the light one the wall, floor(pi/atan(sqrt(1/M))) times.
TEST(LocatedPassages, TwoBodiesAndAWallCountTheDigitsOfPi) {
  for (const Form form : {Form::ball, Form::block}) {
    for (const double mass : {1.0, 16.0, 100.0}) {
      for (const double step : {0.1, 0.01}) {  // with no more than ten meetings of one pair
        const LineOfTwo scene(form, mass, 1.0, 1.0, 2.0, 1.0);
        Simulation simulation(scene.system, located(step));
        const double energy = simulation.energy().total();
        while (simulation.time() < 4.0) {
          simulation.step();
          const double light = simulation.state().position(scene.light)[0],
                       heavy = simulation.state().position(scene.heavy)[0];
          ASSERT_GT(light, radius - 1e-11) << mass << ", step " << step;
          ASSERT_GT(heavy - light, 2.0 * radius - 1e-11) << mass << ", step " << step;
        }
        const double angle = std::atan(std::sqrt(1.0 / mass));
        const auto meetings = static_cast<std::int64_t>(std::ceil(std::acos(-1.0) / angle - 1e-9)) - 1;
        // Blocks meet at two corners.
        const std::int64_t contacts = form == Form::block ? 2 : 1;
        EXPECT_EQ(simulation.statistics().impacts, contacts * meetings) << mass << ", step " << step;
        EXPECT_EQ(simulation.statistics().cut_sequences, 0) << mass << ", step " << step;
        EXPECT_NEAR(simulation.energy().total(), energy, 1e-12 * energy);
      }
    }
  }
}

/// Any masses, speeds and steps: nothing passes, and with e = 1 energy is kept or a cut is told. Where
/// closings are not located any more, which is told too, bodies come into each other by what passages allow.
void expect_order(std::uint64_t seed) {
  carom_test::Random random(seed);
  const double mass = std::pow(10.0, random.uniform(0.0, 5.0)),
               step = std::pow(10.0, random.uniform(-3.0, 0.0));
  const double restitution = random.below(2) == 0 ? 1.0 : random.uniform(0.0, 1.0);
  const double speed = random.uniform(0.5, 3.0);
  const double light_at = random.uniform(0.15, 2.0);
  const LineOfTwo scene(random.below(2) == 0 ? Form::ball : Form::block, mass, restitution, light_at,
                        light_at + random.uniform(0.25, 1.0), speed);
  Simulation simulation(scene.system, located(step));
  const double energy = simulation.energy().total();
  while (simulation.time() < 3.0) {
    simulation.step();
    const double light = simulation.state().position(scene.light)[0],
                 heavy = simulation.state().position(scene.heavy)[0];
    const double deep = simulation.statistics().cut_sequences == 0 ? 1e-9 : 0.2 * radius;
    ASSERT_GT(light, radius - deep) << "seed " << seed;
    ASSERT_GT(heavy - light, 2.0 * radius - 2.0 * deep) << "seed " << seed;
  }
  EXPECT_TRUE(ledger_closes(simulation.energy())) << "seed " << seed;
  if (restitution < 1.0) return;
  const bool lost = simulation.energy().total() < energy * (1.0 - 1e-9);
  EXPECT_LE(simulation.energy().total(), energy * (1.0 + 1e-9)) << "seed " << seed;
  EXPECT_TRUE(!lost || simulation.statistics().cut_sequences > 0) << "seed " << seed;
}

TEST(LocatedPassages, BodiesOnALineKeepTheirOrder) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) expect_order(seed);
}

TEST(LocatedPassagesLong, BodiesOnALineKeepTheirOrder) {
  const carom_test::SeedRange range = carom_test::seeds_from(1000, 300, 3000);
  for (std::uint64_t seed = range.first; seed < range.last; ++seed) expect_order(seed);
}

/// A load strikes a light cart, which flies to and fro between it and a stop. The cart is never farther past
/// the stop than a slow contact may dip in a step, nor the load in the cart, and the load rebounds as if the
/// cart lay on the stop where bounces of the cart accumulate.
void expect_stop_holds(std::uint64_t seed) {
  carom_test::Random random(seed);
  const double mass = std::pow(200.0, random.uniform(0.0, 1.0)), speed = random.uniform(1.0, 15.0),
               restitution = random.uniform(0.0, 1.0), step = random.below(2) == 0 ? 5e-4 : 5e-3, limit = 0.3;
  System system;
  if (random.below(3) == 0) system.add(Gravity{{9.81, 0.0}});
  system.set_default_law({.friction = 0.0, .normal_restitution = restitution});
  const BodyId cart = system.add(RigidBody{.mass = box(mass, 0.2, 2.0)});
  system.add(Polygon{.body = cart, .vertices = {{-0.1, -1.0}, {0.1, -1.0}, {0.1, 1.0}, {-0.1, 1.0}}});
  const JointId rail = system.add(Prismatic{.from = ground, .to = cart, .axis = {1.0, 0.0}});
  system.add(Stop{.joint = rail, .lower = -limit, .upper = limit, .restitution = restitution});
  const BodyId load =
      system.add(RigidBody{.mass = disc(2000.0, 0.3), .position = {-0.6, 0.0}, .velocity = {speed, 0.0}});
  system.add(Disc{.body = load, .radius = 0.3});
  const TimeStepping mode = located(step);
  Simulation simulation(system, mode);
  const double dip = 2.0 * mode.capture_speed * step;
  while (simulation.time() < 0.5) {
    simulation.step();
    const double place = simulation.state().coordinate(rail);
    ASSERT_LT(std::abs(place) - limit, dip) << "seed " << seed << " at " << simulation.time();
    ASSERT_GT(place - simulation.state().position(load)[0] - 0.4, -dip) << "seed " << seed;
  }
  EXPECT_TRUE(ledger_closes(simulation.energy())) << "seed " << seed;
}

TEST(LocatedPassages, ACartBetweenALoadAndItsStopStaysThere) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) expect_stop_holds(seed);
}

TEST(LocatedPassagesLong, ACartBetweenALoadAndItsStopStaysThere) {
  const carom_test::SeedRange range = carom_test::seeds_from(1000, 200, 2000);
  for (std::uint64_t seed = range.first; seed < range.last; ++seed) expect_stop_holds(seed);
}

// Half of a thing that is thin against the way of a step: what hits it stays on its side.
TEST(LocatedPassages, ThinGroundIsNotPassed) {
  constexpr double step = 0.1, half = 5e-3, wall_at = 0.37;
  for (const double speed : {1.0, 5.0, 50.0, 500.0}) {
    for (int form = 0; form < 3; ++form) {
      System system;
      system.set_default_law({.friction = 0.0, .normal_restitution = 1.0});
      system.add(Wall{.from = Vec<2>(wall_at, -1.0), .to = Vec<2>(wall_at, 1.0), .radius = half});
      double reach = 0.0;
      BodyId body;
      if (form == 0) {
        body = system.add(Particle{.mass = 1.0, .velocity = {speed, 0.0}});
      } else {
        body = add_body(system, form == 1 ? Form::ball : Form::block, 1.0, 0.0, speed);
        reach = radius;
      }
      Simulation simulation(system, located(step));
      simulation.run_until(1.0);
      const double turn = (wall_at - half - reach) / speed;
      const double expected = 1.0 < turn ? speed : wall_at - half - reach - speed * (1.0 - turn);
      EXPECT_NEAR(simulation.state().position(body)[0], expected, 1e-9 * speed) << speed << ", " << form;
      // The block is hit at two corners.
      EXPECT_EQ(simulation.statistics().impacts, form == 2 ? 2 : 1) << speed << ", " << form;
    }
  }
}

// A disc that bounces off the floor within the step hits another one behind that, which the straight line
// between the ends of the step does not touch.
TEST(LocatedPassages, WaysThatHaveCornersAreFollowed) {
  constexpr double step = 0.5, small = 0.05;
  System system;
  system.set_default_law({.friction = 0.0, .normal_restitution = 1.0});
  system.add(HalfPlane{.normal = {0.0, 1.0}});
  const auto add_disc = [&](const Vec<2>& place, const Vec<2>& velocity) {
    const BodyId body =
        system.add(RigidBody{.mass = disc(1.0, small), .position = place, .velocity = velocity});
    system.add(Disc{.body = body, .radius = small});
    return body;
  };
  const BodyId moving = add_disc({0.0, 1.0 + small}, {4.0, -4.0});
  // The disc comes from the floor at (1, small) and goes up at 45 degrees.
  const BodyId waits = add_disc({1.6, 0.6 + small}, {0.0, 0.0});
  Simulation simulation(system, located(step));
  simulation.step();
  EXPECT_EQ(simulation.statistics().impacts, 2);
  // Head on: it hands on all of its velocity.
  EXPECT_NEAR(simulation.state().velocity(moving).norm(), 0.0, 1e-9);
  EXPECT_NEAR((simulation.state().velocity(waits) - Vec<2>(4.0, 4.0)).norm(), 0.0, 1e-9);
}

/// Discs and boxes in a box with thin walls inside, as fast as to fly through several of these in a step.
void expect_inside(std::uint64_t seed) {
  carom_test::Random random(seed);
  const double step = std::pow(10.0, random.uniform(-2.5, -0.7));
  System system;
  system.set_default_law({.friction = random.below(2) == 0 ? 0.0 : 0.3,
                          .normal_restitution = random.below(2) == 0 ? 1.0 : random.uniform(0.0, 1.0)});
  system.add(BoxInside{.lower = {-2.0, -1.0}, .upper = {2.0, 1.0}});
  for (const double at : {-1.0, 0.0, 1.0})
    system.add(Wall{.from = Vec<2>(at, -1.0), .to = Vec<2>(at, 1.0), .radius = 0.02});
  std::vector<BodyId> bodies;
  const unsigned each = 1 + random.below(2);
  for (int cell = 0; cell < 4; ++cell) {
    for (unsigned k = 0; k < each; ++k) {
      const Vec<2> place(-1.5 + cell, each == 1 ? 0.0 : -0.4 + 0.8 * k);
      const BodyId body = system.add(RigidBody{.mass = disc(random.uniform(0.1, 10.0), radius),
                                               .position = place,
                                               .angle = random.uniform(0.0, 1.0),
                                               .velocity = random.vec<2>(10.0),
                                               .spin = random.uniform(-5.0, 5.0)});
      if (random.below(2) == 0) {
        system.add(Disc{.body = body, .radius = radius});
      } else {
        system.add(Polygon{
            .body = body,
            .vertices = {{-radius, -radius}, {radius, -radius}, {radius, radius}, {-radius, radius}}});
      }
      bodies.push_back(body);
    }
  }
  Simulation simulation(system, located(step));
  for (int i = 0; i < 20; ++i) {
    simulation.step();
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      const double cell = -1.5 + static_cast<double>(b / each);
      ASSERT_LT(std::abs(simulation.state().position(bodies[b])[0] - cell), 0.5) << "seed " << seed;
      ASSERT_LT(std::abs(simulation.state().position(bodies[b])[1]), 1.0) << "seed " << seed;
    }
  }
  EXPECT_TRUE(ledger_closes(simulation.energy())) << "seed " << seed;
}

TEST(LocatedPassages, NothingLeavesItsCell) {
  for (std::uint64_t seed = 0; seed < 12; ++seed) expect_inside(seed);
}

TEST(LocatedPassagesLong, NothingLeavesItsCell) {
  const carom_test::SeedRange range = carom_test::seeds_from(1000, 100, 1000);
  for (std::uint64_t seed = range.first; seed < range.last; ++seed) expect_inside(seed);
}

}  // namespace
