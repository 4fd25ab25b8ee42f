// Drivers in the event-driven mode; both modes on mechanisms that are driven or stopped, and changes of the
// mode in between.

#include "tests/integrators/joint_run.h"

#include "tests/integrators/throws.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace {

using namespace joint_scenes;
using carom_test::events_of;

/// A rod of 1 kg and 1 m pinned to the origin and swung as a sin(w t), with a damper at its pin.
struct Swing : Scene {
  static constexpr double a = 0.8, w = 5.0;
  JointId pin, driver;

  explicit Swing(double damping) : Scene(rod_pendulum(1)), pin(system.joints()[0]) {
    driver = system.add(Driver{.joint = pin,
                               .position = [](double t) { return a * std::sin(w * t); },
                               .velocity = [](double t) { return a * w * std::cos(w * t); },
                               .acceleration = [](double t) { return -a * w * w * std::sin(w * t); }});
    system.add(TorsionalSpring{.from = ground, .to = bodies[0], .damping = damping});
  }
};

TEST(DriversEventDriven, PrescribeTheAngle) {
  const Swing scene(0.0);
  WatchedRun run(scene);
  double angle = 0.0, spin = 0.0;
  run.simulation.observe([&](const Simulation& now) {
    const double t = now.time();
    angle = std::max(angle, std::abs(now.state().coordinate(scene.pin) - Swing::a * std::sin(Swing::w * t)));
    spin =
        std::max(spin, std::abs(now.state().rate(scene.pin) - Swing::a * Swing::w * std::cos(Swing::w * t)));
  });
  run.simulation.run_until(3.0);
  EXPECT_LE(angle, 1e-14);
  EXPECT_LE(spin, 1e-13);
  EXPECT_EQ(run.simulation.mobility().degrees_of_freedom, 0U);
}

TEST(DriversEventDriven, ExternalWorkIsWhatEnergyGainsAndDampersTake) {
  // The damper takes the integral of c (a w cos wt)^2.
  for (const double c : {0.0, 0.3}) {
    const Swing scene(c);
    WatchedRun run(scene);
    const double before = run.simulation.energy().total();
    for (const double t : {0.37, 1.0, 2.2}) {
      run.simulation.run_until(t);
      const EnergyLedger& energy = run.simulation.energy();
      const double x = Swing::a * std::sin(Swing::w * t), v = Swing::a * Swing::w * std::cos(Swing::w * t);
      const double aw = Swing::a * Swing::w;
      const double lost = c * aw * aw * (0.5 * t + std::sin(2.0 * Swing::w * t) / (4.0 * Swing::w));
      const double stored = v * v / 6.0 + 0.5 * g * std::sin(x);
      EXPECT_NEAR(energy.total(), stored, 1e-12);
      EXPECT_NEAR(energy.flow(EnergyFlow::dashpot), lost, 1e-10);
      EXPECT_NEAR(energy.flow(EnergyFlow::external), stored - before + lost, 1e-10);
    }
  }
}

TEST(DriversEventDriven, MomentOfTheDriver) {
  // I x'' + c x' + m g (l/2) cos(x) about the pin.
  const Swing scene(0.3);
  Simulation simulation(scene.system, fine());
  for (const double t : {0.37, 1.0, 2.2}) {
    simulation.run_until(t);
    const double x = Swing::a * std::sin(Swing::w * t), v = Swing::a * Swing::w * std::cos(Swing::w * t);
    EXPECT_NEAR(simulation.reaction(scene.driver).moment,
                -Swing::w * Swing::w * x / 3.0 + 0.3 * v + 0.5 * g * std::cos(x), 1e-11);
  }
}

