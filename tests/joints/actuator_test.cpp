#include <carom/joints/actuator.h>
#include <carom/testing/loaded_model.h>

#include "tests/joints/element_pairs.h"
#include "tests/model_error.h"

namespace {

using namespace carom;
using namespace carom::planar;
using namespace carom_test;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

TEST(LinearActuator, PushesTheEndsApart) {
  System system;
  const BodyId a = system.add(spatial::Particle{.mass = 1.0});
  const BodyId b = system.add(spatial::Particle{.mass = 1.0, .position = {2, 4, 4}, .velocity = {1, 2, 2}});
  system.add(spatial::LinearActuator{
      .from = a, .to = b, .force = [](double t, double l, double v) { return t + 10.0 * l + 100.0 * v; }});
  LoadedModel model(system);
  model.state.time = 9.0;
  model.update();
  expect_near(model.external, {-123, -246, -246, 123, 246, 246}, 1e-12);  // 369 N
  EXPECT_EQ(largest(model.conservative), 0.0);
  EXPECT_EQ(largest(model.dissipative), 0.0);
}

TEST(LinearActuator, ActionIsReactionAndPowerIsForceTimesRate) {
  Random random(251);
  for (int repeat = 0; repeat < 20; ++repeat) {
    const Bodies bodies(random);
    for (const auto& [from, to] : pairs_of_ends(bodies, random)) {
      System system = bodies.system;
      double power = 0.0;
      system.add(LinearActuator{.from = from, .to = to, .force = [&](double, double length, double rate) {
                                  power = (length + rate) * rate;
                                  return length + rate;
                                }});
      const LoadedModel model(system);
      EXPECT_NEAR(model.power(model.external), power, 1e-12 * (1.0 + largest(model.external)));
      if (from.body != ground && to.body != ground) expect_action_is_reaction(model);
    }
  }
}

TEST(LinearActuator, DrivesTwoMassesApartWithOrderTwo) {
  // Reduced mass 2/3, force 6 cos 2t: the distance is 1 + 6/(4 * 2/3) (1 - cos 2t).
  System system;
  const BodyId a = system.add(Particle{.mass = 1.0});
  const BodyId b = system.add(Particle{.mass = 2.0, .position = {0.6, 0.8}});
  system.add(LinearActuator{
      .from = a, .to = b, .force = [](double t, double, double) { return 6.0 * std::cos(2.0 * t); }});
  const auto error = [&](const Simulation& now) {
    const double distance = (now.state().position(b) - now.state().position(a)).norm();
    return std::abs(distance - 1.0 - 2.25 * (1.0 - std::cos(2.0 * now.time())));
  };
  EXPECT_NEAR(measured_order(system, 1.0, 1e-2, error), 2.0, 0.05);
  Simulation simulation(system, TimeStepping{.step = 1e-3});
  simulation.run_until(1.0);
  EXPECT_LE(error(simulation), 1e-5);
  EXPECT_NEAR(simulation.energy().flow(EnergyFlow::external), simulation.energy().kinetic(), 1e-8);
  expect_ledger_closes(system, 1.0);
}

TEST(RotaryActuator, TurnsOneBodyAgainstTheOther) {
  System system;
  const BodyId a = system.add(RigidBody{.mass = disc(1.0, 1.0), .angle = 1.0, .spin = 0.5});
  const BodyId b = system.add(RigidBody{.mass = disc(1.0, 1.0), .angle = 10.0, .spin = 3.0});
  const auto law = [](double t, double angle, double rate) { return t + 10.0 * angle + 100.0 * rate; };
  system.add(RotaryActuator{.from = a, .to = b, .torque = law});
  LoadedModel model(system);
  model.state.time = 2.0;
  model.update();
  expect_near(model.external, {0, 0, -342, 0, 0, 342}, 1e-12);
  expect_action_is_reaction(model);
  System grounded;
  const BodyId c = grounded.add(RigidBody{.mass = disc(1.0, 1.0), .angle = 2.0, .spin = 1.0});
  grounded.add(RotaryActuator{.from = c, .to = ground, .torque = law});
  expect_near(LoadedModel(grounded).external, {0, 0, 120}, 1e-13);
}

TEST(RotaryActuator, AMotorReachesItsSpeedWithOrderTwo) {
  // J w' = M (1 - w/W): w = W (1 - exp(-M t/(J W))), J = 1.
  System system;
  const BodyId rotor = system.add(RigidBody{.mass = disc(2.0, 1.0)});
  system.add(RotaryActuator{.from = ground, .to = rotor, .torque = [](double, double, double rate) {
                              return 12.0 * (1.0 - rate / 8.0);
                            }});
  const auto error = [&](const Simulation& now) {
    return std::abs(now.state().spin(rotor) - 8.0 * (1.0 - std::exp(-1.5 * now.time())));
  };
  EXPECT_NEAR(measured_order(system, 1.0, 2e-2, error), 2.0, 0.05);
  Simulation simulation(system, TimeStepping{.step = 1e-3});
  simulation.run_until(1.0);
  EXPECT_LE(error(simulation), 1e-5);
  // But for what the iteration leaves open: up to 1e-9 rad/s per step.
  EXPECT_NEAR(simulation.energy().flow(EnergyFlow::external), simulation.energy().kinetic(), 1e-6);
  expect_ledger_closes(system, 1.0);
}

TEST(Actuators, ImpossibleParametersAreRefusedByName) {
  System system;
  const BodyId dot = system.add(Particle{.mass = 1.0, .position = {3, 4}, .velocity = {3, 4}}, "dot");
  const BodyId plate = system.add(RigidBody{.mass = disc(1.0, 1.0), .angle = 0.25, .spin = -0.5}, "plate");
  const auto good = [](double, double, double) { return 1.0; };
  // Finite everywhere but at the start.
  const auto bad = [](double t, double, double) { return t > 0.0 ? 1.0 : nan; };
  EXPECT_MODEL_ERROR(system.add(LinearActuator{.to = dot, .force = good}), "linear actuator #0",
                     "from is not given");
  EXPECT_MODEL_ERROR(system.add(LinearActuator{.from = dot, .to = dot, .force = good}), "as from");
  EXPECT_MODEL_ERROR(system.add(LinearActuator{.from = ground, .to = dot}, "ram"), "linear actuator 'ram'",
                     "force is not given");
  EXPECT_MODEL_ERROR(system.add(LinearActuator{.from = ground, .to = dot, .force = bad}),
                     "linear actuator #0", "force at time 0, length 5 m, rate 5 m/s is nan N");
  EXPECT_MODEL_ERROR(system.add(RotaryActuator{.from = ground, .to = dot, .torque = good}),
                     "rotary actuator #0", "to is particle 'dot'");
  EXPECT_MODEL_ERROR(system.add(RotaryActuator{.from = ground, .to = plate}, "motor"),
                     "rotary actuator 'motor'", "torque is not given");
  EXPECT_MODEL_ERROR(system.add(RotaryActuator{.from = plate, .to = ground, .torque = bad}),
                     "rotary actuator #0", "torque at time 0, angle -0.25 rad, rate 0.5 rad/s is nan N m");
  EXPECT_TRUE(system.elements().empty());
  // Where there is no direction the law is not asked.
  system.add(LinearActuator{.from = {ground, {3, 4}}, .to = dot, .force = bad});
  EXPECT_EQ(largest(LoadedModel(system).external), 0.0);
}

}  // namespace
