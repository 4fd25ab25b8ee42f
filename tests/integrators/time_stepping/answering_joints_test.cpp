// Lasting contacts of bodies with joints, with impacts located: contact and the answer of the joints act
// halfway, and both hold their conditions at the end of the step. Of second order against the event-driven
// mode.

#include "tests/allocation_counter.h"
#include "tests/energy/ledger_check.h"
#include "tests/integrators/event_run.h"
#include "tests/integrators/same_run.h"
#include "tests/integrators/time_stepping/located_runs.h"
#include "tests/temporary_folder.h"

#include <carom/carom.h>
#include <carom/testing/refinement.h>

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
using carom_test::bits_of;
using carom_test::distance;
using carom_test::ledger_closes;
using carom_test::located;
using carom_test::tight;

constexpr double g = 9.81;

/// A motion whose contacts last up to its end.
struct Scene {
  std::string name;
  System system;
  double end = 0.0;
  bool gains = false;  // energy comes and goes by errors of second order
};

void add_floor(System& system, double friction, double height = 0.0) {
  system.add(Gravity{{0.0, -g}});
  system.add(HalfPlane{.point = {0.0, height}, .normal = {0.0, 1.0}},
             Surface{.friction = friction, .normal_restitution = 0.0});
}

double length(const Vec<2>& from, const Vec<2>& to) { return (to - from).norm(); }

BodyId add_bar(System& system, const Vec<2>& from, const Vec<2>& to, double mass = 1.0) {
  const Vec<2> along = to - from;
  return system.add(RigidBody{.mass = rod(mass, along.norm()),
                              .position = 0.5 * (from + to),
                              .angle = std::atan2(along[1], along[0])});
}

/// A crank turns at 4 rad/s and moves a slider that lies on the floor. \param rubbing friction in the bearing
/// [N m]
Scene slider_crank(double friction, double rubbing) {
  // Later, with friction, the crank falls back: sliding that turns round is of lower order.
  Scene scene{"slider-crank", {}, friction > 0.0 ? 0.12 : 0.4, friction == 0.0};
  System& system = scene.system;
  add_floor(system, friction, -0.05);
  constexpr double crank = 0.15, rod_length = 0.4, speed = 4.0, angle = 0.5;
  const Vec<2> pin(crank * std::cos(angle), crank * std::sin(angle));
  const Vec<2> wrist(pin[0] + std::sqrt(rod_length * rod_length - pin[1] * pin[1]), 0.0);
  const Vec<2> of_pin(-speed * pin[1], speed * pin[0]);
  const double spin = -of_pin[1] / (wrist - pin)[0];
  const Vec<2> of_slider(of_pin[0] - spin * (wrist - pin)[1], 0.0);
  const BodyId first = system.add(RigidBody{.mass = rod(1.0, crank),
                                            .position = 0.5 * pin,
                                            .angle = angle,
                                            .velocity = 0.5 * of_pin,
                                            .spin = speed});
  const BodyId second = system.add(RigidBody{.mass = rod(0.5, rod_length),
                                             .position = 0.5 * (pin + wrist),
                                             .angle = std::atan2((wrist - pin)[1], (wrist - pin)[0]),
                                             .velocity = 0.5 * (of_pin + of_slider),
                                             .spin = spin});
  const BodyId slider =
      system.add(RigidBody{.mass = box(2.0, 0.2, 0.1), .position = wrist, .velocity = of_slider});
  system.add(Polygon{.body = slider, .vertices = {{-0.1, -0.05}, {0.1, -0.05}, {0.1, 0.05}, {-0.1, 0.05}}});
  const JointId bearing = system.add(Revolute{.from = ground, .to = {first, {-0.5 * crank, 0.0}}});
  system.add(Revolute{.from = {first, {0.5 * crank, 0.0}}, .to = {second, {-0.5 * rod_length, 0.0}}});
  system.add(Revolute{.from = {second, {0.5 * rod_length, 0.0}}, .to = slider});
  if (rubbing > 0.0) system.add(JointFriction{.joint = bearing, .bound = rubbing});
  return scene;
}

