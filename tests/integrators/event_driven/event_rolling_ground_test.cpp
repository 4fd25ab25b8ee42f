// Rolling resistance in event-driven mode on ground that moves: the moment acts against the spin relative to
// that of the ground, and the ground does work.

#include "tests/integrators/event_driven/body_scenes.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace {

using namespace body_scenes;

constexpr double radius = 0.2, mass = 1.5, inertia = 0.5 * mass * radius * radius;

std::vector<double> times_of(const Simulation& simulation, EventKind kind) {
  std::vector<double> times;
  for (const EventRecord& event : simulation.events()) {
    if (event.kind == kind) times.push_back(event.time);
  }
  return times;
}

PrescribedMotion turning(double spin) {
  return {.angle = [spin](double t) { return spin * t; },
          .spin = [spin](double) { return spin; },
          .angular_acceleration = [](double) { return 0.0; }};
}

TEST(EventRollingGround, ImpactOnGroundThatTurns) {
  // A disc falls without spin on ground that turns about where it is hit, without friction: M = rho P_n.
  constexpr double rho = 0.01, turn = 0.5, e = 0.5, speed = 1.0;
  for (const bool pieces : {false, true}) {
    System system;
    const Surface law{.friction = 0.0, .normal_restitution = e, .rolling_resistance = rho};
    if (pieces) {
      system.add(planar::Block{.vertices = {{-1, -1}, {1, -1}, {1, 0}, {-1, 0}}, .motion = turning(turn)},
                 law);
    } else {
      system.add(HalfPlane{.normal = {0.0, 1.0}, .motion = turning(turn)}, law);
    }
    const BodyId disc = add_disc(system, mass, radius, {0.0, radius}, {0.0, -speed});
    Simulation simulation(system, EventDriven{});
    simulation.run_until(1e-9);
    // The bound is 30 times what it takes: the disc turns with the ground.
    EXPECT_NEAR(simulation.state().spin(disc), turn, 1e-12) << pieces;
    EXPECT_NEAR(simulation.energy().flow(EnergyFlow::rolling), 0.5 * inertia * turn * turn, 1e-13) << pieces;
    EXPECT_LE(std::abs(simulation.energy().residual()), 1e-13) << pieces;
  }
}

TEST(EventRollingGround, ADiscRollsWhereItIsInADrumThatTurns) {
  // The moment of its weight about where it touches is rho P_n: it stays at the angle atan(rho/r).
  constexpr double rho = 0.02, spin = 2.0, drum_radius = 1.0, time = 2.0;
  const double angle = std::atan(rho / radius);
  System system;
  system.add(Gravity{{0.0, -g}});
  system.add(drum({0.0, 0.0}, drum_radius, spin),
             Surface{.friction = 0.8, .normal_restitution = 0.0, .rolling_resistance = rho});
  const double rolls = spin * drum_radius / radius;
  const Vec<2> place = (drum_radius - radius) * Vec<2>(std::sin(angle), -std::cos(angle));
  const BodyId disc = add_disc(system, mass, radius, place, {0.0, 0.0}, rolls);
  Simulation simulation(system, EventDriven{});
  simulation.run_until(time);
  // A balance that is stable: errors of the integrator.
  EXPECT_LT((simulation.state().position(disc) - place).norm(), 1e-9);
  EXPECT_NEAR(simulation.state().spin(disc), rolls, 1e-8);
  const double moment = rho * mass * g * std::cos(angle);
  EXPECT_NEAR(simulation.energy().flow(EnergyFlow::rolling), moment * (rolls - spin) * time, 1e-8);
  EXPECT_NEAR(simulation.energy().flow(EnergyFlow::external), moment * (rolls - spin) * time, 1e-8);
  EXPECT_LE(std::abs(simulation.energy().residual()), 1e-9);
}

