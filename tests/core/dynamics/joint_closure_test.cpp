// Joints at the start of a run: positions and velocities closed by the smallest changes, what cannot be
// closed, degrees of freedom.

#include "tests/model_error.h"

#include <carom/carom.h>
#include <carom/core/assembly.h>

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;

constexpr double quarter = 0.5 * std::numbers::pi;

struct Closed {
  State state;
  JointClosure closure;
};
Closed closed(const System& system) {
  const Assembly assembly(system);
  Closed result{assembly.initial_state(), {}};
  result.closure = close_joints(assembly, result.state);
  return result;
}

Mobility mobility_of(const System& system) {
  const Assembly assembly(system);
  return mobility(assembly, closed(system).state);
}

/// Three uprights of 1 m under one beam, 1 m apart: one too many.
struct Bridge {
  System system;
  std::vector<BodyId> posts;
  BodyId beam;
};
Bridge bridge() {
  Bridge model;
  for (int i = 0; i < 3; ++i) {
    model.posts.push_back(
        model.system.add(RigidBody{.mass = rod(1.0, 1.0), .position = {i + 0.0, 0.5}, .angle = quarter},
                         "post " + std::to_string(i)));
  }
  model.beam = model.system.add(RigidBody{.mass = rod(1.0, 2.0), .position = {1.0, 1.0}}, "beam");
  for (std::size_t i = 0; i < 3; ++i) {
    const auto x = static_cast<double>(i);
    const std::string number = std::to_string(i);
    model.system.add(Revolute{.from = {ground, {x, 0.0}}, .to = {model.posts[i], {-0.5, 0.0}}},
                     "foot " + number);
    model.system.add(Revolute{.from = {model.posts[i], {0.5, 0.0}}, .to = {model.beam, {x - 1.0, 0.0}}},
                     "head " + number);
  }
  return model;
}

TEST(JointClosure, ClosedJointsAreLeftAlone) {
  const System system = bridge().system;
  const Assembly assembly(system);
  const Closed result = closed(system);
  EXPECT_EQ(result.state.q, assembly.initial_state().q);
  EXPECT_EQ(result.state.v, assembly.initial_state().v);
  EXPECT_EQ(result.closure.shift, 0.0);
  EXPECT_EQ(result.closure.change, 0.0);
}

TEST(JointClosure, MassesShareADisplacementInversely) {
  // Particles 1.3 m apart on a rod of 1 m: they come together along the line, the lighter by more.
  System system;
  const BodyId light = system.add(Particle{.mass = 1.0, .velocity = {-1.0, 0.5}});
  const BodyId heavy = system.add(Particle{.mass = 2.0, .position = {1.3, 0.0}, .velocity = {2.0, 0.5}});
  system.add(Rod{.from = light, .to = heavy, .length = 1.0});
  const Closed result = closed(system);
  EXPECT_NEAR(result.state.position(light)[0], 0.2, 1e-15);
  EXPECT_NEAR(result.state.position(heavy)[0], 1.2, 1e-15);
  EXPECT_NEAR(result.closure.shift, 0.2, 1e-15);
  // They part at 3 m/s along the rod; the momentum stays.
  EXPECT_NEAR(result.state.velocity(light)[0], 1.0, 1e-15);
  EXPECT_NEAR(result.state.velocity(heavy)[0], 1.0, 1e-15);
  EXPECT_NEAR(result.state.velocity(light)[1], 0.5, 1e-15);
  EXPECT_NEAR(result.closure.change, 2.0, 1e-15);
}

TEST(JointClosure, KeptBodiesStayWhereTheyAre) {
  System system;
  const BodyId kept = system.add(Particle{.mass = 1.0, .velocity = {-1.0, 0.5}});
  const BodyId other = system.add(Particle{.mass = 2.0, .position = {1.3, 0.0}, .velocity = {2.0, 0.5}});
  system.add(Rod{.from = kept, .to = other, .length = 1.0});
  system.keep_place(kept);
  const Closed result = closed(system);
  EXPECT_EQ(result.state.position(kept)[0], 0.0);
  EXPECT_EQ(result.state.position(kept)[1], 0.0);
  EXPECT_EQ(result.state.velocity(kept)[0], -1.0);
  EXPECT_NEAR(result.state.position(other)[0], 1.0, 1e-15);
  EXPECT_NEAR(result.state.velocity(other)[0], -1.0, 1e-15);
  // And no longer where the mark is taken off.
  system.keep_place(kept, false);
  EXPECT_NEAR(closed(system).state.position(kept)[0], 0.2, 1e-15);
}

