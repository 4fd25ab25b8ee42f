// Dry friction in joints, in both modes: rest where the law says, against closed forms; breaking away; bounds
// by the force in the joint; the ledger.

#include "tests/energy/ledger_check.h"
#include "tests/integrators/joint_run.h"
#include "tests/integrators/throws.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace {

using namespace joint_scenes;
using carom_test::events_of;
using carom_test::ledger_closes;

constexpr double pi = std::numbers::pi;

// Of runs at the tolerances of fine(), a few thousand steps long.
constexpr double run_limit = 1e-10;

/// A wheel on a pin that rubs.
struct Wheel {
  System system;
  BodyId wheel;
  JointId pin, friction;
  explicit Wheel(double spin, JointFriction law) {
    wheel = system.add(RigidBody{.mass = disc(2.0, 1.0), .spin = spin}, "wheel");
    pin = system.add(Revolute{.from = ground, .to = wheel}, "pin");
    law.joint = pin;
    friction = system.add(law, "rubbing");
  }
};

/// A uniform rod of 1 kg and 1 m on a pin at its end, 0.2 rad below the level.
struct Pendulum {
  System system;
  BodyId rod_body;
  JointId pin, friction;
  static constexpr double start = -0.2, weight = g, arm = 0.5;
  explicit Pendulum(JointFriction law) {
    system.add(Gravity{{0.0, -g}});
    rod_body = system.add(RigidBody{.mass = rod(1.0, 1.0),
                                    .position = {arm * std::cos(start), arm * std::sin(start)},
                                    .angle = start},
                          "pendulum");
    pin = system.add(Revolute{.from = ground, .to = {rod_body, {-arm, 0.0}}}, "pin");
    law.joint = pin;
    friction = system.add(law, "rubbing");
  }
};

TEST(JointFriction, AWheelStopsInTime) {
  // w = w0 - M t/I until t = I w0/M, after an angle of I w0^2/(2 M).
  const Wheel wheel(3.0, {.bound = 0.7});
  const double stop = 3.0 / 0.7, angle = 4.5 / 0.7;
  WatchedRun event{{wheel.system, {wheel.wheel}}};
  event.simulation.run_until(2.0);
  EXPECT_NEAR(event.simulation.state().spin(wheel.wheel), 1.6, run_limit);
  EXPECT_NEAR(event.simulation.reaction(wheel.friction).moment, -0.7, run_limit);
  event.simulation.run_until(6.0);
  const auto stops = events_of(event.simulation, EventKind::stick);
  ASSERT_EQ(stops.size(), 1u);
  EXPECT_NEAR(stops[0].time, stop, run_limit);
  EXPECT_NEAR(event.simulation.state().angle(wheel.wheel), angle, run_limit);
  EXPECT_EQ(event.simulation.state().spin(wheel.wheel), 0.0);
  EXPECT_NEAR(event.simulation.energy().flow(EnergyFlow::joint_friction), 4.5, run_limit);

  // The step in which it stops takes its mean velocity: off by less than h^2 M/I.
  for (const double step : {1e-2, 1e-3}) {
    Simulation stepping(wheel.system, TimeStepping{.step = step});
    stepping.run_until(2.0);
    EXPECT_NEAR(stepping.reaction(wheel.friction).moment, -0.7, 1e-12);
    stepping.run_until(6.0);
    EXPECT_EQ(stepping.state().spin(wheel.wheel), 0.0);
    EXPECT_NEAR(stepping.state().angle(wheel.wheel), angle, 0.7 * step * step);
    EXPECT_TRUE(ledger_closes(stepping.energy()));
  }
}

// Steps with lasting contact of bodies that turn are repeated, and with each of them friction lost a factor
// of the step in mechanisms that touch nothing.
TEST(JointFriction, ContactElsewhereLeavesItsBound) {
  Wheel wheel(3.0, {.bound = 0.7});
  wheel.system.add(Gravity{{0.0, -g}});  // acts at the pin
  wheel.system.set_default_law({.friction = 0.3, .normal_restitution = 0.5, .tangential_restitution = 0.5});
  wheel.system.add(HalfPlane{.normal = {0.0, 1.0}});
  for (const Vec<2>& place : {Vec<2>(3.0, 0.3), Vec<2>(3.01, 0.6)}) {
    const BodyId ball = wheel.system.add(RigidBody{.mass = disc(1.0, 0.1), .position = place});
    wheel.system.add(Disc{.body = ball, .radius = 0.1});
  }
  for (const ImpactTimes impacts : {ImpactTimes::at_step_start, ImpactTimes::located}) {
    Simulation stepping(wheel.system, TimeStepping{.step = 1e-3, .impacts = impacts});
    stepping.run_until(2.0);
    // Rounding of 2,000 steps and their parts.
    EXPECT_NEAR(stepping.state().spin(wheel.wheel), 1.6, 1e-12) << to_string(impacts);
    EXPECT_NEAR(stepping.energy().flow(EnergyFlow::joint_friction), 0.5 * (9.0 - 1.6 * 1.6), 1e-11)
        << to_string(impacts);
  }
}