/// A double pendulum whose tip slides on the floor.
Scene pendulum(double friction) {
  Scene scene{"pendulum", {}, 0.09, true};  // the tip lifts off at 0.1 s
  System& system = scene.system;
  add_floor(system, friction);
  const Vec<2> pivot(0.0, 1.0), knee(0.6, 0.6), tip(1.0, 0.0);
  const double upper = 0.5 * length(pivot, knee), lower = 0.5 * length(knee, tip);
  const BodyId first = add_bar(system, pivot, knee), second = add_bar(system, knee, tip);
  system.add(Point{.body = second, .position = {lower, 0.0}});
  system.add(Revolute{.from = {ground, pivot}, .to = {first, {-upper, 0.0}}});
  system.add(Revolute{.from = {first, {upper, 0.0}}, .to = {second, {-lower, 0.0}}});
  return scene;
}

/// A chain of four bars on three feet gives way. At the pin in the middle both bars touch, so that one
/// contact follows from the other.
Scene chain(double friction) {
  Scene scene{"chain", {}, 0.3};
  System& system = scene.system;
  add_floor(system, friction);
  const std::vector<Vec<2>> pins{{-1.0, 0.0}, {-0.5, 0.6}, {0.0, 0.0}, {0.45, 0.5}, {1.1, 0.0}};
  BodyId last{};
  for (std::size_t i = 0; i + 1 < pins.size(); ++i) {
    const double half = 0.5 * length(pins[i], pins[i + 1]);
    const BodyId bar = add_bar(system, pins[i], pins[i + 1]);
    system.add(Point{.body = bar, .position = {i % 2 == 0 ? -half : half, 0.0}});
    if (i > 0) {
      const double before = 0.5 * length(pins[i - 1], pins[i]);
      system.add(Revolute{.from = {last, {before, 0.0}}, .to = {bar, {-half, 0.0}}});
    }
    last = bar;
  }
  return scene;
}

/// Three discs on rods roll or slide down a wheel in a bearing: several components with joints.
Scene discs_on_a_wheel(double friction) {
  Scene scene{"discs on a wheel", {}, 0.3};
  System& system = scene.system;
  system.add(Gravity{{0.0, -g}});
  system.set_default_law({.friction = friction, .normal_restitution = 0.0});
  const BodyId wheel = system.add(RigidBody{.mass = disc(20.0, 1.0)});
  system.add(Disc{.body = wheel, .radius = 1.0});
  system.add(Revolute{.from = ground, .to = wheel});
  BodyId last{};
  for (int i = 0; i < 3; ++i) {
    const double angle = 1.2 - 0.25 * i;
    const BodyId body = system.add(
        RigidBody{.mass = disc(0.5, 0.05), .position = 1.05 * Vec<2>(std::cos(angle), std::sin(angle))});
    system.add(Disc{.body = body, .radius = 0.05});
    if (i > 0) system.add(Rod{.from = last, .to = body});
    last = body;
  }
  return scene;
}

/// A slider is held by the stop of a guide that swings.
Scene slider_at_a_stop(double rubbing) {
  Scene scene{"slider at a stop", {}, 0.08, true};
  System& system = scene.system;
  system.add(Gravity{{0.0, -g}});
  constexpr double spin = 3.0;
  const BodyId guide = system.add(
      RigidBody{.mass = rod(2.0, 1.0), .position = {0.5, 0.0}, .velocity = {0.0, 0.5 * spin}, .spin = spin});
  const BodyId slider = system.add(RigidBody{
      .mass = box(1.0, 0.1, 0.1), .position = {0.8, 0.0}, .velocity = {0.0, 0.8 * spin}, .spin = spin});
  system.add(Revolute{.from = ground, .to = {guide, {-0.5, 0.0}}});
  const JointId slide = system.add(Prismatic{.from = guide, .to = slider, .axis = {1.0, 0.0}});
  system.add(Stop{.joint = slide, .upper = 0.0});
  if (rubbing > 0.0) system.add(JointFriction{.joint = slide, .bound = rubbing});
  return scene;
}

