// Light bodies in mechanisms of heavy ones: bodies that joints bind stay bound at any ratio of masses, in
// both modes, and move as those of no mass.

#include <carom/carom.h>

#include "tests/integrators/throws.h"
#include "tests/random.h"
#include "tests/shares.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;

constexpr double g = 9.81;

/// Angle from the horizontal of a pendulum that is released level, by classical Runge-Kutta.
double pendulum_angle(double length, double time) {
  const int steps = 20000;
  const double h = time / steps;
  double angle = 0.0, spin = 0.0;
  const auto turn = [&](double at) { return g / length * std::cos(at); };
  for (int i = 0; i < steps; ++i) {
    const double k1 = turn(angle), w1 = spin;
    const double k2 = turn(angle + 0.5 * h * w1), w2 = spin + 0.5 * h * k1;
    const double k3 = turn(angle + 0.5 * h * w2), w3 = spin + 0.5 * h * k2;
    const double k4 = turn(angle + h * w3), w4 = spin + h * k3;
    angle += h / 6.0 * (w1 + 2.0 * w2 + 2.0 * w3 + w4);
    spin += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
  }
  return angle;
}

Vec<2> pendulum(double length, double time) {
  const double angle = pendulum_angle(length, time);
  return {length * std::cos(angle), -length * std::sin(angle)};
}

struct Chain {
  System system;
  std::vector<BodyId> links;
  BodyId bob{};
};

/// Links of a mass each, of 1 m in all, level, with a bob of 1 kg at the end.
Chain chain(int count, double mass) {
  Chain made;
  made.system.add(Gravity{{0.0, -g}});
  const double length = 1.0 / count;
  BodyId last = ground;
  Vec<2> end(0.0, 0.0);
  for (int i = 0; i < count; ++i) {
    const BodyId link =
        made.system.add(RigidBody{.mass = rod(mass, length), .position = {(i + 0.5) * length, 0.0}});
    made.system.add(Revolute{.from = {last, end}, .to = {link, {-0.5 * length, 0.0}}});
    made.links.push_back(link);
    last = link;
    end = {0.5 * length, 0.0};
  }
  made.bob = made.system.add(Particle{.mass = 1.0, .position = {1.0, 0.0}});
  made.system.add(Revolute{.from = {last, end}, .to = made.bob});
  return made;
}

/// A light particle in the middle of two rods, a heavy one at the end.
Chain rods(double mass) {
  Chain made;
  made.system.add(Gravity{{0.0, -g}});
  made.links.push_back(made.system.add(Particle{.mass = mass, .position = {1.0, 0.0}}));
  made.bob = made.system.add(Particle{.mass = 1.0, .position = {2.0, 0.0}});
  made.system.add(Rod{.from = ground, .to = made.links.front()});
  made.system.add(Rod{.from = made.links.front(), .to = made.bob});
  return made;
}

double longest_gap(const Chain& at, const State& state) {
  const Vec<2> first = state.position(at.links.front()), bob = state.position(at.bob);
  return std::max(std::abs(first.norm() - 1.0), std::abs((bob - first).norm() - 1.0));
}

TEST(LightBodies, ALightParticleBetweenRodsCarriesTheBobOverEvents) {
  constexpr double end = 0.03;
  for (const double mass : {1e-6, 1e-9, 1e-11, 1e-12}) {
    const Chain at = rods(mass);
    Simulation simulation(at.system, EventDriven{});
    EXPECT_EQ(simulation.mobility().degrees_of_freedom, 2U) << mass;
    ASSERT_NO_THROW(simulation.run_until(end)) << mass;
    EXPECT_LE(longest_gap(at, simulation.state()), 1e-14) << mass;
    // The light one swings to both sides of the line by (m/M)^(1/4) of the first fall.
    EXPECT_LE((simulation.state().position(at.bob) - pendulum(2.0, end)).norm(),
              1e-3 * std::sqrt(mass) + 1e-11)
        << mass;
  }
}

