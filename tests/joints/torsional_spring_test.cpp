#include <carom/joints/torsional_spring.h>
#include <carom/testing/loaded_model.h>

#include "tests/joints/element_pairs.h"
#include "tests/model_error.h"

namespace {

using namespace carom;
using namespace carom::planar;
using namespace carom_test;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

TEST(TorsionalSpring, ClosedFormCountsTurns) {
  System system;
  const BodyId a = system.add(RigidBody{.mass = disc(1.0, 1.0), .angle = 0.5, .spin = 1.0});
  const BodyId b = system.add(RigidBody{.mass = disc(1.0, 1.0), .angle = 10.5, .spin = 4.0});
  system.add(TorsionalSpring{.from = a, .to = b, .stiffness = 2.0, .damping = 0.5, .free_angle = 1.0});
  LoadedModel model(system);
  expect_near(model.conservative, {0, 0, 18, 0, 0, -18}, 1e-14);
  expect_near(model.dissipative, {0, 0, 1.5, 0, 0, -1.5}, 1e-14);
  EXPECT_NEAR(model.energies()[StoredEnergy::elastic], 81.0, 1e-12);
  EXPECT_EQ(model.assembly.components().size(), 1U);
}

TEST(TorsionalSpring, ObeysTheLawsOfElements) {
  Random random(221);
  for (int repeat = 0; repeat < 50; ++repeat) {
    const Bodies bodies(random);
    const std::pair<BodyId, BodyId> pairs[] = {
        {bodies.plates[0], bodies.plates[1]}, {ground, bodies.plates[1]}, {bodies.plates[0], ground}};
    for (const auto& [from, to] : pairs) {
      System system = bodies.system;
      system.add(TorsionalSpring{.from = from,
                                 .to = to,
                                 .stiffness = random.uniform(0.1, 3.0),
                                 .damping = random.uniform(0.1, 3.0),
                                 .free_angle = random.uniform(-4.0, 4.0)});
      LoadedModel model(system);
      expect_near(model.conservative, model.minus_gradient(), 1e-10);
      EXPECT_LT(model.power(model.dissipative), 0.0);
      if (from != ground && to != ground) expect_action_is_reaction(model);
    }
  }
}

TEST(TorsionalSpring, ADampedOscillatorWithOrderTwo) {
  // Two discs of 1 and 3 kg m^2 turn against each other: J = 3/4, a'' = -(k (a - A) + c a')/J.
  System system;
  const BodyId a = system.add(RigidBody{.mass = disc(2.0, 1.0), .angle = -0.4, .spin = 0.3});
  const BodyId b = system.add(RigidBody{.mass = disc(6.0, 1.0), .angle = 0.8, .spin = -0.5});
  constexpr double k = 30.0, c = 0.6, free = 0.2, inertia = 0.75;
  system.add(TorsionalSpring{.from = a, .to = b, .stiffness = k, .damping = c, .free_angle = free});
  const auto exact = [](double t) {
    const double decay = 0.5 * c / inertia, w = std::sqrt(k / inertia - decay * decay);
    const double start = 1.2 - free, rate = -0.8;
    return free +
           std::exp(-decay * t) * (start * std::cos(w * t) + (rate + decay * start) / w * std::sin(w * t));
  };
  const auto error = [&](const Simulation& now) {
    return std::abs(now.state().angle(b) - now.state().angle(a) - exact(now.time()));
  };
  EXPECT_NEAR(measured_order(system, 2.0, 1e-2, error), 2.0, 0.05);
  Simulation simulation(system, TimeStepping{.step = 1e-3});
  simulation.run_until(2.0);
  EXPECT_LE(error(simulation), 1e-4);
  // Angular momentum about the axis: 1 * 0.3 - 3 * 0.5.
  EXPECT_NEAR(simulation.state().spin(a) + 3.0 * simulation.state().spin(b), -1.2, 1e-12);
  EXPECT_GT(simulation.energy().flow(EnergyFlow::dashpot), 1.0);
  expect_ledger_closes(system, 2.0);
}

TEST(TorsionalSpring, ImpossibleParametersAreRefusedByName) {
  System system;
  const BodyId dot = system.add(Particle{.mass = 1.0}, "dot");
  const BodyId plate = system.add(RigidBody{.mass = disc(1.0, 1.0)}, "plate");
  const auto made = [&](double k, double c, double free) {
    return TorsionalSpring{.from = ground, .to = plate, .stiffness = k, .damping = c, .free_angle = free};
  };
  EXPECT_MODEL_ERROR(system.add(TorsionalSpring{.to = plate}), "torsional spring #0", "from is not given");
  EXPECT_MODEL_ERROR(system.add(TorsionalSpring{.from = dot, .to = plate}), "from is particle 'dot'");
  EXPECT_MODEL_ERROR(system.add(TorsionalSpring{.from = plate, .to = dot}), "to is particle 'dot'");
  EXPECT_MODEL_ERROR(system.add(TorsionalSpring{.from = plate, .to = plate}), "'plate', as from");
  EXPECT_MODEL_ERROR(system.add(TorsionalSpring{.from = ground, .to = ground}), "ground, as from");
  EXPECT_MODEL_ERROR(system.add(made(-1, 0, 0), "rod"), "torsional spring 'rod'", "stiffness is -1 N m/rad");
  EXPECT_MODEL_ERROR(system.add(made(1, -2, 0)), "torsional spring #0", "damping is -2 N m s/rad");
  EXPECT_MODEL_ERROR(system.add(made(1, 0, nan)), "torsional spring #0", "free_angle is nan rad");
  EXPECT_TRUE(system.elements().empty());
}

}  // namespace