TEST(EventRollingGround, ADiscOnAConveyorRollsUntilItMovesWithTheBelt) {
  // Seen from the belt, which moves with b, the disc comes to rest: at rest on it at first, rolling without
  // slip, it has the spin b/r and the acceleration rho g/(r (1 + k)).
  constexpr double rho = 0.01, k = 0.5;
  const double belt = 0.6;
  System system;
  system.add(Gravity{{0.0, -g}});
  const PrescribedMotion motion{.displacement = [belt](double t) { return Vec<2>(belt * t, 0.0); },
                                .velocity = [belt](double) { return Vec<2>(belt, 0.0); },
                                .acceleration = [](double) { return Vec<2>(0.0, 0.0); }};
  system.add(HalfPlane{.normal = {0.0, 1.0}, .motion = motion},
             Surface{.friction = 1.0, .normal_restitution = 0.0, .rolling_resistance = rho});
  const BodyId disc = add_disc(system, mass, radius, {0.0, radius}, {0.0, 0.0}, belt / radius);
  Simulation simulation(system, EventDriven{});
  const double acceleration = rho * g / (radius * (1.0 + k)), end = belt / acceleration;
  simulation.run_until(0.5 * end);
  EXPECT_NEAR(simulation.state().velocity(disc)[0], 0.5 * belt, 1e-11);
  simulation.run_until(2.0 * end);
  const std::vector<double> holds = times_of(simulation, EventKind::hold);
  ASSERT_EQ(holds.size(), 1U);
  EXPECT_NEAR(holds[0], end, 1e-11);
  EXPECT_NEAR(simulation.state().velocity(disc)[0], belt, 1e-12);
  EXPECT_NEAR(simulation.state().spin(disc), 0.0, 1e-12);
  EXPECT_NEAR(simulation.state().position(disc)[0], 1.5 * belt * end, 1e-11);
  const double lost = 0.5 * (1.0 + k) * mass * belt * belt;
  EXPECT_NEAR(simulation.energy().flow(EnergyFlow::rolling), lost, 1e-11);
  EXPECT_LE(std::abs(simulation.energy().residual()), 1e-11);
}

TEST(EventRollingGround, APlaneThatTiltsTakesADiscAlongUntilItRolls) {
  // The plane turns with W about where the disc touches it, and the disc with it, as one body: its centre has
  // W^2 r towards the plane. It begins to roll where g r sin(a) = rho (g cos(a) - W^2 r).
  constexpr double rho = 0.02, turn = -0.05;
  for (const bool again : {false, true}) {  // whether modes are found anew under way
    System system;
    system.add(Gravity{{0.0, -g}});
    system.add(HalfPlane{.normal = {0.0, 1.0}, .motion = turning(turn)},
               Surface{.friction = 2.0, .normal_restitution = 0.0, .rolling_resistance = rho});
    const BodyId disc = add_disc(system, mass, radius, {0.0, radius}, {-turn * radius, 0.0}, turn);
    Simulation simulation(system, EventDriven{});
    const double amplitude = std::hypot(radius, rho) * g;
    const double angle = std::atan(rho / radius) - std::asin(rho * turn * turn * radius / amplitude);
    const double begins = angle / std::abs(turn);
    simulation.run_until(0.9 * begins);
    EXPECT_NEAR(simulation.state().spin(disc), turn, 1e-12);
    EXPECT_EQ(times_of(simulation, EventKind::roll).size(), 0U);
    if (again) simulation.set_state(simulation.state());
    simulation.run_until(begins + 0.1);
    const std::vector<double> rolls = times_of(simulation, EventKind::roll);
    ASSERT_EQ(rolls.size(), 1U);
    // The moment grows with 0.05/s of its bound: the event is as exact as forces are.
    EXPECT_NEAR(rolls[0], begins, 1e-7);
    EXPECT_LT(simulation.state().spin(disc), turn - 1e-4);
    EXPECT_LE(std::abs(simulation.energy().residual()), 1e-10);
  }
}

TEST(EventRollingGround, ARockingPlaneHoldsADisc) {
  // The angle A sin(W t) stays below atan(rho/r): the disc turns with the plane, which is faster and slower.
  constexpr double rho = 0.02;
  const double size = 0.04, rate = 1.5;
  System system;
  system.add(Gravity{{0.0, -g}});
  const PrescribedMotion motion{
      .angle = [size, rate](double t) { return size * std::sin(rate * t); },
      .spin = [size, rate](double t) { return size * rate * std::cos(rate * t); },
      .angular_acceleration = [size, rate](double t) { return -size * rate * rate * std::sin(rate * t); }};
  system.add(HalfPlane{.normal = {0.0, 1.0}, .motion = motion},
             Surface{.friction = 2.0, .normal_restitution = 0.0, .rolling_resistance = rho});
  const BodyId disc =
      add_disc(system, mass, radius, {0.0, radius}, {-size * rate * radius, 0.0}, size * rate);
  Simulation simulation(system, EventDriven{});
  for (const double time : {1.0, 3.0, 10.0}) {
    simulation.run_until(time);
    const double angle = motion.angle(time);
    // Errors of 10 s of integration at the tolerance 1e-10.
    EXPECT_NEAR(simulation.state().spin(disc), motion.spin(time), 1e-9) << time;
    EXPECT_NEAR(simulation.state().angle(disc), angle, 1e-8) << time;
    const Vec<2> place = radius * Vec<2>(-std::sin(angle), std::cos(angle));
    EXPECT_LE((simulation.state().position(disc) - place).norm(), 1e-8) << time;
  }
  EXPECT_EQ(times_of(simulation, EventKind::roll).size(), 0U);
  EXPECT_NEAR(simulation.energy().flow(EnergyFlow::rolling), 0.0, 1e-12);
  EXPECT_LE(std::abs(simulation.energy().residual()), 1e-9);
}

}  // namespace
