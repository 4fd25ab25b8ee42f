// The rule energy_momentum: energy, linear and angular momentum at round-off, for springs that turn, springs
// that are not linear, and ends off the centres of rigid bodies; dashpots that only lose; order two.

#include "tests/analytic/convergence.h"
#include "tests/energy/free_assemblies.h"
#include "tests/energy/ledger_check.h"
#include "tests/random.h"

#include <carom/carom.h>
#include <carom/core/assembly.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::Departure;
using carom_test::departure;
using carom_test::Invariants;
using carom_test::invariants;
using carom_test::ledger_closes;

constexpr double eps = std::numeric_limits<double>::epsilon();

TimeStepping rule(double step, double tolerance = 0.0) {
  return {.step = step, .tolerance = tolerance, .force_rule = ForceRule::energy_momentum};
}

/// The turning pair of the paper's proportions, its length oscillating.
System turning_pair(double damping = 0.0) {
  System system;
  const BodyId first = system.add(Particle{.mass = 1.0, .position = {1.1, 0.0}, .velocity = {0.0, 10.0}});
  const BodyId second = system.add(Particle{.mass = 1.0, .position = {-1.1, 0.0}, .velocity = {0.0, -10.0}});
  system.add(
      SpringDamper{.from = first, .to = second, .stiffness = 1000.0, .damping = damping, .free_length = 2.0});
  return system;
}

void turning_pair_keeps_energy_and_angular_momentum(int steps) {
  Simulation simulation(turning_pair(), rule(1e-3));
  const Invariants start = invariants(simulation);
  const Departure largest = departure(simulation, steps);
  // Asked for: 1e-10 over 100,000 steps.
  EXPECT_LE(largest.energy, 1e-10 * start.energy);
  EXPECT_LE(largest.angular, 1e-10 * std::abs(start.angular));
  EXPECT_LE(largest.linear, 1e3 * eps * 10.0);
  EXPECT_TRUE(ledger_closes(simulation.energy()));
  EXPECT_LE(std::abs(simulation.energy().flow(EnergyFlow::coupling_discretisation)), 1e-10 * start.energy);
}

TEST(EnergyMomentum, TurningPairKeepsEnergyAndAngularMomentum) {
  turning_pair_keeps_energy_and_angular_momentum(10000);
}

TEST(EnergyMomentumLong, TurningPairKeepsEnergyAndAngularMomentum) {
  turning_pair_keeps_energy_and_angular_momentum(100000);
}

TEST(EnergyMomentum, TheDefaultRuleDoesNot) {
  // A failure that the tests above and below must be able to see.
  Simulation simulation(turning_pair(), TimeStepping{.step = 1e-3, .tolerance = 0.0});
  const Invariants start = invariants(simulation);
  const Departure largest = departure(simulation, 1000);
  EXPECT_GT(largest.energy, 1e-6 * start.energy);
  EXPECT_GT(largest.angular, 1e-6 * std::abs(start.angular));
}

TEST(EnergyMomentum, LargeStepsKeepThemToo) {
  // Half a radian a step: far from accurate, still exact in what it keeps.
  Simulation simulation(turning_pair(), rule(0.03));
  const Invariants start = invariants(simulation);
  const Departure largest = departure(simulation, 1000);
  EXPECT_LE(largest.energy, 1e-11 * start.energy);
  EXPECT_LE(largest.angular, 1e-11 * std::abs(start.angular));
}

/// Two plates and a particle, joined off their centres by elements of every kind that stores energy.
System mobile(double damping, bool cable = true) {
  System system;
  const BodyId left = system.add(RigidBody{
      .mass = disc(1.0, 0.4), .position = {-0.8, 0.1}, .angle = 0.3, .velocity = {0.5, -1.0}, .spin = 6.0});
  const BodyId right = system.add(
      RigidBody{.mass = disc(2.0, 0.5), .position = {0.9, -0.2}, .velocity = {-0.3, 2.0}, .spin = -4.0});
  const BodyId dot = system.add(Particle{.mass = 0.5, .position = {0.1, 1.2}, .velocity = {3.0, 0.5}});
  system.add(SpringDamper{.from = {left, {0.3, 0.2}},
                          .to = {right, {-0.2, 0.4}},
                          .stiffness = 200.0,
                          .damping = damping,
                          .free_length = 1.0});
  system.add(NonlinearSpring{
      .from = {left, {-0.1, 0.3}},
      .to = dot,
      .force = [](double l) { return 300.0 * std::pow(l - 1.2, 3.0) + 20.0 * (l - 1.2); },
      .potential_of = [](double l) { return 75.0 * std::pow(l - 1.2, 4.0) + 10.0 * std::pow(l - 1.2, 2.0); },
      .damping = damping});
  if (cable) {
    system.add(Cable{
        .from = dot, .to = {right, {0.2, -0.1}}, .stiffness = 150.0, .damping = damping, .free_length = 1.4});
  }
  system.add(TorsionalSpring{.from = left, .to = right, .stiffness = 5.0, .damping = 0.1 * damping});
  Mat<3> stiffness;
  stiffness << 60.0, 10.0, 2.0, 10.0, 40.0, 1.0, 2.0, 1.0, 4.0;
  system.add(Bushing{.from = {left, {0.4, 0.0}},
                     .to = {right, {-0.4, 0.1}},
                     .stiffness = stiffness,
                     .damping = 0.05 * damping * stiffness,
                     .rest = {0.8, 0.0, 0.2}});
  return system;
}

