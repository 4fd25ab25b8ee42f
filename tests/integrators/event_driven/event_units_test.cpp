// The same scene in other units: numbers in millimetres and grams, bodies of a micrometre or of ten
// kilometres, and a second of a microsecond. Nothing in the event-driven mode is a number of metres or
// seconds but its options, so that the numbers are the same ones scaled.

#include "tests/integrators/event_driven/body_scenes.h"
#include "tests/integrators/units.h"
#include "tests/round_hill.h"
#include "tests/shares.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <random>
#include <vector>

namespace {

using namespace body_scenes;
using carom_test::Units;

Gravity gravity_in(const Units& units) { return Gravity{{0.0, -g * units.acceleration()}}; }

BodyId add_disc(const Units& units, System& system, double m, double radius, const Vec<2>& place,
                const Vec<2>& velocity, double spin) {
  return body_scenes::add_disc(system, m * units.mass, radius * units.length, place * units.length,
                               velocity * units.speed(), spin / units.time);
}

using Scene = std::function<System(const Units&)>;

std::vector<double> end_of(const Scene& scene, const Units& units, double time = 1.5) {
  return carom_test::end_in(units, scene(units), carom_test::event_options_in(units), time);
}

void expect_same(const Scene& scene, double tolerance) {
  const std::vector<double> usual = end_of(scene, {1.0, 1.0, 1.0});
  constexpr Units others[] = {{1e3, 1e3, 1.0},    {1e-3, 1e-3, 1.0},   {0x1p-20, 1.0, 1.0},
                              {1e-6, 1e-12, 1.0}, {1e-6, 1e-12, 1e-3}, {1e-6, 1e-12, 1e-6},
                              {1e4, 1e9, 1e2},    {1.0, 1.0, 1e-6}};
  for (const Units& units : others) {
    const std::vector<double> end = end_of(scene, units);
    ASSERT_EQ(end.size(), usual.size());
    for (std::size_t i = 0; i < end.size(); ++i) {
      EXPECT_NEAR(end[i], usual[i], tolerance)
          << i << ", in " << units.length << " m, " << units.mass << " kg, " << units.time << " s";
    }
  }
}

TEST(EventUnits, ABouncingDisc) {
  const auto scene = [](const Units& units) {
    System system;
    system.add(gravity_in(units));
    system.set_default_law({.friction = 0.3, .normal_restitution = 0.7, .tangential_restitution = 0.2});
    system.add(HalfPlane{.normal = {0.0, 1.0}});
    add_disc(units, system, 1.2, 0.1, {0.0, 1.0}, {1.0, 0.0}, -4.0);
    return system;
  };
  expect_same(scene, 1e-12);  // rounding of four bounces
}

TEST(EventUnits, ATumblingBox) {
  const auto scene = [](const Units& units) {
    System system;
    system.add(gravity_in(units));
    system.set_default_law({.friction = 0.4, .normal_restitution = 0.3});
    system.add(HalfPlane{.normal = {0.0, 1.0}});
    const double width = 0.4 * units.length, height = 0.3 * units.length;
    add_box(system, 1.2 * units.mass, width, height, {0.0, units.length}, 0.3, {units.speed(), 0.0},
            -4.0 / units.time);
    return system;
  };
  expect_same(scene, 1e-10);  // rounding of impacts and the tolerance of the sliding between them
}

// Where a sign of a small gap decides which of two contacts an impact has, rounding may change the motion:
// the numbers below are those of tolerances, times what impacts make of them.
TEST(EventUnits, DiscsOnASpringBetweenPlanes) {
  const auto scene = [](const Units& units) {
    System system;
    system.add(gravity_in(units));
    system.set_default_law({.friction = 0.4, .normal_restitution = 0.5});
    system.add(HalfPlane{.normal = {0.1, 1.0}});
    system.add(HalfPlane{.point = {units.length, 0.0}, .normal = {-1.0, 0.2}});
    const BodyId lower = add_disc(units, system, 1.2, 0.1, {0.0, 0.5}, {1.0, 0.0}, -4.0);
    const BodyId upper = add_disc(units, system, 0.7, 0.15, {0.05, 1.0}, {1.0, 0.0}, 3.0);
    system.add(SpringDamper{.from = lower,
                            .to = upper,
                            .stiffness = 300.0 * units.mass / (units.time * units.time),
                            .damping = 0.5 * units.mass / units.time,
                            .free_length = 0.4 * units.length});
    return system;
  };
  expect_same(scene, 1e-7);
}

TEST(EventUnits, APendulumHitsABlock) {
  const auto scene = [](const Units& units) {
    System system;
    system.add(gravity_in(units));
    system.set_default_law({.friction = 0.3, .normal_restitution = 0.4});
    system.add(HalfPlane{.point = {0.0, -1.2 * units.length}, .normal = {0.0, 1.0}});
    const BodyId bob = add_disc(units, system, 1.2, 0.1, {-1.0, 0.0}, {0.0, 0.0}, 0.0);
    add_box(system, units.mass, 0.2 * units.length, 0.4 * units.length, {0.25 * units.length, -units.length});
    const JointId pivot = system.add(Revolute{.from = ground, .to = {bob, {units.length, 0.0}}});
    system.add(JointFriction{.joint = pivot, .bound = 0.1 * units.mass * units.speed() * units.speed()});
    return system;
  };
  expect_same(scene, 1e-8);
}

// Rates of hinges went by rad/s where speeds of contacts went by m/s: whether friction in them stops at once,
// which of two impacts is the faster, how long what is slow may take to come back.
TEST(EventUnits, AChainWithLimitsAndFrictionFallsOnDiscs) {
  const auto scene = [](const Units& units) {
    System system;
    system.add(gravity_in(units));
    system.set_default_law({.friction = 0.3, .normal_restitution = 0.4});
    system.add(HalfPlane{.normal = {0.0, 1.0}});
    add_disc(units, system, 1.2, 0.1, {0.3, 0.1}, {0.0, 0.0}, 0.0);
    add_disc(units, system, 0.6, 0.1, {0.62, 0.1}, {0.0, 0.0}, 0.0);
    const double length = 0.4 * units.length;
    Vec<2> pin(0.0, 0.5 * units.length);
    BodyId before = ground;
    for (int i = 0; i < 2; ++i) {
      const BodyId link =
          system.add(RigidBody{.mass = rod(units.mass, length), .position = pin + Vec<2>(0.5 * length, 0.0)});
      const Vec<2> end(0.5 * length, 0.0);
      system.add(Segment{.body = link, .from = -0.8 * end, .to = 0.8 * end, .radius = 0.03 * units.length});
      const JointId hinge =
          system.add(Revolute{.from = {before, before == ground ? pin : end}, .to = {link, -end}});
      system.add(Stop{.joint = hinge, .lower = -0.5, .upper = 0.6, .restitution = 0.5});
      system.add(JointFriction{.joint = hinge, .bound = 0.05 * units.mass * units.speed() * units.speed()});
      pin[0] += length;
      before = link;
    }
    return system;
  };
  expect_same(scene, 1e-6);  // some 100 impacts, each of which makes more of the tolerances
}

// The curvature of a user's ground shape is found by differences: a length that had been 1e-5 m for all of
// them.
TEST(EventUnits, ADiscSlidesDownARoundHill) {
  const auto scene = [](const Units& units) {
    System system;
    system.add(gravity_in(units));
    system.set_default_law({.friction = 0.0, .normal_restitution = 0.0});
    system.add(carom_test::RoundHill{.centre = {0.0, -units.length}, .radius = units.length});
    constexpr double from_top = 0.1, apart = 1.1;
    add_disc(units, system, 1.0, 0.1, {apart * std::sin(from_top), apart * std::cos(from_top) - 1.0},
             {0.0, 0.0}, 0.0);
    return system;
  };
  // Rounding over the differences: 2e-16 over 1e-5 m of 1e4 m. It leaves the hill.
  expect_same(scene, 1e-6);
}

// Below its depth terrain touches nothing (GroundEnds). From how deep on that was asked was a number of
// metres.
TEST(EventUnits, ADiscFallsBelowTerrain) {
  const auto scene = [](const Units& units) {
    System system;
    system.add(gravity_in(units));
    system.set_default_law({.friction = 0.3, .normal_restitution = 0.5});
    std::vector<Vec<2>> line{{-1.0, 0.0}, {0.0, 0.0}, {1.0, 0.0}};
    for (Vec<2>& place : line) place *= units.length;
    system.add(Terrain{.vertices = line, .depth = 0.3 * units.length});
    add_disc(units, system, 1.0, 0.1, {0.1, -0.6}, {0.2, 0.0}, 1.0);
    return system;
  };
  expect_same(scene, 1e-12);  // rounding of a flight
}

/// Four boxes, two of them rounded, that fall within a box.
System boxes_in_a_box(const Units& units, std::uint32_t seed, const Vec<2>& origin) {
  System system;
  system.add(gravity_in(units));
  system.set_default_law({.friction = 0.3, .normal_restitution = 0.1});
  system.add(BoxInside{.lower = origin, .upper = origin + Vec<2>(units.length, units.length)});
  std::mt19937 random(seed);
  const auto between = [&](double a, double b) {
    constexpr double numbers = 0x1p32;
    return a + (b - a) * static_cast<double>(random()) / numbers;
  };
  for (int k = 0; k < 4; ++k) {
    const double width = between(0.3, 0.38), height = between(0.2, 0.3), radius = k % 2 == 1 ? 0.0 : 0.05;
    const Vec<2> place(0.28 + 0.44 * (k % 2), 0.28 + (k < 2 ? 0.0 : 0.44));
    const double angle = between(-3.0, 3.0), u = between(-2.0, 2.0), w = between(-2.0, 2.0);
    const BodyId body =
        system.add(RigidBody{.mass = {.mass = units.mass,
                                      .inertia = units.mass * (width * width + height * height) / 12.0 *
                                                 units.length * units.length},
                             .position = origin + place * units.length,
                             .angle = angle,
                             .velocity = Vec<2>(u, w) * units.speed(),
                             .spin = between(-5.0, 5.0) / units.time});
    const double inner = width - 2.0 * radius, high = height - 2.0 * radius + 0.02;
    system.add(Polygon{.body = body,
                       .vertices = corners_of(inner * units.length, high * units.length),
                       .radius = radius * units.length});
  }
  return system;
}

// Where a corner came to a rounded end of another outline the zero of its way there is found to the rounding
// of places, and was taken to be passed where it was within 2e-14 m: at bodies of 1e5 m one event followed
// the other at one instant, until `event_limit` ended the run.
TEST(EventUnits, BoxesInABox) {
  const auto scene = [](const Units& units) { return boxes_in_a_box(units, 86, Vec<2>::Zero()); };
  // At 0.2392 s a corner approaches at 1e-9 m/s, which is a closing in some units and none in others: from
  // there on ends differ, by 1e-10 m to 1e-4 m.
  constexpr double alike_until = 0.239, end_time = 0.6;
  const std::vector<double> usual = end_of(scene, {1.0, 1.0, 1.0}, alike_until);
  for (const Units& units :
       carom_test::samples({Units{1e6, 1.0, 1e3}, Units{1e6, 1.0, 1.0}, Units{1e4, 1.0, 1.0}}, 3)) {
    const std::vector<double> then = end_of(scene, units, alike_until);
    for (std::size_t i = 0; i < then.size(); ++i) {
      EXPECT_NEAR(then[i], usual[i], 1e-7) << i << ", in " << units.length << " m, " << units.time << " s";
    }
    EXPECT_NO_THROW(static_cast<void>(end_of(scene, units, end_time)));
  }
}

// Places far from the origin are rounded, and levers of contacts with them: that moved forces by more than
// was taken for their rounding, so that one was at its end again and again at one instant.
TEST(EventUnits, BoxesFarFromTheOrigin) {
  Simulation simulation(boxes_in_a_box({1.0, 1.0, 1.0}, 28, Vec<2>(1e6, 1e6)), EventDriven{});
  EXPECT_NO_THROW(simulation.run_until(0.5));
}

// Volumes that bodies sweep were those at rest: of two that fly side by side each was good for as long as it
// takes to go through the space between them, so that a flight of 300 km took minutes.
TEST(EventUnits, WhatFliesTogetherCostsNoMoreTheFasterItIs) {
  for (const double speed : {0.0, 1e7}) {
    System system;
    system.set_default_law({.friction = 0.3, .normal_restitution = 0.5});
    for (const double x : {0.0, 0.3}) {
      add_box(system, 1.0, 0.2, 0.1, {x, 0.0}, 0.0, {speed + 0.5 * x, 0.0}, 5.0);
    }
    Simulation simulation(system, EventDriven{});
    simulation.run_until(0.03);
    // Places are known to 4e-11 m there.
    const State& end = simulation.state();
    EXPECT_NEAR(end.q[3] - end.q[0], 0.3 + 0.15 * 0.03, 1e-8) << speed;
    EXPECT_DOUBLE_EQ(end.v[2], 5.0) << speed;
  }
}

// Flights of up to 1 s are a thousand of these units: the bound of what a corner may do within one of them
// said nothing, so that some 10,000 looks were taken at each corner in each step.
TEST(EventUnits, ShortFlightsAreSearchedWithFewLooks) {
  for (const Units& units : {Units{1.0, 1.0, 1.0}, Units{1e-6, 1.0, 1e-3}, Units{1.0, 1.0, 1e-6}}) {
    System system;
    system.add(gravity_in(units));
    system.set_default_law({.friction = 0.3, .normal_restitution = 0.5});
    system.add(BoxInside{.lower = {0.0, 0.0}, .upper = {units.length, units.length}});
    system.add(Peg{.centre = {0.4 * units.length, 0.3 * units.length}, .radius = 0.05 * units.length});
    add_box(system, units.mass, 0.2 * units.length, 0.1 * units.length,
            {0.5 * units.length, 0.7 * units.length}, 0.3, {units.speed(), 0.0}, 5.0 / units.time);
    EventDriven options = carom_test::event_options_in(units);
    options.evaluation_limit = 10000;  // of one step or event; 40 corners and walls at 200 looks
    Simulation simulation(system, options);
    EXPECT_NO_THROW(simulation.run_until(2.0 * units.time)) << units.length << " m, " << units.time << " s";
  }
}

}  // namespace
