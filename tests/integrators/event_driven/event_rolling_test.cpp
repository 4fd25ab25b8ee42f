// Rolling resistance |M| <= rho P_n in event-driven mode: closed forms of discs on ground at rest, of discs
// that meet, and of one that lies in a groove.

#include "tests/contact/random_problems.h"
#include "tests/integrators/event_driven/body_scenes.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace {

using namespace body_scenes;
using contact_test::Random;

constexpr double radius = 0.2, mass = 1.5;

/// A round body of inertia k m r^2 on a plane that falls with +x, turned by the slope; it rolls, unless
/// another spin is given.
struct Roller {
  System system;
  BodyId body;

  Roller(double slope, double k, double rho, double speed, double spin, double friction = 2.0) {
    const Vec<2> normal(std::sin(slope), std::cos(slope)), along(std::cos(slope), -std::sin(slope));
    system.add(Gravity{{0.0, -g}});
    system.add(HalfPlane{.normal = normal},
               Surface{.friction = friction, .normal_restitution = 0.0, .rolling_resistance = rho});
    body = system.add(RigidBody{.mass = {.mass = mass, .inertia = k * mass * radius * radius},
                                .position = radius * normal,
                                .velocity = speed * along,
                                .spin = spin});
    system.add(Disc{.body = body, .radius = radius});
  }
  Roller(double slope, double k, double rho, double speed) : Roller(slope, k, rho, speed, -speed / radius) {}
};

/// Times of the events of a kind.
std::vector<double> times_of(const Simulation& simulation, EventKind kind) {
  std::vector<double> times;
  for (const EventRecord& event : simulation.events()) {
    if (event.kind == kind) times.push_back(event.time);
  }
  return times;
}

TEST(EventRolling, DiscRollsToRestAtAnExactTime) {
  // With friction T along the way and the moment M = rho m g: m a = T, I a/r = -(r T + M), so that
  // a = -rho g/(r (1 + k)), I = k m r^2.
  constexpr double rho = 0.01, speed = 1.0;
  for (const double k : {1.0, 0.5, 0.4}) {
    const Roller scene(0.0, k, rho, speed);
    Simulation simulation(scene.system, EventDriven{});
    const double deceleration = rho * g / (radius * (1.0 + k)), end = speed / deceleration;
    for (const double part : {0.25, 0.5, 0.9}) {
      const double t = part * end;
      simulation.run_until(t);
      // Accelerations are constant: rounding.
      EXPECT_NEAR(simulation.state().velocity(scene.body)[0], speed - deceleration * t, 1e-13) << k;
      EXPECT_NEAR(simulation.state().spin(scene.body), -(speed - deceleration * t) / radius, 1e-12) << k;
      EXPECT_NEAR(simulation.state().position(scene.body)[0], speed * t - 0.5 * deceleration * t * t, 1e-13)
          << k;
    }
    simulation.run_until(1.1 * end);
    const std::vector<double> holds = times_of(simulation, EventKind::hold);
    ASSERT_EQ(holds.size(), 1U) << k;
    EXPECT_NEAR(holds[0], end, 1e-13 * end) << k;
    // A projection leaves rounding of rounding.
    const double spin = simulation.state().spin(scene.body);
    EXPECT_LE(std::abs(spin), 1e-30) << k;
    EXPECT_LE(simulation.state().velocity(scene.body).norm(), 1e-30) << k;
    const Vec<2> place = simulation.state().position(scene.body);
    EXPECT_NEAR(place[0], 0.5 * speed * end, 1e-13) << k;
    const double kinetic = 0.5 * (1.0 + k) * mass * speed * speed;
    EXPECT_NEAR(simulation.energy().flow(EnergyFlow::rolling), kinetic, 1e-13) << k;
    EXPECT_NEAR(simulation.energy().flow(EnergyFlow::sliding), 0.0, 1e-13) << k;
    EXPECT_LE(std::abs(simulation.energy().residual()), 1e-13) << k;
    simulation.run_until(100.0 * end);
    EXPECT_EQ(simulation.state().position(scene.body), place) << k;
    EXPECT_EQ(simulation.state().spin(scene.body), spin) << k;
  }
}

