// Forces along a line between two ends at one place: named before anything moves.

#include "tests/energy/event_scenes.h"
#include "tests/integrators/throws.h"
#include "tests/model_error.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;

/// Two particles at one place, off the origin, with something between them.
template <class Element>
System joined(Element element) {
  System system;
  element.from = system.add(Particle{.mass = 1.0, .position = {0.3, -0.7}, .velocity = {1.0, 0.0}}, "first");
  element.to = system.add(Particle{.mass = 2.0, .position = {0.3, -0.7}}, "second");
  system.add(element, "link");
  return system;
}

const std::vector<Mode> both_modes{TimeStepping{}, EventDriven{}};

void expect_refused(const System& system) {
  for (const Mode& mode : both_modes) {
    EXPECT_MODEL_ERROR(Simulation(system, mode), "'link'");
    EXPECT_MODEL_ERROR(Simulation(system, mode), "has no direction");
    EXPECT_MODEL_ERROR(Simulation(system, mode), "particle 'first' and particle 'second'");
  }
}

void expect_accepted(const System& system) {
  for (const Mode& mode : both_modes) {
    Simulation simulation(system, mode);
    EXPECT_NO_THROW(simulation.run_until(0.1));
  }
}

TEST(ForceDirections, WhatPushesWithoutALineIsRefused) {
  expect_refused(joined(SpringDamper{.stiffness = 10.0, .free_length = 0.5}));
  expect_refused(joined(Bumper{.stiffness = 10.0, .free_length = 0.5}));
  expect_refused(joined(MaxwellElement{.stiffness = 10.0, .damping = 1.0, .free_length = 0.5}));
  expect_refused(joined(MaxwellElement{.stiffness = 10.0, .damping = 1.0, .lengthening = 0.5}));
  expect_refused(
      joined(NonlinearSpring{.force = [](double l) { return 3.0 * (l - 0.5); },
                             .potential_of = [](double l) { return 1.5 * (l - 0.5) * (l - 0.5); }}));
  expect_refused(joined(NonlinearSpring{.force = [](double l) { return 1.0 / l; },
                                        .potential_of = [](double l) { return std::log(l); }}));
  expect_refused(joined(LinearActuator{.force = [](double, double, double) { return 2.0; }}));
}

TEST(ForceDirections, WhatVanishesThereIsAccepted) {
  expect_accepted(joined(SpringDamper{.stiffness = 10.0, .damping = 1.0}));
  expect_accepted(joined(SpringDamper{.damping = 1.0, .free_length = 0.5}));
  expect_accepted(joined(Cable{.stiffness = 10.0, .free_length = 0.5}));
  expect_accepted(joined(Cable{.stiffness = 10.0}));
  expect_accepted(joined(MaxwellElement{.stiffness = 10.0, .damping = 1.0}));
  expect_accepted(joined(NonlinearSpring{.force = [](double l) { return 3.0 * l; },
                                         .potential_of = [](double l) { return 1.5 * l * l; }}));
  expect_accepted(joined(LinearActuator{.force = [](double, double, double rate) { return -rate; }}));
}

TEST(ForceDirections, EndsThatMeetButForRoundingToo) {
  // A point of a turned bar on the ground: its place is a sum with rounding.
  System system;
  const double angle = 0.7;
  const BodyId bar = system.add(RigidBody{.mass = rod(1.0, 2.0), .angle = angle}, "bar");
  const SpringDamper spring{.from = {ground, {std::cos(angle), std::sin(angle)}},
                            .to = {bar, {1.0, 0.0}},
                            .stiffness = 1.0,
                            .free_length = 0.1};
  system.add(spring, "link");
  EXPECT_MODEL_ERROR(Simulation(system, TimeStepping{}), "ground and rigid body 'bar' stand at one place");
}

