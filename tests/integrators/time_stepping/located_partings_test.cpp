// Located impacts where contacts part: at the start of a step, within it, and after more impacts than are
// allowed.

#include "tests/integrators/time_stepping/located_runs.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::located;

// A particle thrown up from the floor, by v = 4 h, comes back in the step of length h: at g = 10 after 0.8 h,
// with the speed 4 h; then it rebounds with e 4 h, and flies on for 0.2 h, or lies.
TEST(LocatedPartings, WhatIsThrownUpComesBackInTheStep) {
  constexpr double h = 0.1, g = 10.0, speed = 4.0 * h, left = 0.2 * h;
  for (const double e : {0.0, 0.9}) {
    System system;
    system.add(Gravity{{0.0, -g}});
    system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = 0.0, .normal_restitution = e});
    const BodyId body = system.add(Particle{.mass = 1.0, .position = {0.0, 0.0}, .velocity = {0.0, speed}});
    Simulation simulation(system, located(h));
    const StepReport report = simulation.step();
    const double after = e * speed;
    const double height = e > 0.0 ? after * left - 0.5 * g * left * left : 0.0;
    const double rate = e > 0.0 ? after - g * left : 0.0;
    constexpr double rounding = 1e-15;  // of numbers below 1
    EXPECT_NEAR(simulation.state().position(body)[1], height, rounding);
    EXPECT_NEAR(simulation.state().velocity(body)[1], rate, rounding);
    EXPECT_NEAR(report.contacts.front().time, 0.8 * h, rounding);
    EXPECT_EQ(simulation.statistics().impacts, 1);
    EXPECT_TRUE(carom_test::ledger_closes(simulation.energy()));
  }
}

TEST(LocatedPartings, WhatHasLeftTheCeilingIsHitByTheFloorAlone) {
  for (const double e : {0.5, 1.0}) {
    System system;
    const Surface law{.friction = 0.0, .normal_restitution = e};
    system.add(HalfPlane{.normal = {0.0, 1.0}}, law);
    system.add(HalfPlane{.point = {0.0, 1.0}, .normal = {0.0, -1.0}}, law);
    const BodyId body = system.add(Particle{.mass = 1.0, .position = {0.0, 1.0}, .velocity = {0.0, -4.0}});
    Simulation simulation(system, located(0.3));
    EXPECT_EQ(simulation.step().contacts.size(), 1U);
    EXPECT_NEAR(simulation.state().velocity(body)[1], 4.0 * e, 1e-15);
    EXPECT_NEAR(simulation.state().position(body)[1], 4.0 * e * (0.3 - 0.25), 1e-15);
  }
}

TEST(LocatedPartings, TwoContactsClosedToRoundingAreOneImpact) {
  const auto spin = [](double gap, const Mode& mode) {
    System system;
    const Surface law{.friction = 0.1, .normal_restitution = 0.0};
    system.add(HalfPlane{.normal = {0.0, 1.0}}, law);
    system.add(HalfPlane{.normal = {1.0, 0.0}}, law);
    const BodyId body = system.add(RigidBody{
        .mass = disc(1.0, 0.125), .position = {0.125 + gap, 0.125}, .velocity = {-1.6, -2.1}, .spin = 6.4});
    system.add(Disc{.body = body, .radius = 0.125});
    Simulation simulation(system, mode);
    simulation.run_until(2e-3);
    return simulation.state().spin(body);
  };
  const double exact = spin(0.0, EventDriven{});
  for (const double gap : {0.0, 1e-16, 1e-14, 5e-13}) {
    EXPECT_NEAR(spin(gap, located(1e-3)), exact, 1e-12) << gap;  // spins and gaps are rounded at 1
  }
}