TEST(EventRolling, DiscOnAnInclineStaysBelowTheAngleOfRolling) {
  constexpr double rho = 0.02, k = 0.5, time = 2.0;
  const double limit = std::atan(rho / radius);
  for (const double share : {0.5, 0.99, 1.01, 2.0}) {
    const double slope = share * limit;
    const Roller scene(slope, k, rho, 0.0);
    Simulation simulation(scene.system, EventDriven{});
    const Vec<2> place = simulation.state().position(scene.body);
    simulation.run_until(time);
    const double pull = g * (std::sin(slope) - rho / radius * std::cos(slope)) / (1.0 + k);
    const double acceleration = share < 1.0 ? 0.0 : pull;
    EXPECT_NEAR(simulation.state().velocity(scene.body).norm(), acceleration * time, 1e-12) << share;
    EXPECT_NEAR(simulation.state().spin(scene.body), -acceleration * time / radius, 1e-11) << share;
    const double angle = 0.5 * acceleration * time * time / radius;
    EXPECT_NEAR(simulation.energy().flow(EnergyFlow::rolling), rho * mass * g * std::cos(slope) * angle,
                1e-12)
        << share;
    EXPECT_LE(std::abs(simulation.energy().residual()), 1e-12) << share;
    if (share > 1.0) continue;
    EXPECT_EQ(simulation.state().position(scene.body), place) << share;
  }
}

TEST(EventRolling, DiscThatRollsUpIsHeldOrRollsBack) {
  constexpr double rho = 0.02, k = 0.5, speed = 0.5;
  const double limit = std::atan(rho / radius);
  for (const double share : {0.5, 0.99, 1.01, 2.0}) {
    const double slope = share * limit;
    const Roller scene(slope, k, rho, -speed);
    Simulation simulation(scene.system, EventDriven{});
    simulation.run_until(2.0);
    const double up = g * (std::sin(slope) + rho / radius * std::cos(slope)) / (1.0 + k);
    const double down = g * (std::sin(slope) - rho / radius * std::cos(slope)) / (1.0 + k);
    const std::vector<double> turns = times_of(simulation, share < 1.0 ? EventKind::hold : EventKind::roll);
    ASSERT_EQ(turns.size(), 1U) << share;
    EXPECT_NEAR(turns[0], speed / up, 1e-13) << share;
    EXPECT_EQ(times_of(simulation, share < 1.0 ? EventKind::roll : EventKind::hold).size(), 0U) << share;
    const double after = share < 1.0 ? 0.0 : down * (2.0 - turns[0]);
    EXPECT_NEAR(simulation.state().velocity(scene.body).norm(), after, 1e-12) << share;
    EXPECT_LE(std::abs(simulation.energy().residual()), 1e-12) << share;
  }
}

TEST(EventRolling, DiscThatSlidesIsTurnedWhereFrictionIsStronger) {
  // Sliding, without spin at first: v' = -mu g; friction turns it against the moment, w' = -(mu r - rho) m
  // g/I, where mu r > rho. It rolls from v = -r w on. Else the moment holds it: it slides as a block.
  constexpr double k = 0.5, speed = 2.0, friction = 0.1;
  for (const double rho : {0.005, 0.015, 0.03}) {
    const Roller scene(0.0, k, rho, speed, 0.0, friction);
    Simulation simulation(scene.system, EventDriven{});
    simulation.run_until(60.0);
    const std::vector<double> sticks = times_of(simulation, EventKind::stick),
                              holds = times_of(simulation, EventKind::hold);
    ASSERT_EQ(sticks.size(), 1U) << rho;
    if (rho > friction * radius) {
      EXPECT_NEAR(sticks[0], speed / (friction * g), 1e-12);
      EXPECT_TRUE(holds.empty());
      EXPECT_NEAR(simulation.energy().flow(EnergyFlow::rolling), 0.0, 1e-13);
      EXPECT_NEAR(simulation.energy().flow(EnergyFlow::sliding), 0.5 * mass * speed * speed, 1e-12);
      EXPECT_EQ(simulation.state().spin(scene.body), 0.0);
      continue;
    }
    const double turning = (friction * radius - rho) * g / (k * radius * radius);
    const double rolls = speed / (friction * g + radius * turning);
    const double then = speed - friction * g * rolls;
    EXPECT_NEAR(sticks[0], rolls, 1e-12) << rho;
    ASSERT_EQ(holds.size(), 1U) << rho;
    EXPECT_NEAR(holds[0], rolls + then * radius * (1.0 + k) / (rho * g), 1e-11) << rho;
    EXPECT_LE(std::abs(simulation.energy().residual()), 1e-12) << rho;
  }
}