TEST(DriversEventDriven, BreaksAreMetExactly) {
  // At rest, then under constant acceleration, then at constant speed; the rates are differences.
  const double t1 = 0.313, t2 = 0.729, rate = 6.0;
  const auto position = [=](double t) {
    if (t < t1) return 0.0;
    if (t < t2) return 0.5 * rate * (t - t1) * (t - t1);
    return rate * (t2 - t1) * (t - 0.5 * (t1 + t2));
  };
  Scene scene = rod_pendulum(1);
  const JointId pin = scene.system.joints()[0];
  scene.system.add(Driver{.joint = pin, .position = position, .breaks = {t1, t2}});
  // A free rod on it, which feels the accelerations.
  const BodyId tip = scene.system.add(RigidBody{.mass = rod(1.0, 0.5), .position = {1.25, 0.0}});
  scene.system.add(Revolute{.from = {scene.bodies[0], {0.5, 0.0}}, .to = {tip, {-0.25, 0.0}}});
  const auto run_with = [&](double tolerance) {
    Simulation simulation(scene.system,
                          EventDriven{.relative_tolerance = tolerance, .absolute_tolerance = tolerance});
    JointCheck check(simulation);
    simulation.run_until(1.2);
    EXPECT_LE(check.gap, gap_limit);
    // What differences leave of the rates.
    EXPECT_LE(check.speed, speed_limit);
    const auto breaks = events_of(simulation, EventKind::law_break);
    EXPECT_EQ(breaks.size(), 2U);
    if (breaks.size() == 2) {
      EXPECT_EQ(breaks[0].time, t1);
      EXPECT_EQ(breaks[1].time, t2);
    }
    EXPECT_NEAR(simulation.state().coordinate(pin), position(1.2), 1e-12);
    return simulation.state().angle(tip);
  };
  EXPECT_NEAR(run_with(1e-8), run_with(1e-11), 1e-6);
}

TEST(DriversEventDriven, AJumpOfTheRateIsAnImpulseOfTheDriver) {
  // From rest to 2 rad/s at once: I w^2/2 = 2/3 J.
  Scene scene = rod_pendulum(1);
  const JointId pin = scene.system.joints()[0];
  const double t1 = 0.3, rate = 2.0;
  const JointId driver = scene.system.add(Driver{
      .joint = pin, .position = [=](double t) { return t < t1 ? 0.0 : rate * (t - t1); }, .breaks = {t1}});
  WatchedRun run(scene);
  run.simulation.run_until(t1);
  bool told = false;
  for (const JointImpulse& entry : run.simulation.report().joint_impulses) {
    if (entry.joint != driver) continue;
    told = true;
    EXPECT_NEAR(entry.impulse.moment, rate / 3.0, 1e-12);
  }
  EXPECT_TRUE(told);
  const double end = 0.5, angle = rate * (end - t1);
  run.simulation.run_until(end);
  EXPECT_NEAR(run.simulation.state().coordinate(pin), angle, 1e-13);
  EXPECT_NEAR(run.simulation.energy().flow(EnergyFlow::external), 2.0 / 3.0 + 0.5 * g * std::sin(angle),
              1e-9);
  EXPECT_NEAR(run.simulation.energy().flow(EnergyFlow::projection), 0.0, 1e-9);
}

/// A block that a driver starts along a vertical slide at 0.3 s, and a level rod pinned to it with an end on
/// the floor, on which a torque presses it.
struct Lifted : Scene {
  explicit Lifted(double speed, double pinned_at) {
    system.add(Gravity{{0.0, -g}});
    const BodyId block = system.add(RigidBody{.mass = box(1.0, 0.1, 0.1)});
    const BodyId bar = system.add(RigidBody{.mass = rod(1.0, 1.0), .position = {-pinned_at, 0.0}});
    const JointId slide = system.add(Prismatic{.from = ground, .to = block, .axis = {0.0, 1.0}});
    system.add(Revolute{.from = block, .to = {bar, {pinned_at, 0.0}}});
    system.add(Point{.body = bar, .position = {0.5, 0.0}});
    system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = 0.0, .normal_restitution = 0.5});
    system.add(AppliedTorque{.on = bar, .torque = [pinned_at](double) { return -0.1 - g * pinned_at; }});
    system.add(Driver{.joint = slide,
                      .position = [speed](double t) { return t < 0.3 ? 0.0 : speed * (t - 0.3); },
                      .breaks = {0.3}});
    bodies = {block, bar};
  }
};