TEST(ForceDirections, SetStateAndEditAreRefusedAndChangeNothing) {
  System system;
  const BodyId a = system.add(Particle{.mass = 1.0, .position = {0.5, 0.0}});
  const BodyId b = system.add(Particle{.mass = 1.0});
  system.add(SpringDamper{.from = a, .to = b, .stiffness = 1.0, .free_length = 0.5}, "link");
  for (const Mode& mode : both_modes) {
    Simulation simulation(system, mode);
    simulation.run_until(0.1);
    const State before = simulation.state();
    State met = before;
    met.q.assign(met.q.size(), 0.25);
    EXPECT_MODEL_ERROR(simulation.set_state(met), "'link' has no direction");
    EXPECT_MODEL_ERROR(simulation.edit([&](System& edited) {
      const BodyId c = edited.add(Particle{.mass = 1.0, .position = {2.0, 0.0}});
      const BodyId d = edited.add(Particle{.mass = 1.0, .position = {2.0, 0.0}});
      edited.add(SpringDamper{.from = c, .to = d, .stiffness = 1.0, .free_length = 0.5}, "other");
    }),
                       "'other' has no direction");
    EXPECT_EQ(simulation.state().q, before.q);
    EXPECT_NO_THROW(simulation.run_until(0.2));
  }
}

TEST(ForceDirections, ARunThatComesToRestThereEndsByName) {
  // The upper one falls onto the lower one, which lies on the floor, and neither bounces: the spring between
  // them would push, in no direction.
  System system;
  system.add(Gravity{{0.0, -9.81}});
  system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = 0.0, .normal_restitution = 0.0});
  const BodyId lower = system.add(Particle{.mass = 1.0}, "lower");
  const BodyId upper = system.add(Particle{.mass = 1.0, .position = {0.0, 0.4}}, "upper");
  system.add(SpringDamper{.from = lower, .to = upper, .stiffness = 1.0, .free_length = 0.5}, "link");
  Simulation simulation(std::move(system), EventDriven{});
  EXPECT_THROWS(SolverError, simulation.run_until(1.0), "'link' has no direction",
                "'lower' and particle 'upper'");
  EXPECT_GT(simulation.time(), 0.0);
}

TEST(ForceDirections, ARunThatPassesThereGoesOn) {
  // The same with a bounce: the motion upwards gives the line.
  System system;
  system.add(Gravity{{0.0, -9.81}});
  system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = 0.0, .normal_restitution = 0.5});
  const BodyId lower = system.add(Particle{.mass = 1.0});
  const BodyId upper = system.add(Particle{.mass = 1.0, .position = {0.0, 0.4}});
  system.add(SpringDamper{.from = lower, .to = upper, .stiffness = 1.0, .free_length = 0.5});
  Simulation simulation(std::move(system), EventDriven{});
  EXPECT_NO_THROW(simulation.run_until(0.4));
}

TEST(ForceDirections, RandomScenesThatStartThereAreNamed) {
  for (const std::uint64_t seed : {22935u, 32129u, 95909u}) {
    const carom_test::EventScene scene(seed);
    for (const Mode& mode : both_modes) {
      EXPECT_MODEL_ERROR(Simulation(scene.system(), mode), "has no direction");
      EXPECT_MODEL_ERROR(Simulation(scene.system(), mode), "stand at one place");
    }
  }
}

TEST(ForceDirections, ARandomSceneThatComesThereRunsOnUnlessBothLieThere) {
  // One particle slides into the corner of a V in which the other one lies, and bounces ever less: rounding
  // decides whether the spring pushes the other one out before, or both lie at one place.
  Simulation simulation(carom_test::EventScene(82959).system(), EventDriven{.interval = 1e-4});
  try {
    simulation.run_until(2.0);
  } catch (const SolverError& error) {
    EXPECT_NE(std::string(error.what()).find("stand at one place"), std::string::npos) << error.what();
    const std::vector<BodyId> bodies = simulation.system().bodies();
    const Vec<2> apart = simulation.state().position(bodies[1]) - simulation.state().position(bodies[2]);
    EXPECT_LT(apart.norm(), 1e-8);  // within the last interval, more slowly than the capture speed
  }
  EXPECT_GT(simulation.time(), 0.885);
  EXPECT_LT(std::abs(simulation.energy().residual()), 1e-7 * simulation.energy().scale());  // tolerance 1e-9
}

}  // namespace