TEST(JointFriction, APendulumRestsOffItsLowestPoint) {
  // Between turning points weight works what friction takes: m g s (sin a - sin b) = M |a - b|. It stays
  // where the moment of the weight is below M.
  constexpr double bound = 0.6;
  const Pendulum pendulum({.bound = bound});
  WatchedRun event{{pendulum.system, {pendulum.rod_body}}};
  std::vector<double> turns{Pendulum::start};
  std::size_t seen = 0;
  event.simulation.observe([&](const Simulation& now) {
    // A turn is an event: the driver stops there.
    for (; seen < now.events().size(); ++seen) turns.push_back(now.state().angle(pendulum.rod_body));
  });
  while (event.simulation.time() < 6.0) {
    event.simulation.run_until(event.simulation.time() + 1e-3);
  }
  const double rest = event.simulation.state().angle(pendulum.rod_body);
  EXPECT_EQ(event.simulation.state().spin(pendulum.rod_body), 0.0);
  EXPECT_LT(Pendulum::weight * Pendulum::arm * std::abs(std::cos(rest)), bound);
  EXPECT_GT(std::abs(rest + 0.5 * pi), 1e-3);
  EXPECT_NEAR(event.simulation.reaction(pendulum.friction).moment,
              Pendulum::weight * Pendulum::arm * std::cos(rest), run_limit);
  const double taken = bound * [&] {
    double way = 0.0, from = Pendulum::start;
    for (std::size_t i = 1; i < turns.size(); ++i) {
      // By bisection between the lowest point and the height it started from.
      double low = -0.5 * pi, high = from < low ? 0.0 : -pi;
      const auto left = [&](double to) {
        return Pendulum::weight * Pendulum::arm * (std::sin(from) - std::sin(to)) -
               bound * std::abs(from - to);
      };
      for (int k = 0; k < 200; ++k) {
        const double middle = 0.5 * (low + high);
        (left(middle) > 0.0 ? low : high) = middle;
      }
      way += std::abs(low - from);
      from = low;
    }
    EXPECT_NEAR(rest, from, run_limit);
    return way;
  }();
  EXPECT_NEAR(event.simulation.energy().flow(EnergyFlow::joint_friction), taken, 10.0 * run_limit);
  EXPECT_EQ(events_of(event.simulation, EventKind::slip).size(), 4u);
  EXPECT_EQ(events_of(event.simulation, EventKind::stick).size(), 1u);
  event.simulation.run_until(100.0);
  EXPECT_EQ(event.simulation.state().angle(pendulum.rod_body), rest);

  // Time stepping finds a turn up to a step late.
  std::vector<double> errors;
  for (const double step : {1e-3, 1e-4}) {
    Simulation stepping(pendulum.system, TimeStepping{.step = step});
    stepping.run_until(6.0);
    EXPECT_EQ(stepping.state().spin(pendulum.rod_body), 0.0);
    const double stays = stepping.state().angle(pendulum.rod_body);
    errors.push_back(std::abs(stays - rest));
    stepping.run_until(20.0);
    EXPECT_NEAR(stepping.state().angle(pendulum.rod_body), stays, 1e-15);
    EXPECT_TRUE(ledger_closes(stepping.energy()));
  }
  EXPECT_LT(errors[0], 1e-4);
  EXPECT_LT(errors[1], 1e-5);
}