void every_kind_of_spring(int steps) {
  Simulation simulation(mobile(0.0), rule(2e-3));
  const Invariants start = invariants(simulation);
  const Departure largest = departure(simulation, steps);
  EXPECT_LE(largest.energy, 1e-10 * start.energy);
  EXPECT_LE(largest.angular, 1e-10 * std::abs(start.angular));
  EXPECT_LE(largest.linear, 1e3 * eps * 10.0);
  EXPECT_TRUE(ledger_closes(simulation.energy()));
}

TEST(EnergyMomentum, EveryKindOfSpringOffTheCentresOfRigidBodies) { every_kind_of_spring(2000); }

TEST(EnergyMomentumLong, EveryKindOfSpringOffTheCentresOfRigidBodies) { every_kind_of_spring(20000); }

void off_centre_pair(int steps) {
  System system;
  const BodyId left = system.add(
      RigidBody{.mass = disc(1.0, 0.4), .position = {-1.0, 0.0}, .velocity = {0.0, -4.0}, .spin = 3.0});
  const BodyId right = system.add(
      RigidBody{.mass = disc(1.5, 0.6), .position = {1.0, 0.0}, .velocity = {0.0, 4.0}, .spin = -2.0});
  system.add(SpringDamper{
      .from = {left, {0.2, 0.3}}, .to = {right, {-0.3, 0.2}}, .stiffness = 500.0, .free_length = 1.5});
  Simulation simulation(std::move(system), rule(1e-3));
  const Invariants start = invariants(simulation);
  const Departure largest = departure(simulation, steps);
  EXPECT_LE(largest.energy, 1e-10 * start.energy);
  EXPECT_LE(largest.angular, 1e-10 * std::abs(start.angular));
}

TEST(EnergyMomentum, OffCentrePair) { off_centre_pair(10000); }

TEST(EnergyMomentumLong, OffCentrePairOverAHundredThousandSteps) { off_centre_pair(100000); }

TEST(EnergyMomentum, DashpotsOnlyLose) {
  for (const double step : {5e-4, 2e-3, 1e-2}) {
    // The bushing's dashpot is too strong for plain sweeps at the longest step.
    TimeStepping options = rule(step, 1e-13);
    if (step > 5e-3) options.iteration = Iteration::linearly_implicit;
    Simulation simulation(mobile(3.0), options);
    const Invariants start = invariants(simulation);
    const Departure largest = departure(simulation, 2000);
    // Rounding of a sum that grows to the energy lost.
    EXPECT_GE(largest.least_loss, -4.0 * eps * start.energy) << step;
    EXPECT_GT(simulation.energy().flow(EnergyFlow::dashpot), 0.1 * start.energy);
    EXPECT_LE(largest.energy, 1e-10 * start.energy) << step;
    EXPECT_LE(largest.angular, 1e-10 * std::abs(start.angular)) << step;
  }
}

TEST(EnergyMomentum, OrderTwo) {
  // Without the cable: its kink costs either rule an error of its own where it goes taut within a step.
  const auto end = [](double step) {
    Simulation simulation(mobile(1.0, false), rule(step, 1e-14));
    simulation.run_until(0.5);
    return simulation.state().q;
  };
  // The trapezoidal rule at a fine step is another method for the same motion; its own error is (1/8)^2 of
  // the finest one here, which moves the slope by less than 0.02.
  Simulation fine(mobile(1.0, false), TimeStepping{.step = 1.5625e-5, .tolerance = 1e-14});
  fine.run_until(0.5);
  std::vector<double> steps, errors;
  for (const double step : {1e-3, 5e-4, 2.5e-4, 1.25e-4}) {
    const std::vector<double> q = end(step);
    double error = 0.0;
    for (std::size_t i = 0; i < q.size(); ++i) error = std::max(error, std::abs(q[i] - fine.state().q[i]));
    steps.push_back(step);
    errors.push_back(error);
  }
  EXPECT_NEAR(analytic::slope(steps, errors), 2.0, 0.03);
}