TEST(JointClosure, DisplacementIsTheSmallestInTheSenseOfTheMasses) {
  // An open double pendulum with gaps of the order s: to first order the displacement is M^-1 G^T l; turns of
  // some s move levers by some s^2.
  const double s = 1e-4, a = 0.3, b = -0.8;
  System system;
  const Vec<2> along(0.5 * std::cos(a), 0.5 * std::sin(a)), next(0.5 * std::cos(b), 0.5 * std::sin(b));
  const Vec<2> first = along + s * Vec<2>(1.0, -2.0), second = 2.0 * along + next + s * Vec<2>(-1.0, 0.5);
  const BodyId upper = system.add(RigidBody{.mass = rod(1.0, 1.0), .position = first, .angle = a});
  const BodyId lower = system.add(RigidBody{.mass = rod(3.0, 1.0), .position = second, .angle = b});
  system.add(Revolute{.from = {ground, {0.0, 0.0}}, .to = {upper, {-0.5, 0.0}}});
  system.add(Revolute{.from = {upper, {0.5, 0.0}}, .to = {lower, {-0.5, 0.0}}});
  Eigen::MatrixXd g(4, 6);
  g << 1, 0, along[1], 0, 0, 0,        //
      0, 1, -along[0], 0, 0, 0,        //
      -1, 0, along[1], 1, 0, next[1],  //
      0, -1, -along[0], 0, 1, -next[0];
  Eigen::VectorXd inverse(6), gap(4);
  inverse << 1.0, 1.0, 12.0, 1.0 / 3.0, 1.0 / 3.0, 4.0;
  gap << first - along, second - next - (first + along);
  const Eigen::MatrixXd w = inverse.asDiagonal();
  const Eigen::VectorXd expected = -w * g.transpose() * (g * w * g.transpose()).inverse() * gap;
  const Closed result = closed(system);
  const State start = Assembly(system).initial_state();
  const auto check = [&](BodyId body, Eigen::Index at, double angle) {
    EXPECT_NEAR(result.state.position(body)[0] - start.position(body)[0], expected[at], 20.0 * s * s);
    EXPECT_NEAR(result.state.position(body)[1] - start.position(body)[1], expected[at + 1], 20.0 * s * s);
    EXPECT_NEAR(result.state.angle(body) - angle, expected[at + 2], 20.0 * s * s);
  };
  check(upper, 0, a);
  check(lower, 3, b);
  const double radius = std::sqrt(1.0 / 12.0);
  const double largest =
      std::max({std::abs(expected[0]), std::abs(expected[1]), radius * std::abs(expected[2]),
                std::abs(expected[3]), std::abs(expected[4]), radius * std::abs(expected[5])});
  EXPECT_NEAR(result.closure.shift, largest, 20.0 * s * s);
  EXPECT_GT(largest, 0.5 * s);
}

TEST(JointClosure, VelocitiesLoseOnlyWhatJointsForbid) {
  // A pinned rod thrown sideways turns: what is left is the turn about the pin with the same moment of
  // momentum.
  System system;
  const BodyId bar = system.add(
      RigidBody{.mass = rod(2.0, 1.0), .position = {0.5, 0.0}, .velocity = {3.0, 1.0}, .spin = 1.0});
  const JointId pin = system.add(Revolute{.from = ground, .to = {bar, {-0.5, 0.0}}});
  const Closed result = closed(system);
  const double spin = (2.0 * 0.5 * 1.0 + 2.0 / 12.0) / (2.0 / 3.0);
  EXPECT_NEAR(result.state.spin(bar), spin, 1e-14);
  EXPECT_NEAR(result.state.rate(pin), spin, 1e-14);
  EXPECT_NEAR(result.state.velocity(bar)[0], 0.0, 1e-14);
  EXPECT_NEAR(result.state.velocity(bar)[1], 0.5 * spin, 1e-14);
  EXPECT_NEAR(result.closure.change, 3.0, 1e-14);
}

TEST(JointClosure, SimulationsTellWhatWasMoved) {
  System system;
  const BodyId bob = system.add(Particle{.mass = 1.0, .position = {1.2, 0.0}});
  system.add(Rod{.from = ground, .to = bob, .length = 1.0});
  system.close_joints();
  for (const Mode& mode : {Mode(TimeStepping{}), Mode(EventDriven{})}) {
    Simulation simulation(system, mode);
    EXPECT_NEAR(simulation.report().projected, 0.2, 1e-15);
    EXPECT_NEAR(simulation.state().position(bob)[0], 1.0, 1e-15);
    EXPECT_EQ(simulation.energy().residual(), 0.0);
    State moved = simulation.state();
    moved.position(bob) = Vec<2>(0.0, 1.1);
    moved.velocity(bob) = Vec<2>(2.0, 3.0);
    simulation.set_state(moved);
    EXPECT_NEAR(simulation.state().position(bob)[1], 1.0, 1e-15);
    EXPECT_NEAR(simulation.state().velocity(bob)[0], 2.0, 1e-14);
    EXPECT_NEAR(simulation.state().velocity(bob)[1], 0.0, 1e-14);
  }
}

