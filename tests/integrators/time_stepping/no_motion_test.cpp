// Ends of steps that no motion leads to: refused; and mechanisms at rest, whose numbers are rounding: not.

#include <carom/carom.h>

#include "tests/shares.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace {

using namespace carom;
using namespace carom::planar;

constexpr double gravity = 9.81;  // [m/s^2]

TEST(NoMotion, ABalancedBarOnAPinRests) {
  for (int i = 0; i < 200; ++i) {
    for (const double step : {1e-3, 3e-3, 1e-2, 3e-2}) {
      System system;
      system.add(Gravity{{0.0, -gravity}});
      const BodyId bar = system.add(RigidBody{.mass = rod(0.5 + 0.01 * i, 2.0)}, "bar");
      system.add(Revolute{.from = {ground}, .to = {bar}});
      Simulation simulation(system, TimeStepping{.step = step});
      ASSERT_NO_THROW(simulation.run_until(30 * step)) << i << " " << step;
    }
  }
}

TEST(NoMotion, AWeightAtTheOriginRestsOnItsRod) {
  for (const ForceRule rule : {ForceRule::trapezoidal, ForceRule::energy_momentum}) {
    System system;
    system.add(Gravity{{0.0, -gravity}});
    const BodyId weight = system.add(Particle{.mass = 1.0 / 3.0});
    system.add(Rod{.from = {ground, {0.0, 1.0 / 3.0}}, .to = {weight}});
    Simulation simulation(system, TimeStepping{.step = 1e-3, .force_rule = rule});
    EXPECT_NO_THROW(simulation.run_until(1.0));
    EXPECT_LE(simulation.state().position(weight).norm(), 1e-12);  // the tolerance of the iteration
  }
}

/// A sledge, and a bar on it by a bushing, which is not strained.
System sledge(double stiffness) {
  const Vec<2> guide(std::cos(0.3), std::sin(0.3));
  System system;
  system.add(Gravity{{0.0, -gravity}});
  const BodyId body = system.add(RigidBody{.mass = rod(1.0, 1.0)}, "sledge");
  system.add(Prismatic{.from = {ground}, .to = {body}, .axis = guide});
  const BodyId bar = system.add(
      RigidBody{.mass = rod(1.0, 1.0), .position = Vec<2>(0.3, 0.0) + 0.5 * guide, .angle = 0.3}, "bar");
  Bushing bushing{.from = {body, {0.3, 0.0}}, .to = {bar, {-0.5, 0.0}}, .rest = {0.0, 0.0, 0.3}};
  bushing.stiffness(0, 0) = bushing.stiffness(1, 1) = stiffness;
  bushing.stiffness(2, 2) = 0.01 * stiffness;
  system.add(bushing);
  return system;
}

TEST(NoMotion, EnergyMomentumDoesNotEndAtTheEndsOfTurns) {
  // Half a turn in a step, however fast, is one more solution of the equations of the mean rule.
  int made = 0, runs = 0;
  for (double stiffness = 1e3; stiffness < 2e9; stiffness *= carom_test::usual_or(1.5, 5.0)) {
    for (const double step : {0.005, 0.01, 0.02, 0.05, 0.1, 0.2}) {
      ++runs;
      Simulation simulation(sledge(stiffness),
                            TimeStepping{.step = step, .force_rule = ForceRule::energy_momentum});
      const auto height = [&] { return std::abs(simulation.energy().potential()); };
      try {
        for (int i = 0; i < 40; ++i) {
          simulation.step();
          ++made;
          // Weights of 1 kg each that slide down: not more than they lose.
          ASSERT_LE(simulation.energy().kinetic(), 20.0 + 2.0 * height()) << stiffness << " " << step;
        }
      } catch (const SolverError& error) {
        EXPECT_FALSE(error.failure().parts.empty()) << error.what();
      }
    }
  }
  EXPECT_GT(made, runs * 20);  // of runs * 40
}

TEST(NoMotion, JointsOfADrivenSliderAreClosedAfterEveryStepThatIsMade) {
  int made = 0;
  constexpr int apart = carom_test::usual_or(1, 5);
  for (int i = 0; i < 200; i += apart) {
    const double speed = 20.0 + 0.9 * i, angle = 0.03 * i, spin = -30.0 + 0.3 * i, step = 0.016;
    System system;
    system.add(Gravity{{0.0, -gravity}});
    const BodyId slider = system.add(RigidBody{.mass = rod(1.0, 1.0)}, "slider");
    const JointId guide =
        system.add(Prismatic{.from = {ground, {0.2, 0.0}}, .to = {slider, {0.2, 0.0}}, .axis = {1.0, angle}});
    const BodyId bar =
        system.add(RigidBody{.mass = rod(1.0, 1.0),
                             .position = Vec<2>(0.5, 0.0) + 0.5 * Vec<2>(std::cos(angle), std::sin(angle)),
                             .angle = angle,
                             .spin = spin},
                   "bar");
    system.add(Revolute{.from = {slider, {0.5, 0.0}}, .to = {bar, {-0.5, 0.0}}});
    system.add(Driver{.joint = guide, .position = [speed](double time) { return speed * time; }});
    Simulation simulation(system, TimeStepping{.step = step});
    const auto end_of = [&](BodyId body, double along) {
      const double at = simulation.state().angle(body);
      return Vec<2>(simulation.state().position(body) + along * Vec<2>(std::cos(at), std::sin(at)));
    };
    try {
      for (int k = 0; k < 60; ++k) {
        simulation.step();
        ++made;
        const double way = std::max(1.0, speed * simulation.time());
        ASSERT_LE((end_of(slider, 0.5) - end_of(bar, -0.5)).norm(), 2e-8 * way) << i << " " << k;
      }
    } catch (const SolverError&) {  // steps of some metres are too long for some
    }
  }
  EXPECT_GT(made, 200 / apart * 10);
}

TEST(NoMotion, FrictionInJointsHoldsWhatHardlyTurns) {
  // Rates die out to where doubles have few digits: that is no problem without solution.
  for (double spin = 1e-290; spin > 1e-322; spin *= 0.7) {
    System system;
    const BodyId a = system.add(RigidBody{.mass = rod(0.775196, 1.0), .spin = -0.2 * spin});
    const JointId to_ground = system.add(Revolute{.from = {ground}, .to = {a}});
    system.add(JointFriction{.joint = to_ground, .bound = 0.381788});
    const BodyId b = system.add(RigidBody{.mass = rod(0.560282, 1.0), .spin = spin});
    const JointId to_a = system.add(Revolute{.from = {a}, .to = {b}});
    system.add(JointFriction{.joint = to_a, .bound = 0.236303});
    Simulation simulation(system, TimeStepping{.step = 0.00238509});
    ASSERT_NO_THROW(simulation.run_until(0.02)) << spin;
    EXPECT_LE(std::abs(simulation.state().spin(b)), spin);
  }
}

}  // namespace