TEST(JointFriction, ABlockOnASpringCreepsToRest) {
  // Half swings of pi sqrt(m/k), each shorter by 2 F/k, until the spring is weaker than friction.
  constexpr double mass = 2.0, stiffness = 50.0, force = 3.0, out = 1.0;
  System system;
  const BodyId block = system.add(RigidBody{.mass = {.mass = mass, .inertia = 0.1}, .position = {out, 0.0}});
  const JointId slide = system.add(Prismatic{.from = ground, .to = block, .axis = {1.0, 0.0}});
  system.add(SpringDamper{.from = ground, .to = block, .stiffness = stiffness, .free_length = 0.0});
  system.add(JointFriction{.joint = slide, .bound = force});
  double place = out;
  int swings = 0;
  while (std::abs(place) * stiffness > force) {
    place = place > 0.0 ? -place + 2.0 * force / stiffness : -place - 2.0 * force / stiffness;
    ++swings;
  }
  const double end = swings * pi * std::sqrt(mass / stiffness);
  WatchedRun event{{system, {block}}};
  event.simulation.run_until(end + 1.0);
  EXPECT_NEAR(event.simulation.state().position(block)[0], place, run_limit);
  const auto stops = events_of(event.simulation, EventKind::stick);
  ASSERT_EQ(stops.size(), 1u);
  EXPECT_NEAR(stops[0].time, end, 10.0 * run_limit);
  EXPECT_EQ(static_cast<int>(events_of(event.simulation, EventKind::slip).size()), swings - 1);

  Simulation stepping(system, TimeStepping{.step = 1e-4});
  stepping.run_until(end + 1.0);
  EXPECT_NEAR(stepping.state().position(block)[0], place, 1e-5);  // a turn up to a step late, swing by swing
  EXPECT_LE(std::abs(stepping.state().velocity(block)[0]), 1e-15);
}

TEST(JointFriction, BreaksAwayAtItsStaticBound) {
  // Torque a t against a wheel: away at t1 = M_s/a, then I w = a (t^2 - t1^2)/2 - M (t - t1).
  constexpr double rise = 0.4, bound = 0.5, factor = 1.6;
  Wheel wheel(0.0, {.bound = bound, .static_factor = factor});
  wheel.system.add(Motor{.joint = wheel.pin, .torque = [](double t, double, double) { return rise * t; }});
  constexpr double away = bound * factor / rise, later = 3.5;
  const double spin = 0.5 * rise * (later * later - away * away) - bound * (later - away);
  WatchedRun event{{wheel.system, {wheel.wheel}}};
  event.simulation.run_until(1.0);
  EXPECT_EQ(event.simulation.state().spin(wheel.wheel), 0.0);
  EXPECT_NEAR(event.simulation.reaction(wheel.friction).moment, -rise, run_limit);
  event.simulation.run_until(later);
  const auto slips = events_of(event.simulation, EventKind::slip);
  ASSERT_EQ(slips.size(), 1u);
  EXPECT_NEAR(slips[0].time, away, run_limit);
  EXPECT_EQ(slips[0].mode, ContactMode::slip_positive);
  EXPECT_NEAR(event.simulation.state().spin(wheel.wheel), spin, run_limit);
  EXPECT_NEAR(event.simulation.reaction(wheel.friction).moment, -bound, run_limit);

  // Away up to a step late, at which the torque is above friction by 0.3 N m.
  for (const double step : {1e-3, 1e-4}) {
    Simulation stepping(wheel.system, TimeStepping{.step = step});
    stepping.run_until(later);
    EXPECT_NEAR(stepping.state().spin(wheel.wheel), spin, (factor - 1.0) * bound * 2.0 * step);
    EXPECT_TRUE(ledger_closes(stepping.energy()));
  }
}

TEST(JointFriction, BoundByTheForceInThePin) {
  // A wheel's weight rests on a pin of radius r: M = mu r m g.
  constexpr double coefficient = 0.03;
  Wheel wheel(3.0, {.coefficient = coefficient});
  wheel.system.add(Gravity{{0.0, -g}});
  const double moment = coefficient * 2.0 * g;
  WatchedRun event{{wheel.system, {wheel.wheel}}};
  event.simulation.run_until(1.0);
  EXPECT_NEAR(event.simulation.reaction(wheel.friction).moment, -moment, run_limit);
  event.simulation.run_until(8.0);
  const auto stops = events_of(event.simulation, EventKind::stick);
  ASSERT_EQ(stops.size(), 1u);
  EXPECT_NEAR(stops[0].time, 3.0 / moment, run_limit);
  EXPECT_NEAR(event.simulation.state().angle(wheel.wheel), 4.5 / moment, run_limit);

  Simulation stepping(wheel.system, TimeStepping{.step = 1e-3});
  stepping.run_until(8.0);
  EXPECT_NEAR(stepping.state().angle(wheel.wheel), 4.5 / moment, moment * 1e-6);
  EXPECT_TRUE(ledger_closes(stepping.energy()));
}

