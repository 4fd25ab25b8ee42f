// Static and sliding friction, Stribeck's curve: the coefficient by speed, sticking until mu_s, sliding with
// mu_k, and nothing new where the two are equal.

#include "tests/energy/ledger_check.h"
#include "tests/integrators/same_run.h"
#include "tests/model_error.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::bits_of;
using carom_test::ledger_closes;

constexpr double g = 9.81;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(StaticFriction, CoefficientBySpeed) {
  const Surface plain{.friction = 0.3, .normal_restitution = 0.0};
  EXPECT_FALSE(plain.has_static_friction());
  EXPECT_EQ(plain.sticking_friction(), 0.3);
  EXPECT_EQ(plain.friction_at(0.0), 0.3);
  EXPECT_EQ(plain.friction_at(2.0), 0.3);

  const Surface two{.friction = 0.3, .normal_restitution = 0.0, .static_friction = 0.5};
  EXPECT_EQ(two.sticking_friction(), 0.5);
  EXPECT_EQ(two.friction_at(0.0), 0.5);
  EXPECT_EQ(two.friction_at(std::numeric_limits<double>::denorm_min()), 0.3);

  const Surface curve{
      .friction = 0.3, .normal_restitution = 0.0, .static_friction = 0.5, .stribeck_speed = 0.1};
  EXPECT_EQ(curve.friction_at(0.0), 0.5);
  EXPECT_DOUBLE_EQ(curve.friction_at(0.1), 0.3 + 0.2 / std::exp(1.0));
  EXPECT_DOUBLE_EQ(curve.friction_at(0.1 * std::log(4.0)), 0.35);
  EXPECT_EQ(curve.friction_at(1e3), 0.3);
}

TEST(StaticFriction, ImpossibleCoefficientsAreRefusedByName) {
  System system;
  const auto refused = [&](double mu_s, double speed, const char* name, const char* value) {
    const Surface surface{
        .friction = 0.3, .normal_restitution = 0.0, .static_friction = mu_s, .stribeck_speed = speed};
    EXPECT_MODEL_ERROR(system.add(HalfPlane{.normal = {0.0, 1.0}}, surface, "floor"), "half-plane 'floor'",
                       name, value, "allowed");
    EXPECT_MODEL_ERROR(system.between(system.material("a"), system.material("b"), surface), "'a' and 'b'",
                       name, value, "allowed");
  };
  refused(0.29, 0.0, "static_friction", "0.29");
  refused(-1.0, 0.0, "static_friction", "-1");
  refused(infinity, 0.0, "static_friction", "inf");
  refused(0.5, -0.1, "stribeck_speed", "-0.1 m/s");
  refused(0.5, nan, "stribeck_speed", "nan");
  refused(0.5, infinity, "stribeck_speed", "inf");
  refused(nan, 0.1, "stribeck_speed", "static_friction is not given");
  EXPECT_NO_THROW(system.add(HalfPlane{.normal = {0.0, 1.0}},
                             Surface{.friction = 0.3, .normal_restitution = 0.0, .static_friction = 0.3}));
}

/// A particle on a plane that turns about the particle's place at `rate`: it starts a little inside, so that
/// errors of the way do not open the contact.
System tilting(const Surface& surface, double rate) {
  System system;
  system.add(Gravity{{0.0, -g}});
  system.add(HalfPlane{.normal = {0.0, 1.0},
                       .motion = {.angle = [rate](double t) { return rate * t; },
                                  .spin = [rate](double) { return rate; },
                                  .angular_acceleration = [](double) { return 0.0; }}},
             surface);
  system.add(Particle{.mass = 2.0, .position = {0.0, -1e-5}}, "block");
  return system;
}