TEST(LightBodies, ALightLinkHoldsAtItsKneeOverEvents) {
  System system;
  system.add(Gravity{{0.0, -g}});
  const BodyId link = system.add(RigidBody{.mass = {.mass = 1e-8, .inertia = 1e-11}, .position = {0.5, 0.0}});
  const BodyId bar = system.add(RigidBody{.mass = rod(1.0, 1.0), .position = {1.5, 0.0}});
  system.add(Revolute{.from = ground, .to = {link, {-0.5, 0.0}}});
  system.add(Revolute{.from = {link, {0.5, 0.0}}, .to = {bar, {-0.5, 0.0}}});
  Simulation events(system, EventDriven{}), steps(system, TimeStepping{.step = 1e-3});
  events.run_until(1.0);
  steps.run_until(1.0);
  for (Simulation* const simulation : {&events, &steps}) {
    const State& state = simulation->state();
    const double a = state.angle(link), b = state.angle(bar);
    const Vec<2> knee = state.position(link) + 0.5 * Vec<2>(std::cos(a), std::sin(a));
    const Vec<2> end = state.position(bar) - 0.5 * Vec<2>(std::cos(b), std::sin(b));
    EXPECT_LE((knee - end).norm(), 1e-13);
  }
  // Steps of 1 ms against events: of second order.
  EXPECT_LE((events.state().position(bar) - steps.state().position(bar)).norm(), 1e-5);
}

TEST(LightBodies, JointsThatNumbersCannotKeepAreAnError) {
  for (const double mass : {1e-17, 1e-20}) {
    const Chain at = rods(mass);
    Simulation simulation(at.system, EventDriven{.step_limit = 1e8});
    EXPECT_THROWS(SolverError, simulation.run_until(0.1), "masses differ", "particle #0");
    EXPECT_LE(longest_gap(at, simulation.state()), 1e-6);
  }
}

TEST(LightBodies, LightLinksAreSteppedAtAnyRatio) {
  constexpr double end = carom_test::usual_or(0.5, 0.25);
  for (const double mass : carom_test::samples({1e-2, 1e-3, 1e-4, 1e-5, 1e-7, 1e-8, 1e-10}, 3)) {
    const Chain at = chain(10, mass);
    Simulation simulation(at.system, TimeStepping{.step = 1e-3});
    ASSERT_NO_THROW(simulation.run_until(end)) << mass;
    // The links' own mass moves the bob by some 2 m/M.
    EXPECT_LE((simulation.state().position(at.bob) - pendulum(1.0, end)).norm(), 3.0 * mass + 2e-5) << mass;
  }
}

/// Where the trapezoidal rule lets light links and the bob excite each other, by chance of their frequencies
/// against the step, this rule does not.
TEST(LightBodies, LightLinksKeepTheEnergyUnderEnergyMomentum) {
  constexpr double end = carom_test::usual_or(0.5, 0.25);
  for (const int count : carom_test::samples({1, 2, 5, 10, 20})) {
    for (const double mass : carom_test::samples({1e-2, 1e-3, 1e-5, 1e-6, 1e-8})) {
      const Chain at = chain(count, mass);
      Simulation simulation(at.system, TimeStepping{.step = 1e-3, .force_rule = ForceRule::energy_momentum});
      const double before = simulation.energy().total();
      ASSERT_NO_THROW(simulation.run_until(end)) << count << ' ' << mass;
      EXPECT_NEAR(simulation.energy().total(), before, 1e-11) << count << ' ' << mass;
      EXPECT_LE((simulation.state().position(at.bob) - pendulum(1.0, end)).norm(), 3.0 * count * mass + 2e-5)
          << count << ' ' << mass;
    }
  }
}

/// Links that swing within a step, and a bob that they excite: the error names them, and the ratio.
TEST(LightBodies, LinksThatCannotBeSteppedAreNamed) {
  const Chain at = chain(10, 1e-6);
  Simulation simulation(at.system, TimeStepping{.step = 1e-3});
  EXPECT_THROWS(SolverError, simulation.run_until(1.0), "light are rigid body #0", "1e-06 kg",
                "a ratio of 1e+06", "energy_momentum");
}

TEST(LightBodies, LightLinksAreSteppedAsTheyHaveEvents) {
  constexpr double end = carom_test::usual_or(0.5, 0.25);
  for (const double mass : carom_test::samples({1e-2, 1e-3, 1e-4})) {
    const Chain at = chain(10, mass);
    Simulation steps(at.system, TimeStepping{.step = 1e-3}), events(at.system, EventDriven{});
    steps.run_until(end);
    events.run_until(end);
    EXPECT_LE((steps.state().position(at.bob) - events.state().position(at.bob)).norm(), 2e-5) << mass;
  }
}

}  // namespace
