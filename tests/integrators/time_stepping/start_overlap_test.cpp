// Bodies that overlap at the start: named with their depth, or moved apart by the least displacement.

#include "tests/model_error.h"
#include "tests/random.h"

#include <carom/carom.h>
#include <carom/contact/detection/detector.h>
#include <carom/core/constraint_set.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;

/// Rounding of coordinates of a few metres.
constexpr double rounding = 1e-13;

BodyId add_disc(System& system, double mass, const Vec<2>& place, const char* name) {
  const BodyId body = system.add(RigidBody{.mass = disc(mass, 0.5), .position = place}, name);
  system.add(Disc{.body = body, .radius = 0.5});
  return body;
}

/// Two discs, 0.2 m into each other.
struct Pair {
  Pair() {
    system.set_default_law({.friction = 0.0, .normal_restitution = 0.0});
    light = add_disc(system, 1.0, {0.0, 0.0}, "light");
    heavy = add_disc(system, 3.0, {0.8, 0.0}, "heavy");
  }
  System system;
  BodyId light, heavy;
};

/// The most negative gap of a state.
double deepest(const Simulation& simulation) {
  const Assembly& assembly = simulation.assembly();
  const StateView state = simulation.state().view();
  Evaluation evaluation = make_evaluation(assembly);
  evaluate_positions(assembly, state, evaluation);
  const Detector detector(assembly);
  GroundPlaces places;
  detector.place(state.time, places);
  ConstraintSet contacts;
  BodyContactSearch search;
  const ContactQuery query{state, evaluation, places};
  detector.find({0, static_cast<Index>(assembly.components().size())}, query, contacts);
  if (detector.bodies_touch()) detector.find_between_bodies(query, search, contacts);
  double depth = 0.0;
  for (const Constraint& contact : contacts) depth = std::min(depth, contact.gap);
  return depth;
}

TEST(StartOverlap, IsAllowedUnlessALimitIsGiven) {
  EXPECT_NO_THROW(Simulation(Pair().system, TimeStepping{}));
  EXPECT_NO_THROW(Simulation(Pair().system, TimeStepping{.overlaps = {.largest_at_start = 0.21}}));
  EXPECT_MODEL_ERROR(Simulation(Pair().system, TimeStepping{.overlaps = {.largest_at_start = 0.19}}),
                     "'light'", "'heavy'");
  EXPECT_MODEL_ERROR(Simulation(Pair().system, TimeStepping{.overlaps = {.largest_at_start = 0.19}}),
                     "gap of", "-0.1999");
  EXPECT_MODEL_ERROR(Simulation(Pair().system, TimeStepping{.overlaps = {.largest_at_start = -1.0}}),
                     "largest_at_start", "-1");
}

TEST(StartOverlap, IsLookedAtWhereverAStateIsGiven) {
  Pair pair;
  Simulation simulation(pair.system, TimeStepping{.overlaps = {.separate_at_start = true}});
  State state = simulation.state();
  simulation.switch_to(TimeStepping{.overlaps = {.largest_at_start = 1e-3}});
  state.q[0] += 0.01;
  EXPECT_MODEL_ERROR(simulation.set_state(state), "'light'", "-0.01");
}

TEST(StartOverlap, OfGroundIsNamedToo) {
  System system;
  system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = 0.0, .normal_restitution = 0.0}, "floor");
  add_disc(system, 1.0, {0.0, 0.3}, "ball");
  EXPECT_MODEL_ERROR(Simulation(system, TimeStepping{.overlaps = {.largest_at_start = 0.0}}), "'ball'",
                     "'floor'");
  EXPECT_NEAR(deepest(Simulation(system, TimeStepping{.overlaps = {.separate_at_start = true}})), 0.0,
              rounding);
}

TEST(StartOverlap, ApartByTheInverseOfTheMasses) {
  Pair pair;
  Simulation simulation(pair.system, TimeStepping{.overlaps = {.separate_at_start = true}});
  // 0.2 m shared 3 to 1, the centre of mass stays.
  EXPECT_NEAR(simulation.state().position(pair.light)[0], -0.15, rounding);
  EXPECT_NEAR(simulation.state().position(pair.heavy)[0], 0.85, rounding);
  EXPECT_NEAR(simulation.report().projected, 0.15, rounding);
  EXPECT_NEAR(deepest(simulation), 0.0, rounding);
}

