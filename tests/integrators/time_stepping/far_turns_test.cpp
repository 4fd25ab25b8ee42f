// Pendulums in steps within which they turn far: a step is a motion, or an error.

#include <carom/carom.h>

#include "tests/integrators/throws.h"
#include "tests/shares.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace {

using namespace carom;
using namespace carom::planar;

constexpr double length = 0.3, mass = 1.0, gravity = 9.81;  // [m, kg, m/s^2]
constexpr double weight_energy = mass * gravity * length;   // between its lowest and its highest place [J]
const double unit = std::sqrt(length / gravity);            // of time [s]

// Fewer steps and angles with sanitizers.
constexpr double part_apart = carom_test::usual_or(0.05, 0.15), angle_apart = carom_test::usual_or(0.1, 0.2);

/// A rod that hangs at its end, at an angle from the horizontal [rad].
System pendulum(double angle) {
  System system;
  system.add(Gravity{{0.0, -gravity}});
  const BodyId rod =
      system.add(RigidBody{.mass = {mass, mass * length * length / 12.0},
                           .position = {0.5 * length * std::cos(angle), 0.5 * length * std::sin(angle)},
                           .angle = angle},
                 "rod");
  system.add(Revolute{.from = {ground}, .to = {rod, {-0.5 * length, 0.0}}}, "pivot");
  return system;
}

struct Outcomes {
  int made = 0, failed = 0;
  double largest_gain = 0.0;  // in one step, of the weight's energy
  std::string errors;
};

Outcomes run(double step, ForceRule rule) {
  constexpr int steps = 40;
  Outcomes seen;
  for (double angle = -1.5; angle < 1.5; angle += angle_apart) {
    Simulation simulation(pendulum(angle), TimeStepping{.step = step, .force_rule = rule});
    double before = simulation.energy().total();
    try {
      for (int i = 0; i < steps; ++i) {
        simulation.step();
        ++seen.made;
        const double now = simulation.energy().total();
        seen.largest_gain = std::max(seen.largest_gain, (now - before) / weight_energy);
        before = now;
      }
    } catch (const SolverError& error) {
      ++seen.failed;
      seen.errors = error.what();
      EXPECT_EQ(simulation.energy().total(), before);
      EXPECT_FALSE(error.failure().parts.empty()) << error.what();
      EXPECT_GT(error.failure().suggested_step, 0.0) << error.what();
    }
  }
  return seen;
}

TEST(FarTurns, StepsThatAreMadeAreMotions) {
  for (double part = 0.1; part < 1.6; part += part_apart) {
    const Outcomes seen = run(part * unit, ForceRule::trapezoidal);
    // The error of a step grows with its third power: 0.11 at 0.65, and farther turns are mostly refused.
    EXPECT_LE(seen.largest_gain, 0.15) << part;
    if (part < 0.46) {
      EXPECT_EQ(seen.failed, 0) << part << ": " << seen.errors;
    }
    if (part > 0.74) {
      EXPECT_GT(seen.failed, 0) << part;
    }
  }
}

TEST(FarTurns, EnergyMomentumKeepsTheEnergyOrRefuses) {
  for (double part = 0.1; part < 1.6; part += part_apart) {
    const Outcomes seen = run(part * unit, ForceRule::energy_momentum);
    // What the tolerance of 1e-12 m leaves, times forces of up to five times the weight.
    EXPECT_LE(seen.largest_gain, 2e-11) << part;
    if (part < 0.56) {
      EXPECT_EQ(seen.failed, 0) << part << ": " << seen.errors;
    }
  }
}

TEST(FarTurns, AnErrorTellsHowFarAndWhatWouldDo) {
  // From rest, so that only the step says how far the rod would turn.
  Simulation simulation(pendulum(-0.3), TimeStepping{.step = unit});
  EXPECT_THROWS(SolverError, simulation.step(), "joints turn too far within the step",
                "rigid body 'rod' would be moved back onto them by",
                "allowed: a step in which they turn less, for instance " + to_text(0.5 * unit) + " s");
  EXPECT_EQ(simulation.time(), 0.0);
  simulation.switch_to(TimeStepping{.step = 0.5 * unit});
  EXPECT_NO_THROW(simulation.run_until(1.0));
}

}  // namespace
