// Both modes on mechanisms that are driven or stopped, and changes of the mode in between.

#include "tests/integrators/joint_run.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace {

using namespace joint_scenes;

Scene driven_slider_crank() {
  const double w = 150.0;
  Scene scene = slider_crank();
  scene.system.add(Driver{.joint = scene.system.joint("main bearing"),
                          .position = [w](double t) { return w * t + 0.3 * (1.0 - std::cos(40.0 * t)); },
                          .velocity = [w](double t) { return w + 12.0 * std::sin(40.0 * t); },
                          .acceleration = [](double t) { return 480.0 * std::cos(40.0 * t); }});
  // A rod that swings freely from the slider.
  const BodyId slider = scene.bodies[2];
  const BodyId swing =
      scene.system.add(RigidBody{.mass = rod(0.1, 0.2), .position = {0.459, -0.1}, .angle = -quarter});
  scene.system.add(Revolute{.from = slider, .to = {swing, {-0.1, 0.0}}});
  scene.bodies.push_back(swing);
  return scene;
}

void driven_mechanism_has_order_two(const std::vector<double>& steps) {
  CrossCheckOptions options;
  options.end = 0.05;
  options.steps = steps;
  options.event_driven.relative_tolerance = 1e-12;
  options.event_driven.absolute_tolerance = 1e-13;
  const CrossCheck check = cross_check(driven_slider_crank().system, options);
  // The second term of the error is (h w)^2/10 of the first, 2e-5.
  EXPECT_NEAR(check.position_order, 2.0, 0.01);
  EXPECT_NEAR(check.velocity_order, 2.0, 0.01);
}

TEST(JointsInBothModes, DrivenMechanismOrderTwo) {
  driven_mechanism_has_order_two({1e-4, 6.25e-5, 5e-5, 4e-5, 2.5e-5});
}

TEST(JointsInBothModesLong, DrivenMechanismOrderTwo) {
  driven_mechanism_has_order_two({1e-4, 5e-5, 2.5e-5, 1.25e-5, 6.25e-6});
}

/// A double pendulum whose pins are stopped, with a spring.
Scene stopped_pendulum() {
  Scene scene = rod_pendulum(2);
  const std::vector<JointId> pins = scene.system.joints();
  scene.system.add(Stop{.joint = pins[0], .lower = -1.0, .restitution = 0.6});
  scene.system.add(Stop{.joint = pins[1], .lower = -0.7, .upper = 0.5, .restitution = 0.6});
  scene.system.add(
      TorsionalSpring{.from = scene.bodies[0], .to = scene.bodies[1], .stiffness = 8.0, .damping = 0.2});
  return scene;
}

TEST(JointsInBothModes, StoppedMechanismOrderOneInTheMean) {
  CrossCheckOptions options;
  options.end = 1.0;
  options.steps = spread_steps(4e-3, 1.25e-4, 20);
  options.event_driven.relative_tolerance = 1e-11;
  const Scene scene = stopped_pendulum();
  Simulation exact(scene.system, options.event_driven);
  exact.run_until(options.end);
  ASSERT_GE(exact.statistics().impacts, 2);
  const CrossCheck check = cross_check(scene.system, options);
  // As in tests/analysis: delays of impacts are as good as random between nothing and a step.
  EXPECT_NEAR(check.position_order, 1.0, 0.5);
  EXPECT_NEAR(check.velocity_order, 1.0, 0.5);
  EXPECT_LT(check.levels.back().position_error, 0.2 * check.levels.front().position_error);
}

/// The joints of the present state, after a change of the mode.
void expect_closed(const Simulation& simulation) {
  JointCheck check;
  check.look(simulation);
  EXPECT_LE(check.gap, gap_limit);
  EXPECT_LE(check.speed, speed_limit);
}

TEST(JointsModeSwitch, InFlightNothingIsLost) {
  const Scene scene = windows(2);
  const auto data =
      carom_test::reference_data("smooth_planar.json").at("A02_double_fourbar_N2").at("reference").at("2");
  const double expected = data.at("phi").get<double>();
  std::vector<double> errors;
  for (const double step : {2e-3, 1e-3}) {
    Simulation simulation(scene.system, fine());
    for (int i = 1; i <= 4; ++i) {
      simulation.run_until(0.5 * i - 0.25);
      const State before = simulation.state();
      simulation.switch_to(TimeStepping{.step = step});
      EXPECT_EQ(simulation.state().q, before.q);
      EXPECT_EQ(simulation.state().v, before.v);
      simulation.run_until(0.5 * i);
      simulation.switch_to(fine());
      expect_closed(simulation);
    }
    EXPECT_NEAR(simulation.energy().flow(EnergyFlow::mode_switch), 0.0, 1e-12);
    EXPECT_NEAR(simulation.energy().residual(), 0.0, 1e-10);
    errors.push_back(std::abs(quarter - simulation.state().angle(scene.bodies[0]) - expected));
  }
  EXPECT_LE(errors[1], 1e-4);
  EXPECT_NEAR(errors[0] / errors[1], 4.0, 0.2);
}

