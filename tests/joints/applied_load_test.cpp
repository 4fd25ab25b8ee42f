#include <carom/bodies/particle.h>
#include <carom/bodies/rigid_body.h>
#include <carom/joints/applied_load.h>

#include "tests/model_error.h"
#include <carom/testing/loaded_model.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using carom::energy_test::LoadedModel;

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

class AppliedLoadTest : public testing::Test {
protected:
  System system;
  BodyId dot = system.add(Particle{.mass = 1.0}, "dot");
  BodyId plate = system.add(RigidBody{.mass = disc(1.0, 1.0), .angle = 0.3}, "plate");
};

TEST_F(AppliedLoadTest, ForceIsAFunctionOfTimeInTheFixedFrame) {
  system.add(AppliedForce{.on = dot, .force = [](double t) { return Vec<2>(std::cos(t), 2.0 * t); }});
  LoadedModel model(system);
  EXPECT_EQ(model.external, (std::vector<double>{1, 0, 0, 0, 0}));
  model.state.time = 3.0;
  model.update();
  EXPECT_EQ(model.external, (std::vector<double>{std::cos(3.0), 6, 0, 0, 0}));
  EXPECT_EQ(model.conservative, std::vector<double>(5, 0.0));
  EXPECT_EQ(model.dissipative, std::vector<double>(5, 0.0));
  EXPECT_EQ(model.energies().potential(), 0.0);
}

TEST_F(AppliedLoadTest, ForceOffTheCentreTurnsTheBody) {
  system.add(AppliedForce{.on = {plate, {2.0, 0.0}}, .force = [](double) { return Vec<2>(3.0, 5.0); }});
  LoadedModel model(system);
  const auto torque = [](double angle) { return 2.0 * (std::cos(angle) * 5.0 - std::sin(angle) * 3.0); };
  EXPECT_EQ(model.external[2], 3.0);
  EXPECT_EQ(model.external[3], 5.0);
  EXPECT_NEAR(model.external[4], torque(0.3), 16 * epsilon * 10.0);
  model.state.angle(plate) = 2.0;  // the force does not turn with the body, its point does
  model.update();
  EXPECT_EQ(model.external[2], 3.0);
  EXPECT_NEAR(model.external[4], torque(2.0), 16 * epsilon * 10.0);
}

TEST_F(AppliedLoadTest, TorqueIsAFunctionOfTime) {
  system.add(AppliedTorque{.on = plate, .torque = [](double t) { return 1.0 + t; }});
  LoadedModel model(system);
  model.state.time = 0.5;
  model.update();
  EXPECT_EQ(model.external, (std::vector<double>{0, 0, 0, 0, 1.5}));
}

TEST_F(AppliedLoadTest, LoadsAddUpAndJoinNoComponents) {
  system.add(AppliedForce{.on = plate, .force = [](double) { return Vec<2>(1.0, 0.0); }});
  system.add(AppliedForce{.on = plate, .force = [](double) { return Vec<2>(2.0, 4.0); }});
  system.add(AppliedForce{.on = dot, .force = [](double) { return Vec<2>(0.0, 8.0); }});
  const LoadedModel model(system);
  EXPECT_EQ(model.external, (std::vector<double>{0, 8, 3, 4, 0}));
  EXPECT_EQ(model.assembly.components().size(), 2U);
}

TEST(AppliedLoad, InSpace) {
  System system;
  const BodyId body = system.add(spatial::Particle{.mass = 1.0});
  system.add(spatial::AppliedForce{.on = body, .force = [](double t) { return Vec<3>(t, 1.0, 2.0); }});
  LoadedModel model(system);
  model.state.time = 5.0;
  model.update();
  EXPECT_EQ(model.external, (std::vector<double>{5, 1, 2}));
}

TEST_F(AppliedLoadTest, ImpossibleForcesAreRefusedByName) {
  const auto push = [](double) { return Vec<2>(1.0, 0.0); };
  EXPECT_MODEL_ERROR(system.add(AppliedForce{.force = push}), "applied force #0", "on is not given");
  EXPECT_MODEL_ERROR(system.add(AppliedForce{.on = dot}, "wind"), "applied force 'wind'",
                     "force is not given", "a function of time");
  EXPECT_MODEL_ERROR(system.add(AppliedForce{.on = ground, .force = push}), "applied force #0", "is ground",
                     "at least one body");
  EXPECT_MODEL_ERROR(system.add(AppliedForce{.on = {ground, {1, 0}}, .force = push}), "applied force #0",
                     "is ground");
  EXPECT_MODEL_ERROR(system.add(AppliedForce{.on = {dot, {1, 0}}, .force = push}), "applied force #0",
                     "on, off the centre, is particle 'dot'");
  for (const double bad : {nan, infinity, -infinity}) {
    EXPECT_MODEL_ERROR(system.add(AppliedForce{.on = {plate, {bad, 0}}, .force = push}), "applied force #0",
                       "on.point is " + to_text(bad) + " m");
    EXPECT_MODEL_ERROR(
        system.add(AppliedForce{.on = dot, .force = [bad](double) { return Vec<2>(0.0, bad); }}),
        "applied force #0", "force at time 0 is " + to_text(bad) + " N", "finite");
  }
  EXPECT_TRUE(system.elements().empty());
}

TEST_F(AppliedLoadTest, ImpossibleTorquesAreRefusedByName) {
  const auto turn = [](double) { return 1.0; };
  EXPECT_MODEL_ERROR(system.add(AppliedTorque{.torque = turn}), "applied torque #0", "on is not given");
  EXPECT_MODEL_ERROR(system.add(AppliedTorque{.on = ground, .torque = turn}), "applied torque #0",
                     "on is ground");
  EXPECT_MODEL_ERROR(system.add(AppliedTorque{.on = dot, .torque = turn}), "applied torque #0",
                     "on is particle 'dot'", "a rigid body");
  EXPECT_MODEL_ERROR(system.add(AppliedTorque{.on = plate}, "motor"), "applied torque 'motor'",
                     "torque is not given");
  for (const double bad : {nan, infinity, -infinity}) {
    EXPECT_MODEL_ERROR(system.add(AppliedTorque{.on = plate, .torque = [bad](double) { return bad; }}),
                       "applied torque #0", "torque at time 0 is " + to_text(bad) + " N m");
  }
  EXPECT_TRUE(system.elements().empty());
}

TEST_F(AppliedLoadTest, WhatAFunctionThrowsArrives) {
  EXPECT_THROW(system.add(AppliedTorque{.on = plate,
                                        .torque = [](double) -> double { throw std::out_of_range("t"); }}),
               std::out_of_range);
  EXPECT_TRUE(system.elements().empty());
}

}  // namespace
