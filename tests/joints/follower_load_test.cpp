#include <carom/joints/follower_load.h>
#include <carom/testing/loaded_model.h>

#include "tests/joints/element_pairs.h"
#include "tests/model_error.h"

namespace {

using namespace carom;
using namespace carom::planar;
using namespace carom_test;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

TEST(FollowerLoad, TurnsWithItsBody) {
  System system;
  const BodyId plate = system.add(RigidBody{.mass = disc(1.0, 1.0), .angle = 0.3}, "plate");
  system.add(FollowerLoad{.on = {plate, {0, 2}}, .force = [](double t) { return Vec<2>(3.0 + t, 4.0); }});
  LoadedModel model(system);
  for (const double angle : {0.3, 2.0, -7.0}) {
    model.state.angle(plate) = angle;
    model.state.time = angle;
    model.update();
    const double f = 3.0 + angle, c = std::cos(angle), s = std::sin(angle);
    // The moment is the same at every angle: both lever and force turn.
    expect_near(model.external, {c * f - s * 4.0, s * f + c * 4.0, -2.0 * f}, 1e-13);
  }
  EXPECT_EQ(largest(model.conservative), 0.0);
  EXPECT_EQ(largest(model.dissipative), 0.0);
}

TEST(FollowerLoad, AThrusterOnATurningBodyWithOrderTwo) {
  // Constant spin w, force f along the body's x axis through its centre: v = f/(m w) (sin wt, 1 - cos wt).
  System system;
  const BodyId plate = system.add(RigidBody{.mass = disc(2.0, 1.0), .spin = 3.0});
  system.add(FollowerLoad{.on = plate, .force = [](double) { return Vec<2>(5.0, 0.0); }});
  const auto error = [&](const Simulation& now) {
    const double a = 3.0 * now.time();
    return (now.state().velocity(plate) - 5.0 / 6.0 * Vec<2>(std::sin(a), 1.0 - std::cos(a))).norm();
  };
  EXPECT_NEAR(measured_order(system, 1.0, 1e-2, error), 2.0, 0.05);
  Simulation simulation(system, TimeStepping{.step = 1e-3});
  simulation.run_until(1.0);
  EXPECT_LE(error(simulation), 1e-5);
  EXPECT_NEAR(simulation.energy().flow(EnergyFlow::external), simulation.energy().kinetic() - 4.5, 1e-8);
  expect_ledger_closes(system, 1.0);
}

TEST(FollowerLoad, ImpossibleParametersAreRefusedByName) {
  System system;
  const BodyId dot = system.add(Particle{.mass = 1.0}, "dot");
  const BodyId plate = system.add(RigidBody{.mass = disc(1.0, 1.0)}, "plate");
  const auto push = [](double) { return Vec<2>(1.0, 0.0); };
  EXPECT_MODEL_ERROR(system.add(FollowerLoad{.force = push}), "follower load #0", "on is not given");
  EXPECT_MODEL_ERROR(system.add(FollowerLoad{.on = dot, .force = push}), "on is particle 'dot'",
                     "rigid body");
  EXPECT_MODEL_ERROR(system.add(FollowerLoad{.on = ground, .force = push}), "on is ground");
  EXPECT_MODEL_ERROR(system.add(FollowerLoad{.on = {plate, {nan, 0}}, .force = push}), "on.point is nan m");
  EXPECT_MODEL_ERROR(system.add(FollowerLoad{.on = plate}, "jet"), "follower load 'jet'",
                     "force is not given");
  EXPECT_MODEL_ERROR(system.add(FollowerLoad{.on = plate, .force = [](double) { return Vec<2>(0.0, nan); }}),
                     "follower load #0", "force at time 0 is nan N");
  EXPECT_TRUE(system.elements().empty());
}

}  // namespace