TEST(DriversEventDriven, AJumpPartsAContactOrPressesIt) {
  const double after = 1e-3;
  {  // Lifted at its middle the rod goes up as it is; only the torque turns it: nothing holds its end.
    const Lifted scene(1.0, 0.0);
    WatchedRun run(scene);
    run.simulation.run_until(0.3 + after);
    EXPECT_NEAR(run.simulation.state().spin(scene.bodies[1]), -0.1 * 12.0 * after, 1e-11);
    EXPECT_EQ(events_of(run.simulation, EventKind::lift_off).size(), 1U);
    EXPECT_EQ(events_of(run.simulation, EventKind::impact).size(), 0U);
  }
  {  // Lifted at -0.4 its other end is pressed on the floor and stays: it turns about it.
    const Lifted scene(1.0, -0.4);
    WatchedRun run(scene);
    run.simulation.run_until(0.3 + after);
    EXPECT_NEAR(run.simulation.state().spin(scene.bodies[1]), -1.0 / 0.9, 1e-5);  // (w t)^2
    EXPECT_EQ(events_of(run.simulation, EventKind::lift_off).size(), 0U);
    const auto impacts = events_of(run.simulation, EventKind::impact);
    ASSERT_EQ(impacts.size(), 1U);
    // About the pin, 0.9 P: the spin's and, at a lever of 0.4, that of the centre's 1 - 0.4/0.9 m/s.
    EXPECT_NEAR(impacts[0].impulse[0], (-1.0 / 12.0 / 0.9 + 0.4 * (1.0 - 0.4 / 0.9)) / 0.9, 1e-9);
  }
  // Time stepping agrees: where it is, it is by the way of a step.
  for (const double pinned_at : {0.0, -0.4}) {
    const Lifted scene(1.0, pinned_at);
    Simulation exact(scene.system, fine());
    exact.run_until(0.35);
    for (const double step : {1e-4, 1e-5}) {
      Simulation stepping(scene.system, TimeStepping{.step = step});
      stepping.run_until(0.35);
      EXPECT_NEAR(stepping.state().angle(scene.bodies[1]), exact.state().angle(scene.bodies[1]), 1.2 * step);
    }
  }
}

TEST(DriversEventDriven, WorksInAnImpact) {
  // A slide driven at a constant rate carries a rod that swings down on a floor: the driver's share of the
  // impulse does work, or the account would not close.
  Scene scene;
  scene.system.add(Gravity{{0.0, -g}});
  const BodyId block = scene.system.add(RigidBody{.mass = box(1.0, 0.1, 0.1), .velocity = {0.0, -0.5}});
  const BodyId bar =
      scene.system.add(RigidBody{.mass = rod(1.0, 1.0), .position = {0.5, 0.0}, .velocity = {0.0, -0.5}});
  const JointId slide = scene.system.add(Prismatic{.from = ground, .to = block, .axis = {0.0, 1.0}});
  scene.system.add(Revolute{.from = block, .to = {bar, {-0.5, 0.0}}});
  scene.system.add(Driver{.joint = slide, .position = [](double t) { return -0.5 * t; }});
  scene.system.add(Point{.body = bar, .position = {0.5, 0.0}});
  scene.system.add(HalfPlane{.point = {0.0, -0.8}, .normal = {0.0, 1.0}},
                   Surface{.friction = 0.3, .normal_restitution = 0.5});
  WatchedRun run(scene);
  run.simulation.run_until(0.7);
  EXPECT_GE(run.simulation.statistics().impacts, 1);
}

TEST(DriversEventDriven, IsNamedWhereItPressesAgainstAFloor) {
  Scene scene;
  const BodyId block = scene.system.add(RigidBody{.mass = box(1.0, 0.1, 0.1), .velocity = {0.0, -1.0}});
  const JointId slide = scene.system.add(Prismatic{.from = ground, .to = block, .axis = {0.0, 1.0}});
  scene.system.add(Driver{.joint = slide, .position = [](double t) { return -t; }}, "ram");
  scene.system.add(Point{.body = block, .position = {0.0, -0.05}}, "foot");
  scene.system.add(HalfPlane{.point = {0.0, -0.5}, .normal = {0.0, 1.0}},
                   Surface{.friction = 0.3, .normal_restitution = 0.5});
  Simulation simulation(scene.system, fine());
  EXPECT_THROWS(SolverError, simulation.run_until(1.0), "no solution", "driven by", "ram", "foot");
  EXPECT_LT(simulation.time(), 0.46);
}

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

TEST(JointsInBothModes, DrivenMechanismOrderTwo) {
  CrossCheckOptions options;
  options.end = 0.05;
  options.steps = {1e-4, 5e-5, 2.5e-5, 1.25e-5, 6.25e-6};
  options.event_driven.relative_tolerance = 1e-12;
  options.event_driven.absolute_tolerance = 1e-13;
  const CrossCheck check = cross_check(driven_slider_crank().system, options);
  // The second term of the error is (h w)^2/10 of the first, 2e-5.
  EXPECT_NEAR(check.position_order, 2.0, 0.01);
  EXPECT_NEAR(check.velocity_order, 2.0, 0.01);
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