TEST(JointsModeSwitch, ADrivenMechanismGoesOn) {
  const Scene scene = driven_slider_crank();
  Simulation whole(scene.system, fine());
  whole.run_until(0.03);
  std::vector<double> errors;
  for (const double step : {2e-5, 1e-5}) {
    Simulation simulation(scene.system, TimeStepping{.step = step});
    simulation.run_until(0.01);
    simulation.switch_to(fine());
    expect_closed(simulation);
    simulation.run_until(0.02);
    simulation.switch_to(TimeStepping{.step = step});
    simulation.run_until(0.03);
    EXPECT_NEAR(simulation.energy().residual(), 0.0, 1e-9);
    double largest =
        std::abs(simulation.energy().flow(EnergyFlow::external) - whole.energy().flow(EnergyFlow::external));
    for (std::size_t i = 0; i < whole.state().q.size(); ++i) {
      largest = std::max(largest, std::abs(simulation.state().q[i] - whole.state().q[i]));
    }
    errors.push_back(largest);
  }
  // A limit that were off by a thirtieth of the second error would show.
  EXPECT_NEAR(errors[0] / errors[1], 4.0, 0.1);
}

/// A rod on a pin that leans with its tip on a floor, and a second one on it that leans on its stop.
Scene leaning() {
  Scene scene;
  System& system = scene.system;
  system.add(Gravity{{0.0, -g}});
  const double angle = -0.5;
  const Vec<2> along(std::cos(angle), std::sin(angle));
  const BodyId bar = system.add(RigidBody{.mass = rod(1.0, 1.0), .position = 0.5 * along, .angle = angle});
  const BodyId top = system.add(RigidBody{.mass = rod(1.0, 0.6), .position = 0.5 * along + Vec<2>(0.3, 0.0)});
  system.add(Revolute{.from = ground, .to = {bar, {-0.5, 0.0}}});
  const JointId pin = system.add(Revolute{.from = bar, .to = {top, {-0.3, 0.0}}});
  system.add(Stop{.joint = pin, .lower = 0.0, .restitution = 0.4});
  system.add(Point{.body = bar, .position = {0.5, 0.0}});
  system.add(HalfPlane{.point = along, .normal = {0.0, 1.0}},
             Surface{.friction = 0.3, .normal_restitution = 0.4});
  scene.bodies = {bar, top};
  return scene;
}

TEST(JointsModeSwitch, ClosedContactsAndStopsStayClosed) {
  const Scene scene = leaning();
  Simulation simulation(scene.system, fine());
  const State start = simulation.state();
  const double step = 1e-3;
  for (int i = 1; i <= 3; ++i) {
    simulation.run_until(0.2 * i - 0.1);
    simulation.switch_to(TimeStepping{.step = step});
    simulation.run_until(0.2 * i);
    simulation.switch_to(fine());
    expect_closed(simulation);
  }
  simulation.run_until(1.0);
  for (std::size_t i = 0; i < start.q.size(); ++i) {
    EXPECT_NEAR(simulation.state().q[i], start.q[i], 1e-4) << i;  // some h^2 g at every change
  }
  for (const double v : simulation.state().v) EXPECT_NEAR(v, 0.0, 1e-12);
  EXPECT_NEAR(simulation.energy().residual(), 0.0, 1e-10);
  expect_closed(simulation);
}

TEST(JointsModeSwitch, AStopThatIsPassedIsResolvedAndMovedOut) {
  // Time stepping looks at the middle of a step: the slider stands beyond its stop and goes on.
  const double e = 0.5;
  Scene scene;
  System& system = scene.system;
  const BodyId block = system.add(RigidBody{.mass = box(2.0, 0.1, 0.1), .velocity = {3.0, 0.0}});
  const JointId slide = system.add(Prismatic{.from = ground, .to = block, .axis = {1.0, 0.0}});
  const BodyId hanging =
      system.add(RigidBody{.mass = rod(1.0, 1.0), .position = {0.5, 0.0}, .velocity = {3.0, 0.0}});
  system.add(Revolute{.from = block, .to = {hanging, {-0.5, 0.0}}});
  system.add(Stop{.joint = slide, .upper = 0.05, .restitution = e});
  Simulation simulation(system, TimeStepping{.step = 1e-2});
  simulation.run_until(0.02);
  const double beyond = simulation.state().coordinate(slide) - 0.05, rate = simulation.state().rate(slide);
  ASSERT_GT(beyond, 1e-3);
  ASSERT_GT(rate, 2.0);
  const double before = simulation.energy().total();
  simulation.switch_to(EventDriven{});
  EXPECT_NEAR(simulation.state().rate(slide), -e * rate, 1e-12);
  EXPECT_NEAR(simulation.state().coordinate(slide), 0.05, 1e-14);
  // The rod is in line with the slide: all 3 kg are thrown back.
  EXPECT_NEAR(simulation.state().velocity(hanging)[0], -e * rate, 1e-12);
  EXPECT_NEAR(simulation.energy().flow(EnergyFlow::mode_switch), 0.5 * 3.0 * rate * rate * (1.0 - e * e),
              1e-11);
  EXPECT_NEAR(before - simulation.energy().total(), 0.5 * 3.0 * rate * rate * (1.0 - e * e), 1e-11);
  expect_closed(simulation);
}

}  // namespace
