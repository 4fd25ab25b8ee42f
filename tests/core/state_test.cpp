#include <carom/bodies/particle.h>
#include <carom/bodies/rigid_body.h>
#include <carom/core/assembly.h>
#include <carom/core/state.h>
#include <carom/joints/driver.h>
#include <carom/joints/revolute.h>
#include <carom/joints/rod.h>

#include "tests/model_error.h"

#include <gtest/gtest.h>

namespace {

using namespace carom;
using namespace carom::planar;

class StateTest : public testing::Test {
protected:
  System system;
  BodyId plate = system.add(
      RigidBody{.mass = disc(2.0, 1.0), .position = {1, 2}, .angle = 0.5, .velocity = {3, 4}, .spin = -6.0},
      "plate");
  BodyId dot = system.add(Particle{.mass = 1.0, .position = {7, 8}, .velocity = {9, 10}}, "dot");
  State state = Assembly(system).initial_state();
};

TEST_F(StateTest, IsFoundByIdentity) {
  EXPECT_EQ(Vec<2>(state.position(plate)), Vec<2>(1, 2));
  EXPECT_EQ(Vec<2>(state.velocity(plate)), Vec<2>(3, 4));
  EXPECT_EQ(state.angle(plate), 0.5);
  EXPECT_EQ(state.spin(plate), -6.0);
  EXPECT_EQ(Vec<2>(state.position(dot)), Vec<2>(7, 8));
  EXPECT_EQ(Vec<2>(state.velocity(dot)), Vec<2>(9, 10));
  EXPECT_EQ(state.time, 0.0);
}

TEST_F(StateTest, IsWrittenByIdentityWithoutTouchingNeighbours) {
  const State before = state;
  state.position(plate) << -1, -2;
  state.velocity(plate)[1] = -4.0;
  state.angle(plate) = 2.5;
  state.spin(plate) = 1.0;
  const State& after = state;
  EXPECT_EQ(Vec<2>(after.position(plate)), Vec<2>(-1, -2));
  EXPECT_EQ(Vec<2>(after.velocity(plate)), Vec<2>(3, -4));
  EXPECT_EQ(after.angle(plate), 2.5);
  EXPECT_EQ(after.spin(plate), 1.0);
  EXPECT_EQ(Vec<2>(after.position(dot)), Vec<2>(before.position(dot)));
  EXPECT_EQ(Vec<2>(after.velocity(dot)), Vec<2>(before.velocity(dot)));
  EXPECT_EQ(Vec<2>(before.position(plate)), Vec<2>(1, 2)) << "a copy must keep its own numbers";
}

TEST_F(StateTest, ViewShowsTheNumbers) {
  state.time = 4.0;
  const StateView view = state.view();
  EXPECT_EQ(view.time, 4.0);
  EXPECT_EQ(view.q, state.q.data());
  EXPECT_EQ(view.v, state.v.data());
}

TEST_F(StateTest, ANewOneIsZeroAndSized) {
  const State zero(state.layout());
  EXPECT_EQ(zero.q, std::vector<double>(5, 0.0));
  EXPECT_EQ(zero.v, std::vector<double>(5, 0.0));
  EXPECT_TRUE(zero.z.empty());
}

TEST_F(StateTest, RefusesBodiesThatAreNotThere) {
  System other;
  const BodyId foreign = other.add(Particle{.mass = 1.0});
  EXPECT_MODEL_ERROR(state.position(foreign), "state of a body", "#0", "not in this model");
  EXPECT_MODEL_ERROR(state.velocity(ground), "ground", "allowed: a body of this model");
  EXPECT_MODEL_ERROR(state.position(BodyId{}), "never given");
}

TEST_F(StateTest, RefusesAnAngleWhereThereIsNone) {
  EXPECT_MODEL_ERROR(state.angle(dot), "body #1", "has none", "a planar rigid body");
  EXPECT_MODEL_ERROR(state.spin(dot), "body #1", "has none", "a planar rigid body");
  System flying;
  const BodyId body = flying.add(spatial::Particle{.mass = 1.0});
  const State in_space = Assembly(flying).initial_state();
  EXPECT_EQ(in_space.position(body).size(), 3);
  EXPECT_MODEL_ERROR(in_space.angle(body), "body #0", "a planar rigid body");
}

TEST_F(StateTest, KnowsTheCoordinatesOfJoints) {
  const JointId pin = system.add(Revolute{.from = {ground, {1, 2}}, .to = plate, .zero_angle = 0.25});
  const State with = Assembly(system).initial_state();
  EXPECT_EQ(with.coordinate(pin), 0.25);
  EXPECT_EQ(with.rate(pin), -6.0);
}

TEST_F(StateTest, RefusesCoordinatesThatAreNotThere) {
  const JointId rod = system.add(Rod{.from = plate, .to = dot});
  const JointId pin = system.add(Revolute{.from = ground, .to = plate});
  const JointId drive = system.add(Driver{.joint = pin, .position = [](double) { return 0.0; }});
  System other;
  const BodyId body = other.add(RigidBody{.mass = disc(1.0, 1.0)});
  other.add(Revolute{.from = ground, .to = body});
  const JointId foreign = other.add(Revolute{.from = ground, .to = body});
  const State with = Assembly(system).initial_state();
  const std::string_view allowed = "allowed: a joint of this model that has a coordinate";
  EXPECT_MODEL_ERROR(with.coordinate(rod), "coordinate of a joint (#0): it has none", allowed);
  EXPECT_MODEL_ERROR(with.rate(rod), "coordinate of a joint (#0): it has none", allowed);
  EXPECT_MODEL_ERROR(with.coordinate(drive), "(#2): it has none", allowed);
  EXPECT_MODEL_ERROR(with.coordinate(foreign), "(#1): it is not in this model", allowed);
  EXPECT_MODEL_ERROR(with.rate(JointId{}), "coordinate of a joint, never given: it is not in this model");
  EXPECT_MODEL_ERROR(state.coordinate(pin),
                     "(#1): it is not in this model");  // made before there were joints
  EXPECT_MODEL_ERROR(State().coordinate(pin), "(#1): the state belongs to no model");
  system.remove(rod);
  EXPECT_MODEL_ERROR(Assembly(system).initial_state().coordinate(rod), "(#0): it is not in this model");
}

TEST_F(StateTest, AStateOfNoModelSaysSo) {
  const State nothing;
  EXPECT_EQ(nothing.layout(), nullptr);
  EXPECT_MODEL_ERROR(nothing.position(dot), "belongs to no model", "allowed: a state of a simulation");
  EXPECT_MODEL_ERROR(nothing.spin(plate), "belongs to no model");
}

}  // namespace