TEST(JointFriction, BoundByTheForceOnAGuide) {
  // A block thrown along a slope of 0.3 rad on a guide: it comes to rest after v^2/(2 (g sin + mu g cos))
  // and, mu > tan, stays; with mu < tan it slides back.
  constexpr double slope = 0.3, speed = 2.0;
  for (const double mu : {0.4, 0.2}) {
    System system;
    system.add(Gravity{{0.0, -g}});
    const double c = std::cos(slope), s = std::sin(slope);
    const BodyId block = system.add(
        RigidBody{.mass = {.mass = 3.0, .inertia = 0.1}, .angle = slope, .velocity = {speed * c, speed * s}});
    const JointId guide = system.add(Prismatic{.from = ground, .to = block, .axis = {c, s}});
    const JointId friction = system.add(JointFriction{.joint = guide, .coefficient = mu});
    const double braking = g * (s + mu * c), way = speed * speed / (2.0 * braking), turn = speed / braking;
    const double after = 1.0, slides = mu < s / c ? 0.5 * g * (s - mu * c) * after * after : 0.0;
    WatchedRun event{{system, {block}}};
    event.simulation.run_until(turn + after);
    const auto place = [&](const Simulation& now) { return now.state().coordinate(guide); };
    EXPECT_NEAR(place(event.simulation), way - slides, run_limit) << mu;
    const double holds = slides > 0.0 ? 3.0 * g * mu * c : 3.0 * g * s;
    EXPECT_NEAR(event.simulation.reaction(friction).moment, holds, 1e-9) << mu;
    Simulation stepping(system, TimeStepping{.step = 1e-4});
    stepping.run_until(turn + after);
    EXPECT_NEAR(place(stepping), way - slides, 1e-3 * speed) << mu;
    EXPECT_TRUE(ledger_closes(stepping.energy())) << mu;
  }
}

TEST(JointFriction, AnImpactIsRubbedToo) {
  // A level rod on a pin comes down with its tip on a floor without friction. With impulses P of the floor, R
  // of the pin, M of friction and the spins w before and w' = -e w after:
  //   m (L^2/3) (w' - w) = P L + M,   m (L/2) (w' - w) = P + R,   M = -c |R|,
  // with m = L = 1 and D = w' - w:  R = D/6/(1 + c),  P = D/3 + c R.
  constexpr double e = 0.5, c = 0.1, w = -2.0, change = -(1.0 + e) * w;
  constexpr double of_pin = change / 6.0 / (1.0 + c), of_floor = change / 3.0 + c * of_pin;
  System system;
  const BodyId arm = system.add(
      RigidBody{.mass = rod(1.0, 1.0), .position = {0.5, 0.0}, .velocity = {0.0, 0.5 * w}, .spin = w}, "arm");
  const JointId pin = system.add(Revolute{.from = ground, .to = {arm, {-0.5, 0.0}}}, "pin");
  const JointId friction = system.add(JointFriction{.joint = pin, .coefficient = c}, "rubbing");
  system.add(Point{.body = arm, .position = {0.5, 0.0}});
  system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = 0.0, .normal_restitution = e});
  WatchedRun event{{system, {arm}}};
  event.simulation.run_until(0.01);
  const auto impacts = events_of(event.simulation, EventKind::impact);
  ASSERT_EQ(impacts.size(), 1u);
  EXPECT_NEAR(impacts[0].impulse[0], of_floor, 1e-12);  // certified to 1e-12
  bool told = false;
  for (const JointImpulse& entry : event.simulation.report().joint_impulses) {
    if (entry.joint == pin) {
      EXPECT_NEAR(entry.impulse.force[1], of_pin, 1e-12);
    }
    if (entry.joint != friction) continue;
    told = true;
    EXPECT_NEAR(entry.impulse.moment, -c * of_pin, 1e-12);
  }
  EXPECT_TRUE(told);
}

