// Errors of smooth motion are the same wherever the zero of coordinates and angles is: tolerances are
// relative to how far bodies have moved and to their size, not to where they are.

#include <carom/carom.h>

#include "tests/integrators/event_run.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace {

using namespace carom;
using namespace carom::planar;

constexpr double end = 3.0, far = 1048576.0;  // 2^20: what is added to it is rounded once
constexpr double resolution = 1.2e-10;        // distance of the numbers there
constexpr FlowMethod methods[] = {FlowMethod::explicit_runge_kutta, FlowMethod::adams, FlowMethod::bdf,
                                  FlowMethod::one_step};

// Near the origin errors are up to 6e-9; besides, rounding moves the places of a hundred steps and more at
// random. With tolerances of the coordinates themselves they were up to 3e-7 far from it.
constexpr double allowed = 8e-9 + 100.0 * resolution;

double oscillator_error(double at, FlowMethod method) {
  constexpr double stiffness = 100.0, amplitude = 0.5;
  System system;
  const BodyId mass = system.add(Particle{.mass = 1.0, .position = {at + amplitude, at}});
  system.add(SpringDamper{.from = {ground, {at, at}}, .to = mass, .stiffness = stiffness});
  Simulation simulation(system, EventDriven{.method = method});
  simulation.run_until(end);
  const double exact = amplitude * std::cos(std::sqrt(stiffness) * end);
  return std::hypot(simulation.state().position(mass)[0] - at - exact,
                    simulation.state().position(mass)[1] - at);
}

TEST(EventOrigin, AnOscillatorIsAsExactFarFromTheOrigin) {
  for (const FlowMethod method : methods) {
    EXPECT_LT(oscillator_error(0.0, method), allowed) << static_cast<int>(method);
    EXPECT_LT(oscillator_error(far, method), allowed) << static_cast<int>(method);
  }
}

double flywheel_error(double turned, FlowMethod method) {
  constexpr double stiffness = 5.0, inertia = 0.05, amplitude = 1.0;
  System system;
  const BodyId wheel = system.add(RigidBody{
      .mass = {.mass = 1.0, .inertia = inertia}, .position = {0.0, 0.0}, .angle = turned + amplitude});
  system.add(TorsionalSpring{.from = ground, .to = wheel, .stiffness = stiffness, .free_angle = turned});
  Simulation simulation(system, EventDriven{.method = method});
  simulation.run_until(end);
  const double exact = amplitude * std::cos(std::sqrt(stiffness / inertia) * end);
  return std::abs(simulation.state().angle(wheel) - turned - exact);
}

TEST(EventOrigin, AFlywheelIsAsExactAfterManyTurns) {
  for (const FlowMethod method : methods) {
    EXPECT_LT(flywheel_error(0.0, method), allowed) << static_cast<int>(method);
    EXPECT_LT(flywheel_error(far, method), allowed) << static_cast<int>(method);
  }
}

/// Two rods and a disc that swing, and strike a wall; where the disc is, from the first hinge.
Vec<2> double_pendulum_end(double at, FlowMethod method) {
  System system;
  const Vec<2> zero(at, -at);
  system.add(Gravity{{0.0, -9.81}});
  system.add(HalfPlane{.point = zero + Vec<2>(0.0, -1.2), .normal = {0.0, 1.0}},
             Surface{.friction = 0.2, .normal_restitution = 0.6});
  const auto add_rod = [&](double x) {
    return system.add(RigidBody{.mass = rod(1.0, 1.0), .position = zero + Vec<2>(x, 0.0)});
  };
  const BodyId upper = add_rod(0.5), lower = add_rod(1.5);
  system.add(Disc{.body = lower, .radius = 0.1, .centre = {0.5, 0.0}});
  system.add(Revolute{.from = {ground, zero}, .to = {upper, {-0.5, 0.0}}});
  system.add(Revolute{.from = {upper, {0.5, 0.0}}, .to = {lower, {-0.5, 0.0}}});
  Simulation simulation(system, EventDriven{.method = method});
  simulation.run_until(1.0);  // before small errors have grown
  EXPECT_GT(simulation.statistics().impacts, 0);
  return simulation.state().position(lower) - zero;
}

TEST(EventOrigin, APendulumThatStrikesMovesAlikeFarFromTheOrigin) {
  for (const FlowMethod method : methods) {
    const Vec<2> near_end = double_pendulum_end(0.0, method), far_end = double_pendulum_end(far, method);
    EXPECT_LT((far_end - near_end).norm(), allowed) << static_cast<int>(method);
  }
}

}  // namespace
