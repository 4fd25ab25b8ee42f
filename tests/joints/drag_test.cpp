#include <carom/joints/drag.h>
#include <carom/testing/loaded_model.h>

#include "tests/joints/element_pairs.h"
#include "tests/model_error.h"

namespace {

using namespace carom;
using namespace carom::planar;
using namespace carom_test;

TEST(Drag, ClosedFormInSpace) {
  System system;
  const BodyId body = system.add(spatial::Particle{.mass = 1.0, .velocity = {1, 2, 2}});
  system.add(spatial::Drag{.on = body, .linear = 2.0, .quadratic = 5.0});
  LoadedModel model(system);
  expect_near(model.dissipative, {-17, -34, -34}, 1e-13);
  EXPECT_EQ(largest(model.conservative), 0.0);
  EXPECT_EQ(largest(model.external), 0.0);
  EXPECT_NEAR(model.power(model.dissipative), -17.0 * 9.0, 1e-12);
}

TEST(Drag, OffTheCentreItSlowsTheSpin) {
  System system;
  const BodyId plate = system.add(RigidBody{.mass = disc(1.0, 1.0), .spin = 3.0});
  system.add(Drag{.on = {plate, {0.5, 0.0}}, .linear = 2.0});  // moves up with 1.5 m/s
  const LoadedModel model(system);
  expect_near(model.dissipative, {0, -3, -1.5}, 1e-14);
}

TEST(Drag, TakesEnergyFromEveryMotion) {
  Random random(241);
  for (int repeat = 0; repeat < 100; ++repeat) {
    const Bodies bodies(random);
    System system = bodies.system;
    const double linear = random.uniform(0.0, 2.0), quadratic = random.uniform(0.0, 2.0);
    const End<2> on(bodies.plates[0], random.vec<2>());
    system.add(Drag{.on = on, .linear = linear, .quadratic = quadratic});
    const LoadedModel model(system);
    EXPECT_LT(model.power(model.dissipative), 0.0);
  }
}

TEST(Drag, SpeedFallsAsInTheClosedFormWithOrderTwo) {
  // m v' = -(c1 + c2 v) v:  v = c1 v0 e/(c1 + c2 v0 (1 - e)), e = exp(-c1 t/m).
  System system;
  const Vec<2> direction(0.6, 0.8);
  const BodyId dot = system.add(Particle{.mass = 2.0, .velocity = 10.0 * direction});
  constexpr double c1 = 0.8, c2 = 0.3;
  system.add(Drag{.on = dot, .linear = c1, .quadratic = c2});
  const auto error = [&](const Simulation& now) {
    const double e = std::exp(-c1 * now.time() / 2.0);
    const double exact = c1 * 10.0 * e / (c1 + c2 * 10.0 * (1.0 - e));
    return std::abs(now.state().velocity(dot).dot(direction) - exact);
  };
  EXPECT_NEAR(measured_order(system, 2.0, 2e-2, error), 2.0, 0.05);
  Simulation simulation(system, TimeStepping{.step = 1e-3});
  simulation.run_until(2.0);
  EXPECT_LE(error(simulation), 1e-6);
  // All that is gone went into the drag, but for what the iteration leaves open: up to 1e-9 m/s per step.
  EXPECT_NEAR(simulation.energy().flow(EnergyFlow::dashpot), 100.0 - simulation.energy().kinetic(), 1e-6);
  expect_ledger_closes(system, 2.0);
}

TEST(Drag, ImpossibleParametersAreRefusedByName) {
  System system;
  const BodyId dot = system.add(Particle{.mass = 1.0}, "dot");
  EXPECT_MODEL_ERROR(system.add(Drag{.linear = 1.0}), "drag #0", "on is not given");
  EXPECT_MODEL_ERROR(system.add(Drag{.on = {dot, {1, 0}}, .linear = 1.0}), "drag #0",
                     "on, off the centre, is particle 'dot'");
  EXPECT_MODEL_ERROR(system.add(Drag{.on = ground, .linear = 1.0}), "drag #0", "is ground");
  EXPECT_MODEL_ERROR(system.add(Drag{.on = dot, .linear = -1.0}, "air"), "drag 'air'", "linear is -1 N s/m");
  EXPECT_MODEL_ERROR(system.add(Drag{.on = dot, .quadratic = -2.0}), "drag #0", "quadratic is -2 N s^2/m^2");
  EXPECT_TRUE(system.elements().empty());
}

}  // namespace