TEST(EnergyMomentum, WithoutFreeLengthTheForceIsLinearThroughCoincidingEnds) {
  System system;
  const BodyId dot = system.add(Particle{.mass = 1.0, .position = {0.5, 0.0}});
  system.add(SpringDamper{.from = ground, .to = dot, .stiffness = 100.0, .free_length = 0.0});
  Simulation simulation(std::move(system), rule(1e-2));
  const double start = simulation.energy().total();
  for (int i = 0; i < 1000; ++i) simulation.step();
  EXPECT_NEAR(simulation.energy().total(), start, 1e-12 * start);
  // The trapezoidal rule turns the phase by 2 atan(h w/2) a step.
  EXPECT_NEAR(simulation.state().position(dot)[0], 0.5 * std::cos(2000.0 * std::atan(0.05)), 1e-10);
}

TEST(EnergyMomentum, InSpaceToo) {
  System system;
  const BodyId a =
      system.add(spatial::Particle{.mass = 1.0, .position = {1.0, 0.1, 0.0}, .velocity = {0.2, 3.0, 1.0}});
  const BodyId b =
      system.add(spatial::Particle{.mass = 2.0, .position = {-0.5, 0.0, 0.3}, .velocity = {0.0, -1.5, 0.5}});
  const BodyId c =
      system.add(spatial::Particle{.mass = 0.5, .position = {0.0, 1.0, -0.4}, .velocity = {1.0, 0.0, -2.0}});
  system.add(spatial::SpringDamper{.from = a, .to = b, .stiffness = 300.0, .free_length = 1.4});
  system.add(spatial::Bumper{.from = b, .to = c, .stiffness = 500.0, .free_length = 1.5});
  system.add(spatial::NonlinearSpring{.from = a,
                                      .to = c,
                                      .force = [](double l) { return 50.0 * std::sinh(l - 1.0); },
                                      .potential_of = [](double l) { return 50.0 * std::cosh(l - 1.0); }});
  Simulation simulation(std::move(system), rule(2e-3));
  const auto momentum = [&simulation](int i, int j) {
    double sum = 0.0;
    const auto& state = simulation.state();
    for (const BodySlot& slot : state.layout()->bodies()) {
      const double mass = simulation.assembly().body_kinds()[slot.kind]->mass(slot.slot);
      const double* x = state.q.data() + slot.q;
      const double* v = state.v.data() + slot.v;
      sum += mass * (x[i] * v[j] - x[j] * v[i]);
    }
    return sum;
  };
  const double energy = simulation.energy().total();
  const double x = momentum(1, 2), y = momentum(2, 0), z = momentum(0, 1);
  for (int i = 0; i < 10000; ++i) simulation.step();
  EXPECT_NEAR(simulation.energy().total(), energy, 1e-10 * energy);
  const double size = std::abs(x) + std::abs(y) + std::abs(z);
  EXPECT_NEAR(momentum(1, 2), x, 1e-10 * size);
  EXPECT_NEAR(momentum(2, 0), y, 1e-10 * size);
  EXPECT_NEAR(momentum(0, 1), z, 1e-10 * size);
}

TEST(EnergyMomentum, ElementsWithoutAMeanForceAreTakenHalfway) {
  // An actuator and drag on plates: momentum is kept by the actuator, and the drag only loses.
  System system = mobile(0.0);
  const BodyId extra = system.add(RigidBody{.mass = disc(1.0, 0.3), .position = {3.0, 1.0}, .spin = 1.0});
  const BodyId other = system.add(RigidBody{.mass = disc(1.0, 0.3), .position = {4.0, 1.0}});
  system.add(LinearActuator{.from = {extra, {0.1, 0.1}},
                            .to = {other, {0.0, -0.2}},
                            .force = [](double t, double l, double) { return std::sin(3.0 * t) * l; }});
  Simulation simulation(std::move(system), rule(2e-3));
  const Invariants start = invariants(simulation);
  for (int i = 0; i < 2000; ++i) simulation.step();
  const Invariants now = invariants(simulation);
  EXPECT_NEAR(now.angular, start.angular, 1e-11 * std::abs(start.angular));
  EXPECT_LE((now.linear - start.linear).norm(), 1e3 * eps * 10.0);
  EXPECT_NE(simulation.energy().flow(EnergyFlow::external), 0.0);
  EXPECT_TRUE(ledger_closes(simulation.energy()));
}

TEST(EnergyMomentum, ImpactsGoThroughIt) {
  System system = mobile(1.0);
  system.add(Gravity{{0.0, -9.81}});
  system.add(HalfPlane{.point = {0.0, -1.5}, .normal = {0.0, 1.0}},
             Surface{.friction = 0.4, .normal_restitution = 0.5, .tangential_restitution = 0.5});
  Simulation simulation(std::move(system), rule(1e-3, 1e-13));
  simulation.run_until(2.0);
  EXPECT_GT(simulation.statistics().impacts, 0);
  EXPECT_TRUE(ledger_closes(simulation.energy()));
  // Gravity is exact too.
  EXPECT_LE(std::abs(simulation.energy().flow(EnergyFlow::coupling_discretisation)),
            1e-10 * simulation.energy().scale());
}

}  // namespace