TEST(StaticFriction, ABlockBreaksLooseAtMuSAndSlidesWithMuK) {
  constexpr double mu_s = 0.5, mu_k = 0.3, rate = 0.1, h = 1e-3;
  for (const bool stribeck : {false, true}) {
    // A Stribeck speed far below those reached is the same but for the start.
    Simulation simulation(tilting({.friction = mu_k,
                                   .normal_restitution = 0.0,
                                   .static_friction = mu_s,
                                   .stribeck_speed = stribeck ? 1e-3 : 0.0},
                                  rate),
                          TimeStepping{.step = h});
    const BodyId block = simulation.system().body("block");
    while (simulation.report().contacts.empty() ||
           simulation.report().contacts[0].mode == ContactMode::stick) {
      simulation.step();
      ASSERT_LT(simulation.time(), 10.0);
    }
    const double loose = std::atan(mu_s) / rate;
    EXPECT_NEAR(simulation.time(), loose, 2.0 * h);

    // From there on  x'' = w^2 x - g sin + mu_k (g cos + 2 w x')  along the plane, uphill positive.
    const auto acceleration = [&](double t, double x, double u) {
      return rate * rate * x - g * std::sin(rate * t) + mu_k * (g * std::cos(rate * t) + 2.0 * rate * u);
    };
    double x = 0.0, u = 0.0;
    constexpr int count = 1000;
    constexpr double dt = 0.5 / count;
    for (int i = 0; i < count; ++i) {  // midpoint rule: error of order 1e-7
      const double t = loose + i * dt, a = acceleration(t, x, u);
      const double middle = acceleration(t + 0.5 * dt, x + 0.5 * dt * u, u + 0.5 * dt * a);
      x += dt * (u + 0.5 * dt * a);
      u += dt * middle;
    }
    simulation.run_until(loose + 0.5);
    const double turn = rate * simulation.time();
    const Vec<2> uphill(std::cos(turn), std::sin(turn)), at = simulation.state().position(block);
    EXPECT_LT(x, -0.2);
    // It starts up to two steps late, and the plane turns by rate h in a step; with Stribeck's curve,
    // friction falls over the first 1 mm/s, which takes a few ms longer from a speed of nearly zero.
    EXPECT_NEAR(uphill.dot(at), x, stribeck ? 0.008 : 0.004);
    EXPECT_TRUE(ledger_closes(simulation.energy()));
  }
}

/// A block on the floor pushed by a constant force.
System pushed(const Surface& surface, double force, double speed) {
  System system;
  system.add(Gravity{{0.0, -g}});
  system.add(HalfPlane{.normal = {0.0, 1.0}}, surface);
  const BodyId block = system.add(Particle{.mass = 1.0, .velocity = {speed, 0.0}}, "block");
  system.add(AppliedForce{.on = block, .force = [force](double) { return Vec<2>(force, 0.0); }});
  return system;
}

TEST(StaticFriction, AForceBetweenTheTwoHoldsOrMovesByHistory) {
  const Surface surface{.friction = 0.3, .normal_restitution = 0.0, .static_friction = 0.5};
  Simulation rest(pushed(surface, 0.4 * g, 0.0), TimeStepping{.step = 1e-3});
  rest.run_until(1.0);
  // An edit does not make it forget that it sticks.
  rest.edit([](System& system) { system.add(Particle{.mass = 1.0, .position = {0.0, 50.0}}); });
  rest.run_until(2.0);
  EXPECT_NEAR(rest.state().position(rest.system().body("block"))[0], 0.0, 1e-14);
  Simulation moving(pushed(surface, 0.4 * g, 0.1), TimeStepping{.step = 1e-3});
  moving.run_until(2.0);
  EXPECT_NEAR(moving.state().velocity(moving.system().body("block"))[0], 0.1 + 0.1 * g * 2.0, 1e-12);
  EXPECT_TRUE(ledger_closes(rest.energy()));
  EXPECT_TRUE(ledger_closes(moving.energy()));
}

TEST(StaticFriction, StribecksCurveSlowsAsTheClosedFormSays) {
  // u = exp(v/s) obeys u' = -(g/s)(mu_k u + d), d = mu_s - mu_k.
  constexpr double mu_k = 0.2, d = 0.3, s = 0.5, v0 = 2.0, t = 0.6;
  const double u = (std::exp(v0 / s) + d / mu_k) * std::exp(-g * mu_k * t / s) - d / mu_k;
  const auto error = [&](double step) {
    Simulation simulation(
        pushed(
            {.friction = mu_k, .normal_restitution = 0.0, .static_friction = mu_k + d, .stribeck_speed = s},
            0.0, v0),
        TimeStepping{.step = step});
    simulation.run_until(t);
    return simulation.state().velocity(simulation.system().body("block"))[0] - s * std::log(u);
  };
  // The coefficient is that of the start of the step: order 1.
  const double coarse = error(2e-3), fine = error(1e-3);
  EXPECT_LE(std::abs(fine), 1e-3 * 5.0);
  EXPECT_NEAR(coarse / fine, 2.0, 0.1);
}

TEST(StaticFriction, EqualCoefficientsChangeNoBit) {
  const auto run = [](const Surface& surface) {
    Simulation simulation(tilting(surface, 0.3), TimeStepping{.step = 1e-3});
    simulation.run_until(2.0);
    return simulation;
  };
  const Simulation plain = run({.friction = 0.3, .normal_restitution = 0.4, .tangential_restitution = 0.2});
  const Simulation equal = run({.friction = 0.3,
                                .normal_restitution = 0.4,
                                .tangential_restitution = 0.2,
                                .static_friction = 0.3,
                                .stribeck_speed = 0.1});
  EXPECT_EQ(bits_of(plain), bits_of(equal));
  EXPECT_EQ(plain.system().fingerprint(), equal.system().fingerprint());
}