// Without gravity, e = 0 and friction a bar that falls onto one end and then the other lies on the plane. Of
// second order; an end that parts within the step is hit again by none of the other's impacts.
TEST(LocatedPartings, ABarThrownOntoAPlaneLiesOnIt) {
  constexpr double h = 1e-3;
  constexpr double error = 2e-2 * h * h;  // [m], 10 times what is found; it was 400 h^2
  int lies = 0;
  for (int i = 0; i < 200; ++i) {
    const double angle = 0.05 + 0.005 * i;
    System system;
    system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = 0.0, .normal_restitution = 0.0});
    const BodyId body = system.add(RigidBody{.mass = rod(1.0, 0.3),
                                             .position = {0.0, 0.15 * std::sin(angle) + 1e-3},
                                             .angle = angle,
                                             .velocity = {0.0, -5.0}});
    system.add(Segment{.body = body, .from = {-0.15, 0.0}, .to = {0.15, 0.0}});
    const State end = carom_test::run(system, located(h), 0.5);
    if (std::abs(end.spin(body)) > 1e-6 || std::abs(end.velocity(body)[1]) > 1e-6) continue;
    ++lies;
    EXPECT_LT(std::abs(end.position(body)[1]), error) << "angle " << angle;
  }
  EXPECT_GT(lies, 100);
}

class CoarseSteps : public testing::TestWithParam<std::tuple<double, int>> {};

// e = 1 and no friction, a bar that is hit many times in a step: no energy comes from nowhere.
TEST_P(CoarseSteps, GainNothing) {
  const auto [step, most_impacts] = GetParam();
  for (int i = 0; i < 20; ++i) {
    System system;
    system.add(BoxInside{.lower = {-1.0, -1.0}, .upper = {1.0, 1.0}},
               Surface{.friction = 0.0, .normal_restitution = 1.0});
    const BodyId body = system.add(RigidBody{
        .mass = rod(1.0, 0.4), .angle = 0.3 * i, .velocity = {3.0 + 0.2 * i, 2.0}, .spin = 1.0 + 0.7 * i});
    system.add(Segment{.body = body, .from = {-0.2, 0.0}, .to = {0.2, 0.0}});
    TimeStepping mode = located(step);
    mode.most_impacts = most_impacts;
    Simulation simulation(system, mode);
    const double before = simulation.energy().total();
    for (double t = 0.0; t < 4.0; t += step) {
      simulation.step();
      ASSERT_LT(simulation.energy().total(), before * (1.0 + 1e-9)) << "at " << t << " s, start " << i;
    }
    EXPECT_TRUE(carom_test::ledger_closes(simulation.energy()));
    // Where it does not rebound energy is lost, and that is told.
    const bool lost = simulation.energy().total() < before * (1.0 - 1e-9);
    EXPECT_EQ(lost, simulation.statistics().cut_sequences > 0) << "start " << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Steps, CoarseSteps,
                         testing::Combine(testing::Values(0.01, 0.05, 0.2), testing::Values(1, 2, 10)));

// Energy from a lasting contact on curved ground is an error of the step; where the body turns too far the
// contact acts along its direction at the start.
TEST(LocatedPartings, ABarThatSlidesOverAPegGainsLittleInAStep) {
  for (const double step : {0.05, 0.02, 0.01}) {
    double largest = 0.0;
    for (int i = 0; i < 40; ++i) {
      System system;
      system.add(Peg{.radius = 0.3}, Surface{.friction = 0.0, .normal_restitution = 0.0});
      const BodyId body = system.add(RigidBody{.mass = rod(1.0, 0.4),
                                               .position = {0.02 * i - 0.4, 0.35 + 0.005 * i},
                                               .angle = 0.1 * i,
                                               .velocity = {1.0, -2.0},
                                               .spin = 4.0});
      system.add(Segment{.body = body, .from = {-0.2, 0.0}, .to = {0.2, 0.0}});
      Simulation simulation(system, located(step));
      for (double t = 0.0; t < 1.0; t += step) {
        const double before = simulation.energy().total();
        simulation.step();
        largest = std::max(largest, simulation.energy().total() / before - 1.0);
      }
    }
    EXPECT_LT(largest, 0.021) << step;  // a hundredth of the energies before and after
  }
}

}  // namespace