/// A guide that falls over, its foot on the floor, while a slider comes down it and rubs.
Scene falling_guide() {
  Scene scene{"falling guide", {}, 0.3};
  System& system = scene.system;
  add_floor(system, 0.1);
  const Vec<2> foot(0.0, 0.0), top(0.8, 0.9);
  const BodyId guide = add_bar(system, foot, top, 2.0);
  system.add(Point{.body = guide, .position = {-0.5 * length(foot, top), 0.0}});
  const BodyId slider = system.add(
      RigidBody{.mass = box(1.0, 0.2, 0.1), .position = 0.7 * top, .angle = std::atan2(top[1], top[0])});
  const JointId slide = system.add(Prismatic{.from = guide, .to = slider, .axis = {1.0, 0.0}});
  system.add(JointFriction{.joint = slide, .bound = 0.5});
  return scene;
}

/// A driven bar moves another one, whose foot slides on the floor.
Scene driven_leg() {
  Scene scene{"driven leg", {}, 0.4, true};
  System& system = scene.system;
  add_floor(system, 0.1);
  const Vec<2> pivot(0.0, 0.4), knee(0.3, 0.8), foot(0.9, 0.0);
  const double upper = 0.5 * length(pivot, knee), lower = 0.5 * length(knee, foot);
  const BodyId thigh = add_bar(system, pivot, knee), shank = add_bar(system, knee, foot, 3.0);
  system.add(Point{.body = shank, .position = {lower, 0.0}});
  const JointId hip = system.add(Revolute{.from = {ground, pivot}, .to = {thigh, {-upper, 0.0}}});
  system.add(Revolute{.from = {thigh, {upper, 0.0}}, .to = {shank, {-lower, 0.0}}});
  system.add(Driver{.joint = hip, .position = [](double t) { return 0.8 * t * t; }});
  return scene;
}

std::vector<Scene> scenes() {
  return {slider_crank(0.0, 0.0),
          slider_crank(0.05, 0.0),
          slider_crank(0.05, 0.05),
          pendulum(0.0),
          pendulum(0.1),
          chain(0.0),
          chain(0.1),
          discs_on_a_wheel(0.0),
          discs_on_a_wheel(0.3),
          slider_at_a_stop(0.0),
          slider_at_a_stop(0.5),
          falling_guide(),
          driven_leg()};
}

struct Sinking {
  double deepest = 0.0;  // [m]
  double rise = 0.0;     // largest rise of T + V above a value before, but for external work [J]
  State end;
};

Sinking follow(const Scene& scene, double step) {
  Simulation simulation(scene.system, located(step));
  Sinking result;
  double least = simulation.energy().total();
  while (simulation.state().time < scene.end - 0.5 * step) {
    simulation.step();
    for (const ContactRecord& contact : simulation.report().contacts)
      result.deepest = std::max(result.deepest, -contact.gap);
    const double energy = simulation.energy().total() - simulation.energy().flow(EnergyFlow::external);
    result.rise = std::max(result.rise, energy - least);
    least = std::min(least, energy);
  }
  EXPECT_TRUE(ledger_closes(simulation.energy())) << scene.name;
  result.end = simulation.state();
  return result;
}

TEST(AnsweringJoints, ContactIsOfSecondOrder) {
  for (const Scene& scene : scenes()) {
    const State exact = carom_test::run(scene.system, tight(), scene.end);
    const std::vector<double> steps{2e-3, 1e-3, 5e-4};
    std::vector<double> errors, deepest;
    for (const double step : steps) {
      const Sinking run = follow(scene, step);
      errors.push_back(distance(run.end, exact));
      deepest.push_back(run.deepest);
    }
    // Each was of order 1 or, with friction in joints, of none. Measured: 1.98 to 2.01.
    EXPECT_GT(energy_test::fitted_order(steps, errors), 1.8) << scene.name;
    EXPECT_LT(errors[1], 2e-5) << scene.name;
    EXPECT_LT(deepest[1], 1e-6) << scene.name;
    if (deepest.back() > 0.0) {
      EXPECT_GT(energy_test::fitted_order(steps, deepest), 1.8) << scene.name;
    }
  }
}

