// Invariants that the trapezoidal rule keeps of a pair of particles on a spring in free flight.

#include "tests/analytic/convergence.h"
#include "tests/analytic/rotating_spring_pair.h"
#include "tests/energy/ledger_check.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::ledger_closes;

constexpr double eps = std::numeric_limits<double>::epsilon();

/// The paper's pair, stretched, along an axis.
System vibrating_pair(const Vec<2>& axis, const Vec<2>& velocity, const Vec<2>& gravity) {
  System system;
  if (!gravity.isZero(0.0)) system.add(Gravity{gravity});
  const BodyId first = system.add(Particle{.mass = 1.0, .position = -1.1 * axis, .velocity = velocity});
  const BodyId second = system.add(Particle{.mass = 1.0, .position = 1.1 * axis, .velocity = velocity});
  system.add(SpringDamper{.from = first, .to = second, .stiffness = 1000.0, .free_length = 2.0});
  return system;
}

TEST(SpringPair, VibrationAlongItsAxisKeepsEnergy) {
  // Forces are linear along one line, so T + V is kept but for rounding; at tolerance 0 the iteration goes on
  // until it stops shrinking. Gravity and velocity along the axis (upright, so that rounding cannot turn it).
  // Asked for: 1e-11 relative over 100,000 steps. The height falls to 1.2e4 m, so that T and V reach 2.4e5 J.
  Simulation simulation(vibrating_pair({0.0, 1.0}, {0.0, 3.0}, {0.0, -9.81}),
                        TimeStepping{.step = 5e-4, .tolerance = 0.0});
  double largest = 0.0, size = 0.0;
  const double start = simulation.energy().total();
  simulation.observe([&](const Simulation& now) {
    largest = std::max(largest, std::abs(now.energy().total() - start));
    size = std::max({size, now.energy().kinetic(), std::abs(now.energy().potential())});
  });
  for (int i = 0; i < 100000; ++i) simulation.step();
  EXPECT_LE(largest, 1e-11 * size);
  EXPECT_TRUE(ledger_closes(simulation.energy()));
  // Nothing else took part.
  EXPECT_LE(std::abs(simulation.energy().flow(EnergyFlow::coupling_discretisation)), 1e-11 * size);
  EXPECT_EQ(simulation.energy().flow(EnergyFlow::dashpot), 0.0);
}

TEST(SpringPair, VibrationWithoutGravityKeepsEnergy) {
  // Without the large terms of gravity the size is the spring's own energy: sharper by a factor of 1e4.
  Simulation simulation(vibrating_pair({1.0, 0.0}, {0.7, 0.0}, {0.0, 0.0}),
                        TimeStepping{.step = 1e-3, .tolerance = 0.0});
  const double start = simulation.energy().total();
  double largest = 0.0;
  simulation.observe(
      [&](const Simulation& now) { largest = std::max(largest, std::abs(now.energy().total() - start)); });
  for (int i = 0; i < 100000; ++i) simulation.step();
  EXPECT_LE(largest, 1e-11 * start);
  EXPECT_TRUE(ledger_closes(simulation.energy()));
}

TEST(SpringPair, ZeroFreeLengthKeepsEnergyWhileTurning) {
  // A spring of free length 0 is linear in the coordinates in every direction.
  System system;
  const BodyId first = system.add(Particle{.mass = 1.0, .position = {1.0, 0.0}, .velocity = {0.3, 4.0}});
  const BodyId second = system.add(Particle{.mass = 2.0, .position = {-0.5, 0.2}, .velocity = {0.0, -2.0}});
  system.add(SpringDamper{.from = first, .to = second, .stiffness = 50.0, .free_length = 0.0});
  Simulation simulation(std::move(system), TimeStepping{.step = 5e-3, .tolerance = 0.0});
  const double start = simulation.energy().total();
  double largest = 0.0;
  simulation.observe(
      [&](const Simulation& now) { largest = std::max(largest, std::abs(now.energy().total() - start)); });
  for (int i = 0; i < 20000; ++i) simulation.step();
  EXPECT_LE(largest, 1e-11 * start);
  EXPECT_TRUE(ledger_closes(simulation.energy()));
}

/// The turning pair of the reference with a radial disturbance, so that its length oscillates.
System turning_pair() {
  const analytic::RotatingSpringPair exact{1.0, 1000.0, 2.0, 10.0};
  System system;
  const Vec<2> x = 1.02 * exact.position(0.0);
  const BodyId first = system.add(Particle{.mass = 1.0, .position = x, .velocity = exact.velocity(0.0)});
  const BodyId second = system.add(Particle{.mass = 1.0, .position = -x, .velocity = -exact.velocity(0.0)});
  system.add(SpringDamper{.from = first, .to = second, .stiffness = 1000.0, .free_length = 2.0});
  return system;
}

struct TurningRun {
  double amplitude = 0.0;   // largest |T + V - start|
  double first_mean = 0.0;  // mean of T + V - start over the first and the second half
  double second_mean = 0.0;
  double discretisation = 0.0;  // what the ledger says of it
  double difference = 0.0;      // largest |T + V - start + discretisation|
  double scale = 0.0;
  bool closes = false;
};
TurningRun turn(double step, int steps) {
  Simulation simulation(turning_pair(), TimeStepping{.step = step, .tolerance = 0.0});
  const double start = simulation.energy().total();
  TurningRun run;
  int count = 0;
  simulation.observe([&](const Simulation& now) {
    const double change = now.energy().total() - start;
    run.amplitude = std::max(run.amplitude, std::abs(change));
    (2 * count < steps ? run.first_mean : run.second_mean) += change / (0.5 * steps);
    run.difference =
        std::max(run.difference, std::abs(change + now.energy().flow(EnergyFlow::coupling_discretisation)));
    ++count;
  });
  for (int i = 0; i < steps; ++i) simulation.step();
  run.discretisation = simulation.energy().flow(EnergyFlow::coupling_discretisation);
  run.scale = simulation.energy().scale();
  run.closes = static_cast<bool>(ledger_closes(simulation.energy()));
  return run;
}

TEST(SpringPair, TurningPairHasBoundedEnergyErrorWithoutDrift) {
  const TurningRun run = turn(1e-3, 100000);
  // The error oscillates with the length of the spring. Without drift the means of the two halves agree but
  // for the part of one oscillation that they do not share: one period of 131 steps in 50,000.
  EXPECT_GT(run.amplitude, 1e-6);
  EXPECT_LE(std::abs(run.second_mean - run.first_mean), run.amplitude * 131.0 / 50000.0);
  EXPECT_LE(run.amplitude, 1e-3 * run.scale);
  // All of it stands in its line of the ledger, at every step.
  EXPECT_TRUE(run.closes);
  EXPECT_LE(run.difference, 1e3 * eps * run.scale);
}

TEST(SpringPair, TurningPairEnergyErrorIsOfSecondOrder) {
  std::vector<double> steps, amplitudes;
  for (const double step : {2e-3, 1e-3, 5e-4, 2.5e-4}) {
    steps.push_back(step);
    amplitudes.push_back(turn(step, static_cast<int>(5.0 / step)).amplitude);
  }
  // The next term of the series in h^2 is (h w)^2/10 < 1e-3 of the first; the maximum over discrete times
  // misses the peak by less than (h w)^2/8 of it.
  EXPECT_NEAR(analytic::slope(steps, amplitudes), 2.0, 5e-3);
}

}  // namespace