TEST(JointFriction, StickingKeepsAGuideThatTurnsOrderTwo) {
  // A slider sticks on a guide that a driver turns faster and faster: friction holds it where it is until the
  // bound is reached, the end velocity along the guide is zero in every step.
  System system;
  const BodyId table = system.add(RigidBody{.mass = disc(2.0, 1.0)}, "table");
  const BodyId slider = system.add(RigidBody{.mass = disc(0.5, 0.2), .position = {0.8, 0.0}}, "slider");
  const JointId pin = system.add(Revolute{.from = ground, .to = table}, "pin");
  const JointId guide = system.add(Prismatic{.from = table, .to = slider, .axis = {1.0, 0.0}}, "guide");
  const JointId friction = system.add(JointFriction{.joint = guide, .bound = 1.0}, "rubbing");
  system.add(Driver{.joint = pin,
                    .position = [](double t) { return 0.5 * t * t; },
                    .velocity = [](double t) { return t; },
                    .acceleration = [](double) { return 1.0; }});
  // Along the guide m w^2 r = 1 at w = sqrt(2.5); before, it stays.
  const double away = std::sqrt(1.0 / (0.5 * 0.8));
  WatchedRun event{{system, {table, slider}}};
  event.simulation.run_until(1.5);
  EXPECT_NEAR(event.simulation.reaction(friction).moment, -0.5 * 1.5 * 1.5 * 0.8, 1e-9);
  event.simulation.run_until(2.0);
  const auto slips = events_of(event.simulation, EventKind::slip);
  ASSERT_EQ(slips.size(), 1u);
  EXPECT_NEAR(slips[0].time, away, run_limit);
  const double outside = event.simulation.state().coordinate(guide);

  std::vector<double> errors;
  for (const double step : {4e-3, 2e-3, 1e-3}) {
    Simulation stepping(system, TimeStepping{.step = step});
    const double start = stepping.state().coordinate(guide);
    stepping.run_until(1.5);
    EXPECT_LE(std::abs(stepping.state().rate(guide)), 1e-12);
    // Creep of the mean velocity: nothing but rounding in the sum of all steps.
    EXPECT_NEAR(stepping.state().coordinate(guide), start, 1e-6 * step / 1e-3);
    stepping.run_until(2.0);
    errors.push_back(std::abs(stepping.state().coordinate(guide) - outside));
  }
  EXPECT_LT(errors[2], 0.35 * errors[1]);
  EXPECT_LT(errors[1], 0.35 * errors[0]);
}

TEST(JointFriction, ASavedRunGoesOnBitForBit) {
  // Whether it stuck in the step before is part of what is saved.
  Wheel wheel(0.0, {.bound = 0.5, .static_factor = 1.6});
  wheel.system.add(Motor{.joint = wheel.pin, .torque = [](double t, double, double) { return 0.4 * t; }});
  Simulation whole(wheel.system, TimeStepping{.step = 1e-3});
  whole.run_until(1.9);
  const std::string file = testing::TempDir() + "/joint_friction_checkpoint";
  whole.save(file);
  whole.run_until(3.0);
  Simulation again(wheel.system, TimeStepping{.step = 1e-3});
  again.load(file);
  again.run_until(3.0);
  EXPECT_EQ(again.state().spin(wheel.wheel), whole.state().spin(wheel.wheel));
  EXPECT_EQ(again.state().angle(wheel.wheel), whole.state().angle(wheel.wheel));
}

TEST(JointFriction, RedundantJointsAreRefusedByName) {
  // Four-bar with a third parallel link: forces of its joints are not unique.
  System system;
  const BodyId level = system.add(RigidBody{.mass = rod(1.0, 2.0), .position = {0.0, 1.0}}, "level");
  std::vector<JointId> pins;
  for (const double x : {-1.0, 0.0, 1.0}) {
    const BodyId link = system.add(RigidBody{.mass = rod(1.0, 1.0), .position = {x, 0.5}, .angle = 0.5 * pi},
                                   "link " + std::to_string(x));
    pins.push_back(system.add(Revolute{.from = {ground, {x, 0.0}}, .to = {link, {-0.5, 0.0}}}));
    system.add(Revolute{.from = {link, {0.5, 0.0}}, .to = {level, {x, 0.0}}});
  }
  System constant = system;
  constant.add(JointFriction{.joint = pins[0], .bound = 0.1});
  Simulation fine_with(constant, TimeStepping{.step = 1e-3});
  EXPECT_NO_THROW(fine_with.run_until(0.1));
  system.add(JointFriction{.joint = pins[0], .coefficient = 0.1}, "rubbing");
  EXPECT_THROWS(ModelError, Simulation(system, TimeStepping{.step = 1e-3}), "rubbing", "coefficient is 0.1",
                "not unique", "allowed: a constant bound");
  EXPECT_THROWS(ModelError, Simulation(system, EventDriven{}), "rubbing", "not unique");
}

}  // namespace