TEST(StaticFriction, IsInTheFingerprint) {
  const auto print = [](double mu_s, double speed) {
    System system;
    system.add(
        HalfPlane{.normal = {0.0, 1.0}},
        Surface{
            .friction = 0.3, .normal_restitution = 0.0, .static_friction = mu_s, .stribeck_speed = speed});
    return system.fingerprint();
  };
  EXPECT_NE(print(0.4, 0.0), print(nan, 0.0));
  EXPECT_NE(print(0.4, 0.0), print(0.5, 0.0));
  EXPECT_NE(print(0.4, 0.0), print(0.4, 0.1));
}

/// A body that stands on an incline along which it is held by static friction alone.
System at_rest_on_incline(double angle, double along, bool is_box) {
  System system;
  system.add(Gravity{{0.0, -g}});
  const Vec<2> up = incline(angle), down_line(up[1], -up[0]);
  system.add(HalfPlane{.normal = up},
             Surface{.friction = 0.2, .normal_restitution = 0.0, .static_friction = 0.35});
  if (!is_box) {
    system.add(Particle{.mass = 1.0, .position = along * down_line}, "body");
    return system;
  }
  const BodyId body = system.add(
      RigidBody{.mass = box(1.0, 0.2, 0.1), .position = along * down_line + 0.05 * up, .angle = angle},
      "body");
  system.add(Polygon{.body = body, .vertices = {{-0.1, -0.05}, {0.1, -0.05}, {0.1, 0.05}, {-0.1, 0.05}}});
  return system;
}

// Rounding leaves gaps of either sign, at the start and from step to step: none of them sets a body free.
TEST(StaticFriction, WhatIsAtRestStaysWhateverRoundingLeavesOfItsGap) {
  using Rules = ImpactRules;
  for (const TimeStepping& options :
       {TimeStepping{.step = 1e-3}, TimeStepping{.step = 1e-4},
        TimeStepping{.step = 1e-3, .project_gaps = true},
        TimeStepping{.step = 1e-3, .impacts = ImpactTimes::located},
        TimeStepping{.step = 1e-3, .impact_rules = Rules{.order = ImpactOrder::sequential}}}) {
    for (int place = 0; place < 60; ++place) {
      const double angle = 0.22 + 0.0018 * place, along = std::fmod(0.7316 * place, 4.0) - 2.0;
      for (const bool is_box : {false, true}) {
        const System system = at_rest_on_incline(angle, along, is_box);
        Simulation simulation(system, options);
        const BodyId body = simulation.system().body("body");
        const Vec<2> start = simulation.state().position(body);
        for (int i = 0; i < 50; ++i) simulation.step();
        // To the rounding of impulses: of the solver's answer, times the time.
        EXPECT_LT((simulation.state().position(body) - start).norm(), 1e-12) << angle << " " << is_box;
      }
    }
  }
}

// On a table that shakes up and down too the end of a step opens contacts, by h^2 times the change of its
// acceleration: what sticks stays with the table, to the second order.
TEST(StaticFriction, WhatSticksGoesWithATableThatShakesInBothDirections) {
  constexpr double rate = 30.0, up_rate = 51.0, way = 0.3 * g / (rate * rate), up = 0.1 * g / (rate * rate);
  PrescribedMotion shakes;
  shakes.displacement = [=](double t) -> Vec<2> {
    return {way * std::sin(rate * t), up * std::sin(up_rate * t)};
  };
  shakes.velocity = [=](double t) -> Vec<2> {
    return {way * rate * std::cos(rate * t), up * up_rate * std::cos(up_rate * t)};
  };
  System system;
  system.add(Gravity{{0.0, -g}});
  system.add(HalfPlane{.normal = {0.0, 1.0}, .motion = shakes},
             Surface{.friction = 0.2, .normal_restitution = 0.0, .static_friction = 0.55});
  const BodyId body = system.add(Particle{.mass = 1.0, .velocity = shakes.velocity(0.0)});
  for (const ImpactTimes impacts : {ImpactTimes::at_step_start, ImpactTimes::located}) {
    for (const double step : {1e-3, 1e-4}) {
      Simulation simulation(system, TimeStepping{.step = step, .impacts = impacts});
      simulation.run_until(1.0);
      // The trapezoidal rule is off by (h w)^2/12 of the way.
      const double off = 2.0 * way * (rate * step) * (rate * step) / 12.0;
      EXPECT_NEAR(simulation.state().position(body)[0], shakes.displacement(1.0)[0], off) << step;
    }
  }
}

}  // namespace