// Reactions and contact do work on errors of the step only, of second order. At the slider and at ground that
// does not give way it comes back, as that of joints in the air does; where bodies slide on each other it is
// lost.
TEST(AnsweringJoints, EnergyRisesByErrorsOfSecondOrderOnly) {
  for (const Scene& scene : scenes()) {
    const double coarse = follow(scene, 2e-3).rise, fine = follow(scene, 5e-4).rise;
    if (!scene.gains) {
      EXPECT_LT(coarse, 1e-9) << scene.name;
      continue;
    }
    EXPECT_LT(coarse, 2e-5) << scene.name;
    EXPECT_LT(fine, std::max(coarse / 12.0, 1e-9)) << scene.name;  // 16 of order 2
  }
}

// The crank turns for ten revolutions. What the energy is off by in the last of them it was off by in the
// first.
TEST(AnsweringJoints, EnergyOfASliderCrankDoesNotDrift) {
  Scene scene = slider_crank(0.0, 0.0);
  Simulation simulation(scene.system, located(2e-3));
  const double start = simulation.energy().total();
  const auto largest_until = [&](double end) {
    double largest = 0.0;
    while (simulation.time() < end) {
      simulation.step();
      largest = std::max(largest, std::abs(simulation.energy().total() - start));
    }
    return largest;
  };
  const double first = largest_until(2.0);
  static_cast<void>(largest_until(14.0));
  EXPECT_LT(largest_until(16.0), 1.5 * first);
  EXPECT_LT(first, 1e-3 * std::abs(start));
}

// Another iteration than the first one finds the contacts anew: they act along the rows of the path all the
// same.
TEST(AnsweringJoints, AnyIterationEndsAtTheSameStep) {
  Scene scene = pendulum(0.1);
  const BodyId anchor = scene.system.bodies().front();
  scene.system.add(
      SpringDamper{.from = {ground, {0.0, 2.0}}, .to = anchor, .stiffness = 5e3, .free_length = 1.2});
  TimeStepping options = located(1e-3);
  const State end = carom_test::run(scene.system, options, 0.05);
  for (const Iteration iteration : {Iteration::anderson, Iteration::linearly_implicit}) {
    options.iteration = iteration;
    // Iterations end at 1e-12 m.
    EXPECT_LT(distance(carom_test::run(scene.system, options, 0.05), end), 1e-10) << to_string(iteration);
  }
}

TEST(AnsweringJoints, GoOnBitForBitAfterACheckpoint) {
  const carom_test::TemporaryFolder folder;
  for (const Scene& scene : {slider_crank(0.05, 0.05), chain(0.1), discs_on_a_wheel(0.3)}) {
    Simulation whole(scene.system, located(1e-3));
    whole.run_until(0.1);
    whole.save(folder / "half");
    Simulation rest(scene.system, located(1e-3));
    rest.load(folder / "half");
    whole.run_until(0.2);
    rest.run_until(0.2);
    EXPECT_EQ(bits_of(rest), bits_of(whole)) << scene.name;
  }
}

// The contraction by couplings is rated now and then, which allocates; nothing else does.
TEST(AnsweringJoints, TakeNoMemoryOnceContactsLast) {
  for (const Scene& scene : {slider_crank(0.05, 0.0), driven_leg(), falling_guide()}) {
    Simulation simulation(scene.system, located(1e-3));
    for (int i = 0; i < 50; ++i) simulation.step();
    int steps = 0;
    for (int i = 0; i < 50; ++i) {
      const std::int64_t before = carom_test::allocations();
      simulation.step();
      steps += carom_test::allocations() > before ? 1 : 0;
    }
    EXPECT_LE(steps, 3) << scene.name;
  }
}

}  // namespace