TEST(JointClosure, WhatCannotBeReachedIsRefused) {
  // Two rods of 1 m cannot span 3 m.
  System system;
  const BodyId left = system.add(RigidBody{.mass = rod(1.0, 1.0), .position = {0.5, 0.0}}, "left");
  const BodyId right = system.add(RigidBody{.mass = rod(1.0, 1.0), .position = {2.5, 0.0}}, "right");
  system.add(Revolute{.from = ground, .to = {left, {-0.5, 0.0}}}, "first");
  system.add(Revolute{.from = {left, {0.5, 0.0}}, .to = {right, {-0.5, 0.0}}}, "middle");
  system.add(Revolute{.from = {ground, {3.0, 0.0}}, .to = {right, {0.5, 0.0}}}, "last");
  EXPECT_MODEL_ERROR(closed(system), "cannot be closed", "off by", "allowed: joints that can be closed");
  EXPECT_MODEL_ERROR(Simulation(system, EventDriven{}), "cannot be closed");
  EXPECT_MODEL_ERROR(Simulation(system, TimeStepping{}), "cannot be closed");
}

TEST(JointClosure, ContradictionNamesTheOthers) {
  Bridge model = bridge();
  model.system.add(Rod{.from = {ground, {0.0, 0.0}}, .to = {model.posts[0], {0.5, 0.0}}, .length = 1.5},
                   "tie");
  EXPECT_MODEL_ERROR(closed(model.system), "cannot be closed", "tie", "foot 0");
}

TEST(JointClosure, KeptBodiesThatContradictAreRefused) {
  System system;
  const BodyId a = system.add(Particle{.mass = 1.0});
  const BodyId b = system.add(Particle{.mass = 1.0, .position = {1.3, 0.0}});
  system.add(Rod{.from = a, .to = b, .length = 1.0}, "stick");
  system.keep_place(a);
  system.keep_place(b);
  EXPECT_MODEL_ERROR(closed(system), "stick", "cannot be closed", "off by 0.3");
}

TEST(JointClosure, RedundantPostIsNamedAndHarmless) {
  const Bridge model = bridge();
  const Mobility found = mobility_of(model.system);
  EXPECT_EQ(found.velocities, 12U);
  EXPECT_EQ(found.rows, 12U);
  EXPECT_EQ(found.independent_rows, 11U);
  EXPECT_EQ(found.degrees_of_freedom, 1U);
  ASSERT_EQ(found.redundant.size(), 1U);
  // Which of the joints is called redundant is the library's choice; all posts take part.
  std::string names = model.system.name(found.redundant[0].joint);
  for (const JointId joint : found.redundant[0].with) names += model.system.name(joint);
  for (const char* const post : {"0", "1", "2"}) EXPECT_NE(names.find(post), std::string::npos) << names;

  // It moves as the bridge without its middle post, but for the mass: all posts and the beam swing alike,
  // (3/3 + 1) phi'' = -(3/2 + 1) g cos(phi) from phi = 90 degrees less a little.
  System loaded = model.system;
  loaded.add(Gravity{{0.0, -9.81}});
  Simulation simulation(loaded, EventDriven{.relative_tolerance = 1e-11, .absolute_tolerance = 1e-12});
  State start = simulation.state();
  for (const BodyId post : model.posts) {
    start.spin(post) = 1.0;
    start.velocity(post) = Vec<2>(-0.5, 0.0);
  }
  start.velocity(model.beam) = Vec<2>(-1.0, 0.0);
  simulation.set_state(start);
  simulation.run_until(0.5);
  System alone;
  alone.add(Gravity{{0.0, -9.81}});
  // A rod of mass m and moment m/12 whose pin is at distance d from its centre: (1/12 + d^2) m = 2, m d =
  // 5/2.
  const double m = 12.0 * (1.0 + std::sqrt(1.0 - 6.25 / 12.0)), d = 2.5 / m;
  const BodyId pendulum = alone.add(RigidBody{
      .mass = rod(m, 1.0), .position = {0.0, d}, .angle = quarter, .velocity = {-d, 0.0}, .spin = 1.0});
  alone.add(Revolute{.from = ground, .to = {pendulum, {-d, 0.0}}});
  Simulation same(alone, EventDriven{.relative_tolerance = 1e-11, .absolute_tolerance = 1e-12});
  same.run_until(0.5);
  for (const BodyId post : model.posts) {
    EXPECT_NEAR(simulation.state().angle(post), same.state().angle(pendulum), 1e-9);
    EXPECT_NEAR(simulation.state().spin(post), same.state().spin(pendulum), 1e-8);
  }
}