TEST(StartOverlap, OfAHeapIsGone) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    carom_test::Random random(seed);
    System system;
    system.set_default_law({.friction = 0.2, .normal_restitution = 0.0});
    system.add(HalfPlane{.normal = {0.0, 1.0}});
    for (int i = 0; i < 8; ++i) {
      const BodyId body = system.add(RigidBody{.mass = box(random.uniform(0.5, 2.0), 0.4, 0.3),
                                               .position = {0.3 * (i % 4), 0.2 + 0.25 * (i / 4)},
                                               .angle = random.uniform(-3.0, 3.0)});
      system.add(Polygon{.body = body, .vertices = {{-0.2, -0.15}, {0.2, -0.15}, {0.2, 0.15}, {-0.2, 0.15}}});
    }
    EXPECT_LT(deepest(Simulation(system, TimeStepping{})), -0.01) << seed;
    EXPECT_GE(deepest(Simulation(system, TimeStepping{.overlaps = {.separate_at_start = true}})), -rounding)
        << seed;
  }
}

TEST(StartOverlap, JointsHold) {
  System system;
  system.set_default_law({.friction = 0.0, .normal_restitution = 0.0});
  const BodyId free = add_disc(system, 1.0, {0.9, 0.0}, "free");
  const BodyId arm = add_disc(system, 1.0, {0.0, 0.1}, "arm");
  system.add(Revolute{.from = {ground, {-2.0, 0.1}}, .to = {arm, {-2.0, 0.0}}});
  Simulation simulation(system, TimeStepping{.overlaps = {.separate_at_start = true}});
  const State& state = simulation.state();
  EXPECT_GE((state.position(free) - state.position(arm)).norm(), 1.0 - rounding);
  EXPECT_NEAR((state.position(arm) - Vec<2>(-2.0, 0.1)).norm(), 2.0, 1e-12);
}

TEST(StartOverlap, WithoutRoomIsRefusedByName) {
  System system;
  const Surface smooth{.friction = 0.0, .normal_restitution = 0.0};
  system.add(HalfPlane{.normal = {0.0, 1.0}}, smooth, "floor");
  system.add(HalfPlane{.point = {0.0, 0.8}, .normal = {0.0, -1.0}}, smooth, "ceiling");
  add_disc(system, 1.0, {0.0, 0.5}, "ball");
  EXPECT_MODEL_ERROR(Simulation(system, TimeStepping{.overlaps = {.separate_at_start = true}}),
                     "separate_at_start", "'ball'");
}

// A flat outline of many corners, out of a box: its turning makes the least displacement known by a part of
// what is left from pass to pass, with another corner each time. (7 of 300 such starts were refused.)
TEST(StartOverlap, OfManyCornersIsGone) {
  carom_test::Random random(3);
  std::vector<Vec<2>> corners;
  constexpr int count = 200;
  for (int i = 0; i < count; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / count;
    corners.emplace_back(0.1 * std::cos(angle), 0.03 * std::sin(angle));
  }
  for (int repeat = 0; repeat < 300; ++repeat) {
    System system;
    system.add(BoxInside{.lower = {0.0, 0.0}, .upper = {1.0, 1.0}},
               Surface{.friction = 0.3, .normal_restitution = 0.3});
    const Vec<2> place(random.uniform(0.0, 1.0), random.uniform(0.0, 1.0));
    const BodyId body =
        system.add(RigidBody{.mass = disc(1.0, 0.08), .position = place, .angle = random.uniform(-3.0, 3.0)});
    system.add(Polygon{.body = body, .vertices = corners});
    const Simulation simulation(std::move(system), TimeStepping{.overlaps = {.separate_at_start = true}});
    EXPECT_GE(deepest(simulation), -rounding) << repeat;
  }
}

TEST(StartOverlap, StepsThatProjectKeepBodiesApart) {
  // Discs fall on each other: with project_gaps what took part ends a step at a gap of rounding.
  System system;
  system.add(Gravity{{0.0, -9.81}});
  system.set_default_law({.friction = 0.3, .normal_restitution = 0.0});
  system.add(HalfPlane{.normal = {0.0, 1.0}});
  add_disc(system, 1.0, {0.0, 0.6}, "lower");
  add_disc(system, 2.0, {0.3, 1.8}, "upper");
  for (const bool project : {false, true}) {
    Simulation simulation(system, TimeStepping{.step = 1e-3, .project_gaps = project});
    simulation.run_until(0.35);
    double worst = 0.0;
    int steps = 0;
    while (simulation.time() < 0.5) {
      simulation.step();
      ++steps;
      if (simulation.report().contacts.size() > 1) worst = std::min(worst, deepest(simulation));
    }
    EXPECT_TRUE(project ? worst >= -rounding : worst < -1e-5) << worst;
  }
}

}  // namespace
