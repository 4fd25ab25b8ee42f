#include "tests/constraint_sets.h"
#include <carom/contact/detection/joint_rows.h>

#include "tests/contact/detection/placed_model.h"

#include <carom/carom.h>
#include <carom/core/constraint_set.h>

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;

// Angles of the flap count times its radius of gyration, 0.289 m, up to a power of two.
constexpr double arm = 0.5;
constexpr double infinity = std::numeric_limits<double>::infinity();

/// A flap on a pin with two limits and friction, and a free ball.
struct Flap {
  System system;
  BodyId flap = system.add(RigidBody{.mass = rod(1.0, 1.0), .angle = 0.5, .spin = 2.0}, "flap");
  BodyId ball = system.add(Particle{.mass = 1.0}, "ball");
  JointId pin = system.add(Revolute{.from = ground, .to = flap}, "pin");
  JointId stop = system.add(Stop{.joint = pin, .lower = -1.0, .upper = 0.1, .restitution = 0.25}, "stop");
  JointId friction = system.add(JointFriction{.joint = pin, .bound = 0.5, .static_factor = 1.5}, "friction");
};

Index component_of(const Assembly& assembly, BodyId body) {
  const Index place = assembly.layout()->index(body);
  Index component = 0;
  while (assembly.components()[component].bodies.end <= place) ++component;
  return component;
}

TEST(JointRows, ModelsWithoutJointsHaveNone) {
  System system;
  system.add(Particle{.mass = 1.0});
  const carom_test::PlacedModel model(system);
  const JointRows rows(model.assembly);
  EXPECT_TRUE(rows.empty());
  EXPECT_FALSE(rows.has_friction());
  EXPECT_FALSE(rows.has_friction(0));
}

TEST(JointRows, LimitsAreFoundWithinTheMargin) {
  const Flap flap;
  const carom_test::PlacedModel model(flap.system);
  const JointRows rows(model.assembly);
  const Index component = component_of(model.assembly, flap.flap);
  const GroundPlaces places;
  const auto found = [&](double margin) {
    ConstraintSet out;
    rows.find_limits(component, {model.state.view(), model.evaluation, places, nullptr, margin, nullptr},
                     out);
    return out;
  };
  EXPECT_TRUE(found(0.0).empty());
  EXPECT_EQ(found(infinity).size(), 2U);
  const ConstraintSet near = found(0.2 * arm);
  ASSERT_EQ(near.size(), 1U);
  EXPECT_EQ(near[0].tangents(), 0);
  EXPECT_EQ(near[0].key.a, (FeatureKey{FeatureKey::Owner::joint, flap.stop.serial, 1}));
  EXPECT_EQ(near[0].key.a, near[0].key.b);
  EXPECT_EQ(near[0].rows, 1);
  EXPECT_NEAR(near[0].gap, 0.1 * arm, 1e-15);
  EXPECT_DOUBLE_EQ(near[0].of_joint.length, arm);
  EXPECT_EQ(near[0].restitution(0), 0.25);
  EXPECT_DOUBLE_EQ(near[0].velocity(0, model.state.v.data()), -2.0 * arm);
  EXPECT_EQ(near[0].body(), model.assembly.layout()->index(flap.flap));

  ConstraintSet none_of_it;
  rows.find_limits(component_of(model.assembly, flap.ball),
                   {model.state.view(), model.evaluation, places, nullptr, infinity, nullptr}, none_of_it);
  EXPECT_TRUE(none_of_it.empty());
}

// Of the angle between two bodies the arm is that of the smallest change of velocities that makes a rate of
// 1 rad/s; a coordinate that is a length stays one, levers and all.
TEST(JointRows, AnglesCountTimesAnArm) {
  System system;
  const BodyId one = system.add(RigidBody{.mass = {.mass = 1.0, .inertia = 0.09}});
  const BodyId two = system.add(RigidBody{.mass = {.mass = 4.0, .inertia = 0.64}, .position = {1.0, 0.0}});
  const BodyId slider = system.add(RigidBody{.mass = disc(1.0, 0.1), .position = {2.0, 1.0}});
  const JointId pin = system.add(Revolute{.from = one, .to = {two, {-1.0, 0.0}}});
  const JointId slide = system.add(Prismatic{.from = two, .to = slider, .axis = {1.0, 0.0}});
  for (const JointId joint : {pin, slide}) system.add(JointFriction{.joint = joint, .bound = 2.0});
  const carom_test::PlacedModel model(system);
  const JointRows rows(model.assembly);
  ConstraintSet out;
  rows.find_friction(0, model.state.view(), model.evaluation, out);
  ASSERT_EQ(out.size(), 2U);
  constexpr double between = 0.25;  // of 0.3 m and 0.4 m: 1/|(1/0.3, 1/0.4)| is 0.24 m
  EXPECT_EQ(out[0].of_joint.length, between);
  EXPECT_EQ(out[0].of_joint.friction_bound, 2.0 / between);
  EXPECT_EQ(out[1].of_joint.length, 1.0);
  EXPECT_EQ(out[1].of_joint.friction_bound, 2.0);
}

TEST(JointRows, FrictionIsARowAlongTheCoordinate) {
  const Flap flap;
  const carom_test::PlacedModel model(flap.system);
  const JointRows rows(model.assembly);
  const Index component = component_of(model.assembly, flap.flap);
  EXPECT_TRUE(rows.has_friction());
  EXPECT_TRUE(rows.has_friction(component));
  EXPECT_FALSE(rows.has_friction(1 - component));
  ConstraintSet out;
  rows.find_friction(component, model.state.view(), model.evaluation, out);
  ASSERT_EQ(out.size(), 1U);
  EXPECT_TRUE(out[0].has_given_bound());
  EXPECT_DOUBLE_EQ(out[0].of_joint.friction_bound, 0.5 / arm);
  EXPECT_EQ(out[0].law.sticking_friction(), 1.5);
  EXPECT_DOUBLE_EQ(out[0].velocity(0, model.state.v.data()), 2.0 * arm);
  SingleConstraint moved(out[0]);
  std::fill_n(moved.row(0), moved.columns(), 0.0);
  rows.update_friction({model.state.view(), model.evaluation.rotation.data()}, moved);
  EXPECT_EQ(carom_test::numbers_of(moved), carom_test::numbers_of(out[0]));
}

TEST(JointRows, PairsAreTheRowsByNumber) {
  const Flap flap;
  const carom_test::PlacedModel model(flap.system);
  const JointRows rows(model.assembly);
  const Index component = component_of(model.assembly, flap.flap);
  std::vector<ContactPair> limits, friction;
  rows.append_limits(component, limits);
  rows.append_friction(component, friction);
  ASSERT_EQ(limits.size(), 2U);
  ASSERT_EQ(friction.size(), 1U);
  for (const ContactPair& pair : limits) {
    SingleConstraint at;
    rows.constraint(pair.joint_row, model.state.view(), model.evaluation, at);
    EXPECT_EQ(at.tangents(), 0);
    EXPECT_EQ(at.of_joint.source, pair.joint_row);
    EXPECT_EQ(at.body(), pair.body);
    EXPECT_EQ(pair.ground_shape, none);
  }
  SingleConstraint at;
  rows.constraint(friction[0].joint_row, model.state.view(), model.evaluation, at);
  EXPECT_TRUE(at.has_given_bound());
}

}  // namespace