TEST(JointClosure, DegreesOfFreedom) {
  const auto degrees = [](const System& system) {
    const Mobility found = mobility_of(system);
    EXPECT_EQ(found.velocities - found.independent_rows, found.degrees_of_freedom);
    EXPECT_EQ(found.rows - found.independent_rows, found.redundant.size());
    return found.degrees_of_freedom;
  };
  System system;
  const BodyId a = system.add(RigidBody{.mass = rod(1.0, 1.0), .position = {0.5, 0.0}});
  EXPECT_EQ(degrees(system), 3U);
  const JointId pin = system.add(Revolute{.from = ground, .to = {a, {-0.5, 0.0}}});
  EXPECT_EQ(degrees(system), 1U);
  const BodyId b = system.add(RigidBody{.mass = rod(1.0, 1.0), .position = {1.0, 0.5}, .angle = quarter});
  EXPECT_EQ(degrees(system), 4U);
  system.add(Revolute{.from = {a, {0.5, 0.0}}, .to = {b, {-0.5, 0.0}}});
  EXPECT_EQ(degrees(system), 2U);
  System four_bar = system;
  const BodyId c = four_bar.add(RigidBody{.mass = rod(1.0, 1.2), .position = {1.6, 1.0}});
  four_bar.add(Revolute{.from = {b, {0.5, 0.0}}, .to = {c, {-0.6, 0.0}}});
  four_bar.add(Revolute{.from = {ground, {2.2, 1.0}}, .to = {c, {0.6, 0.0}}});
  EXPECT_EQ(degrees(four_bar), 1U);
  four_bar.add(Driver{.joint = pin, .position = [](double t) { return 0.1 * t; }});
  EXPECT_EQ(degrees(four_bar), 0U);
  System slider = system;
  const BodyId block = slider.add(RigidBody{.mass = box(1.0, 0.1, 0.1), .position = {1.0, 1.0}});
  slider.add(Revolute{.from = {b, {0.5, 0.0}}, .to = block});
  slider.add(Prismatic{.from = {ground, {1.0, 1.0}}, .to = block, .axis = {0.0, 1.0}});
  EXPECT_EQ(degrees(slider), 1U);
  System bound = system;
  bound.add(Rod{.from = ground, .to = {b, {0.5, 0.0}}});
  EXPECT_EQ(degrees(bound), 1U);
  bound.add(Weld{.from = {ground, {1.0, 1.0}}, .to = {b, {0.5, 0.0}}});
  EXPECT_EQ(degrees(bound), 0U);
  System loose;
  const BodyId disc_body = loose.add(RigidBody{.mass = disc(1.0, 0.2), .position = {0.0, 0.2}});
  loose.add(Rolling{.from = ground, .to = disc_body, .normal = {0.0, 1.0}, .radius = 0.2});
  EXPECT_EQ(degrees(loose), 1U);
  const BodyId bead = loose.add(Particle{.mass = 1.0});
  loose.add(PointOnLine{.from = disc_body, .to = bead, .axis = {1.0, 0.0}});
  EXPECT_EQ(degrees(loose), 2U);
}

TEST(JointClosure, DriversThatContradictAreRefused) {
  // The posts of a bridge turn alike.
  Bridge model = bridge();
  const JointId first = model.system.joint("foot 0"), second = model.system.joint("foot 2");
  model.system.add(Driver{.joint = first, .position = [](double t) { return 0.3 * t; }}, "one");
  System agreeing = model.system;
  agreeing.add(Driver{.joint = second, .position = [](double t) { return 0.3 * t; }}, "other");
  EXPECT_EQ(mobility_of(agreeing).degrees_of_freedom, 0U);
  EXPECT_EQ(mobility_of(agreeing).redundant.size(), 2U);

  System of_positions = model.system;
  of_positions.add(Driver{.joint = second, .position = [](double t) { return 0.1 + 0.3 * t; }}, "other");
  EXPECT_MODEL_ERROR(closed(of_positions), "cannot be closed", "one", "other");
  System of_rates = model.system;
  of_rates.add(Driver{.joint = second, .position = [](double t) { return 0.5 * t; }}, "other");
  EXPECT_MODEL_ERROR(closed(of_rates), "cannot be kept closed", "one", "other", "rad/s");
  EXPECT_MODEL_ERROR(
      model.system.add(Driver{.joint = first, .position = [](double t) { return t; }}, "again"), "again",
      "foot 0", "one", "a joint without a driver");
}

}  // namespace