TEST(EventRolling, ImpactTakesSpin) {
  // Without friction: P_n = m (1 + e) v, the moment rho P_n takes the spin until -e_r of it is left.
  Random random(5);
  int stops = 0;
  for (int i = 0; i < 50; ++i) {
    const double rho = random.uniform(0.0, 0.03), e = random.uniform(0.0, 1.0),
                 e_r = random.uniform(0.0, 1.0);
    const double spin = random.uniform(-20.0, 20.0), height = random.uniform(0.1, 1.0);
    System system;
    system.add(Gravity{{0.0, -g}});
    system.add(
        HalfPlane{.normal = {0.0, 1.0}},
        Surface{
            .friction = 0.0, .normal_restitution = e, .rolling_resistance = rho, .rolling_restitution = e_r});
    const BodyId disc = add_disc(system, mass, radius, {0.0, radius + height}, Vec<2>::Zero(), spin);
    Simulation simulation(system, EventDriven{});
    const double fall = std::sqrt(2.0 * height / g);
    simulation.run_until(fall + 1e-9);
    const double inertia = 0.5 * mass * radius * radius, limit = rho * mass * (1.0 + e) * g * fall;
    const double moment = std::clamp(-inertia * (1.0 + e_r) * spin, -limit, limit);
    stops += std::abs(moment) < limit ? 1 : 0;
    EXPECT_NEAR(simulation.state().spin(disc), spin + moment / inertia, 1e-11) << i;
    const EventRecord& impact = simulation.events().at(0);
    EXPECT_EQ(impact.kind, EventKind::impact);
    EXPECT_NEAR(impact.rolling_moment, moment, 1e-12) << i;
    ASSERT_EQ(simulation.report().contacts.size(), 1U);
    EXPECT_EQ(simulation.report().contacts[0].rolling_moment, impact.rolling_moment);
    const double lost = 0.5 * inertia * (spin * spin - std::pow(spin + moment / inertia, 2));
    EXPECT_NEAR(simulation.energy().flow(EnergyFlow::rolling), lost, 1e-12) << i;
    EXPECT_LE(std::abs(simulation.energy().residual()), 1e-12) << i;
  }
  EXPECT_GT(stops, 5);
  EXPECT_LT(stops, 45);
}

TEST(EventRolling, DiscsThatMeetExchangeSpin) {
  // Central and without friction: P_n = m (1 + e) v/2, the moment acts on the relative spin.
  Random random(3);
  for (int i = 0; i < 30; ++i) {
    const double rho = random.uniform(0.0, 0.05), e = random.uniform(0.0, 1.0),
                 e_r = random.uniform(0.0, 1.0);
    const double speed = random.uniform(0.5, 2.0), spin = random.uniform(-3.0, 3.0);
    System system;
    system.set_default_law(
        {.friction = 0.0, .normal_restitution = e, .rolling_resistance = rho, .rolling_restitution = e_r});
    const BodyId a = add_disc(system, mass, radius, {-radius - 0.1, 0.0}, {speed, 0.0}, spin);
    const BodyId b = add_disc(system, mass, radius, {radius, 0.0});
    Simulation simulation(system, EventDriven{});
    simulation.run_until(0.5);
    const double inertia = 0.5 * mass * radius * radius;
    const double limit = rho * 0.5 * mass * (1.0 + e) * speed;
    const double moment = std::clamp(-0.5 * inertia * (1.0 + e_r) * spin, -limit, limit);
    EXPECT_NEAR(simulation.state().spin(a), spin + moment / inertia, 1e-12) << i;
    EXPECT_NEAR(simulation.state().spin(b), -moment / inertia, 1e-12) << i;
    EXPECT_LE(std::abs(simulation.energy().residual()), 1e-13) << i;
  }
}

