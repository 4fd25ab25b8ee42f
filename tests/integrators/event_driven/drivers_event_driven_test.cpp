// Drivers in the event-driven mode: motion, forces and work, jumps and kinks of their laws, impacts.

#include "tests/integrators/joint_run.h"

#include "tests/integrators/throws.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

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
    // Of the rates by differences; and between projections pins part by as much as the tolerance leaves.
    EXPECT_LE(check.speed, std::max(speed_limit, tolerance));
    const auto breaks = events_of(simulation, EventKind::discontinuity);
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
  // impulse does work, or the ledger would not close.
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
  for (const Mode& mode : {Mode(fine()), Mode(TimeStepping{})}) {
    Simulation simulation(scene.system, mode);
    EXPECT_THROWS(SolverError, simulation.run_until(1.0), "no solution", "driven by", "ram", "foot");
    EXPECT_LT(simulation.time(), 0.46);
  }
}

}  // namespace
