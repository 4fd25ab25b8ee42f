#include <carom/joints/nonlinear_spring.h>
#include <carom/testing/loaded_model.h>

#include "tests/joints/element_pairs.h"
#include "tests/model_error.h"

#include <numbers>

namespace {

using namespace carom;
using namespace carom::planar;
using namespace carom_test;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// Hardening: T = k s + h s^3 with s = l - L.
template <class Part>
Part hardening(double k, double h, double length) {
  Part part;
  part.force = [=](double l) { return k * (l - length) + h * std::pow(l - length, 3); };
  part.potential_of = [=](double l) {
    return 0.5 * k * std::pow(l - length, 2) + 0.25 * h * std::pow(l - length, 4);
  };
  return part;
}

TEST(NonlinearSpring, ClosedFormInSpace) {
  System system;
  const BodyId a = system.add(spatial::Particle{.mass = 1.0});
  const BodyId b = system.add(spatial::Particle{.mass = 1.0, .position = {2, 4, 4}, .velocity = {1, 2, 2}});
  auto spring = hardening<spatial::NonlinearSpring>(1.0, 2.0, 5.0);  // 3 N at length 6
  spring.from = a;
  spring.to = b;
  spring.damping = 2.0;  // rate 3 m/s
  system.add(spring);
  LoadedModel model(system);
  expect_near(model.conservative, {1, 2, 2, -1, -2, -2}, 1e-14);
  expect_near(model.dissipative, {2, 4, 4, -2, -4, -4}, 1e-14);
  EXPECT_NEAR(model.energies()[StoredEnergy::elastic], 1.0, 1e-14);
  expect_near(model.conservative, model.minus_gradient(), 1e-10);
}

TEST(NonlinearSpring, ObeysTheLawsOfElements) {
  Random random(211);
  for (int repeat = 0; repeat < 20; ++repeat) {
    const Bodies bodies(random);
    for (const auto& [from, to] : pairs_of_ends(bodies, random)) {
      System system = bodies.system;
      auto spring = hardening<NonlinearSpring>(random.uniform(0.5, 3.0), random.uniform(0.0, 1.0),
                                               random.uniform(1.0, 5.0));
      spring.from = from;
      spring.to = to;
      spring.damping = random.uniform(0.1, 2.0);
      system.add(spring);
      LoadedModel model(system);
      expect_near(model.conservative, model.minus_gradient(), 1e-8);  // forces are below 200 N
      EXPECT_LT(model.power(model.dissipative), 0.0);
      if (from.body != ground && to.body != ground) expect_action_is_reaction(model);
    }
  }
}

TEST(NonlinearSpring, EndsThatCoincideFeelNothing) {
  System system;
  const BodyId dot = system.add(Particle{.mass = 1.0, .velocity = {1, 0}});
  NonlinearSpring spring{.from = ground, .to = dot, .damping = 1.0};
  spring.force = [](double l) { return 1.0 / l; };
  spring.potential_of = [](double l) { return std::log(1.0 + l); };
  system.add(spring);
  const LoadedModel model(system);
  EXPECT_EQ(largest(model.conservative), 0.0);
  EXPECT_EQ(largest(model.dissipative), 0.0);
}

TEST(NonlinearSpring, PeriodOfACubicOscillator) {
  // x'' = -x^3 with amplitude A: period 4 K(1/sqrt 2)/A = 7.416298709205487/A (Landau and Lifshitz,
  // Mechanics, section 11, problem 2a with n = 4). The line passes at length 5 +- 1, never at 0.
  System system;
  const BodyId dot = system.add(Particle{.mass = 1.0, .position = {6, 0}});
  auto spring = hardening<NonlinearSpring>(0.0, 1.0, 5.0);
  spring.from = ground;
  spring.to = dot;
  system.add(spring);
  constexpr double period = 7.416298709205487;
  // At a quarter of the period the mass passes the middle with the speed sqrt(1/2).
  const auto error = [&](const Simulation& now) { return std::abs(now.state().position(dot)[0] - 5.0); };
  EXPECT_NEAR(measured_order(system, 1.25 * period, 1e-2, error), 2.0, 0.1);
  Simulation simulation(system, TimeStepping{.step = 1e-3});
  simulation.run_until(1.25 * period);
  EXPECT_NEAR(error(simulation), 0.0, 1e-5);
  EXPECT_NEAR(simulation.state().velocity(dot)[0], -std::sqrt(0.5), 1e-5);
}

TEST(NonlinearSpring, RunsCloseTheirAccount) {
  Random random(212);
  const Bodies bodies(random);
  System system = bodies.system;
  auto spring = hardening<NonlinearSpring>(20.0, 30.0, 2.0);
  spring.from = {bodies.plates[0], {0.2, 0.1}};
  spring.to = {bodies.plates[1], {-0.3, 0.2}};
  spring.damping = 0.4;
  system.add(spring);
  expect_ledger_closes(system, 3.0);
}

TEST(NonlinearSpring, AForceThatIsLostOnTheWayEndsTheStepByName) {
  System system;
  const BodyId dot = system.add(Particle{.mass = 1.0, .position = {1, 0}, .velocity = {1, 0}});
  NonlinearSpring spring{.from = ground, .to = dot};
  spring.force = [](double l) { return l < 1.5 ? 0.0 : nan; };
  spring.potential_of = [](double) { return 0.0; };
  system.add(spring, "thread");
  Simulation simulation(system, TimeStepping{.step = 1e-2});
  try {
    simulation.run_until(1.0);
    ADD_FAILURE() << "nothing was thrown";
  } catch (const SolverError& error) {
    EXPECT_NE(std::string(error.what()).find("nonlinear spring 'thread'"), std::string::npos) << error.what();
  }
  EXPECT_NEAR(simulation.time(), 0.5, 0.02);
}

TEST(NonlinearSpring, APotentialThatDoesNotFitIsFoundOnRequest) {
  auto spring = hardening<NonlinearSpring>(2.0, 3.0, 1.0);
  EXPECT_NO_THROW(spring.check_potential(0.0, 3.0));
  EXPECT_NO_THROW(spring.check_potential(0.5, 0.6, 1e-12));
  const auto right = spring.potential_of;
  spring.potential_of = [right](double l) { return (1.0 + 1e-6) * right(l); };
  EXPECT_MODEL_ERROR(spring.check_potential(0.0, 3.0), "nonlinear spring: growth of potential_of from length",
                     "allowed: the work of force");
  EXPECT_NO_THROW(spring.check_potential(0.0, 3.0, 1e-5));
  spring.potential_of = [right](double l) { return l < 2.0 ? right(l) : right(l) + 1e-6; };  // a step
  EXPECT_MODEL_ERROR(spring.check_potential(0.0, 3.0), "from length 1.96875 m to 2.015625 m");
  spring.potential_of = [right](double l) { return -right(l); };  // the wrong sign
  EXPECT_MODEL_ERROR(spring.check_potential(0.0, 3.0, 0.1), "nonlinear spring: growth");
}

TEST(NonlinearSpring, ARequestThatCannotBeIsRefused) {
  auto spring = hardening<NonlinearSpring>(2.0, 3.0, 1.0);
  EXPECT_MODEL_ERROR(spring.check_potential(-1.0, 3.0), "shortest is -1 m");
  EXPECT_MODEL_ERROR(spring.check_potential(2.0, 2.0), "longest is 2 m", "> shortest");
  EXPECT_MODEL_ERROR(spring.check_potential(1.0, 2.0, 0.0), "tolerance is 0");
  EXPECT_MODEL_ERROR(NonlinearSpring{}.check_potential(1.0, 2.0), "force is not given");
  spring.force = [](double l) { return l < 2.5 ? 0.0 : nan; };
  EXPECT_MODEL_ERROR(spring.check_potential(1.0, 3.0), "force at length 2.5", "is nan");
  spring.potential_of = nullptr;
  EXPECT_MODEL_ERROR(spring.check_potential(1.0, 2.0), "potential_of is not given");
}

TEST(NonlinearSpring, ImpossibleParametersAreRefusedByName) {
  System system;
  const BodyId dot = system.add(Particle{.mass = 1.0, .position = {3, 4}}, "dot");
  const BodyId plate =
      system.add(RigidBody{.mass = disc(1.0, 1.0), .position = {1, 4}, .angle = std::numbers::pi}, "plate");
  const auto good = hardening<NonlinearSpring>(1.0, 0.0, 1.0);
  NonlinearSpring spring = good;
  EXPECT_MODEL_ERROR(system.add(spring), "nonlinear spring #0", "from is not given");
  spring.from = ground;
  spring.to = dot;
  spring.damping = -1.0;
  EXPECT_MODEL_ERROR(system.add(spring, "band"), "nonlinear spring 'band'", "damping is -1 N s/m");
  spring.damping = 0.0;
  spring.force = nullptr;
  EXPECT_MODEL_ERROR(system.add(spring), "nonlinear spring #0", "force is not given");
  spring.force = [](double) { return nan; };
  EXPECT_MODEL_ERROR(system.add(spring), "nonlinear spring #0", "force at length 5 m is nan N");
  // Between points of bodies: (1, 4) - (1, 0) to (3, 4).
  spring.from = {plate, {1, 0}};
  EXPECT_MODEL_ERROR(system.add(spring), "nonlinear spring #0", "force at length 3 m is nan N");
  spring.force = good.force;
  spring.potential_of = nullptr;
  EXPECT_MODEL_ERROR(system.add(spring), "nonlinear spring #0", "potential_of is not given");
  spring.potential_of = [](double) { return nan; };
  EXPECT_MODEL_ERROR(system.add(spring), "nonlinear spring #0", "potential_of at length 3 m is nan J");
  EXPECT_TRUE(system.elements().empty());
}

}  // namespace