TEST(EventRolling, DiscOnADiscTurnsUntilTheyTurnTogether) {
  // One disc lies on the top of another one that turns about its centre, without friction: N = m g, and
  // M = rho N on the relative spin, until both have the spin that keeps I_a w_a + I_b w_b.
  constexpr double rho = 0.01, spin = 8.0;
  for (const double sign : {1.0, -1.0}) {
    System system;
    system.add(Gravity{{0.0, -g}});
    system.set_default_law({.friction = 0.0, .normal_restitution = 0.0, .rolling_resistance = rho});
    const BodyId below = add_disc(system, 4.0, 0.3, {0.0, 0.0});
    system.add(Revolute{.from = ground, .to = below});
    const BodyId above = add_disc(system, mass, radius, {0.0, 0.3 + radius}, Vec<2>::Zero(), sign * spin);
    Simulation simulation(system, EventDriven{});
    const double of_above = 0.5 * mass * radius * radius, of_below = 0.5 * 4.0 * 0.09;
    const double end = spin / (rho * mass * g * (1.0 / of_above + 1.0 / of_below));
    simulation.run_until(0.5 * end);
    EXPECT_NEAR(simulation.state().spin(below), sign * 0.5 * end * rho * mass * g / of_below, 1e-12);
    simulation.run_until(2.0 * end);
    const std::vector<double> holds = times_of(simulation, EventKind::hold);
    ASSERT_EQ(holds.size(), 1U);
    EXPECT_NEAR(holds[0], end, 1e-13);
    const double together = sign * of_above * spin / (of_above + of_below);
    EXPECT_NEAR(simulation.state().spin(above), together, 1e-12);
    EXPECT_NEAR(simulation.state().spin(below), together, 1e-12);
    const double lost = 0.5 * spin * spin * of_above * of_below / (of_above + of_below);
    EXPECT_NEAR(simulation.energy().flow(EnergyFlow::rolling), lost, 1e-12);
    EXPECT_LE(std::abs(simulation.energy().residual()), 1e-12);
  }
}

TEST(EventRolling, DiscThatSpinsInAGrooveStopsAtAnExactTime) {
  // Both sides rub: N_1 + N_2 = sqrt(2) m g/(1 + mu^2), I w' = -(mu r + rho) (N_1 + N_2).
  constexpr double rho = 0.01, friction = 0.5, spin = 10.0;
  System system;
  system.add(Gravity{{0.0, -g}});
  const Surface law{.friction = friction, .normal_restitution = 0.0, .rolling_resistance = rho};
  for (const double side : {1.0, -1.0}) system.add(HalfPlane{.normal = Vec<2>(side, 1.0).normalized()}, law);
  const BodyId disc = add_disc(system, mass, radius, {0.0, radius * std::sqrt(2.0)}, Vec<2>::Zero(), spin);
  Simulation simulation(system, EventDriven{});
  simulation.run_until(1.0);
  const double press = std::sqrt(2.0) * mass * g / (1.0 + friction * friction);
  const double inertia = 0.5 * mass * radius * radius;
  const double end = inertia * spin / ((friction * radius + rho) * press);
  const std::vector<double> holds = times_of(simulation, EventKind::hold);
  ASSERT_EQ(holds.size(), 2U);
  for (const double time : holds) EXPECT_NEAR(time, end, 1e-13);
  EXPECT_LE(std::abs(simulation.state().spin(disc)), 1e-30);
  const double kinetic = 0.5 * inertia * spin * spin;
  EXPECT_NEAR(simulation.energy().flow(EnergyFlow::rolling), kinetic * rho / (friction * radius + rho),
              1e-13);
  EXPECT_LE(std::abs(simulation.energy().residual()), 1e-13);
}

TEST(EventRolling, BoxThatSlidesDoesNotKnowOfIt) {
  constexpr double friction = 0.2, speed = 1.0;
  System system;
  system.add(Gravity{{0.0, -g}});
  system.add(HalfPlane{.normal = {0.0, 1.0}},
             Surface{.friction = friction, .normal_restitution = 0.0, .rolling_resistance = 0.02});
  const BodyId box = add_box(system, mass, 0.4, 0.2, {0.0, 0.1}, 0.0, {speed, 0.0});
  Simulation simulation(system, EventDriven{});
  simulation.run_until(3.0);
  EXPECT_NEAR(simulation.state().position(box)[0], 0.5 * speed * speed / (friction * g), 1e-13);
  EXPECT_EQ(simulation.state().spin(box), 0.0);
  EXPECT_EQ(simulation.energy().flow(EnergyFlow::rolling), 0.0);
  for (const double time : times_of(simulation, EventKind::stick)) {
    EXPECT_NEAR(time, speed / (friction * g), 1e-13);
  }
}

}  // namespace
