#include "tests/constraint_sets.h"
#include <carom/contact/detection/detector.h>

#include "tests/contact/detection/placed_model.h"

#include <carom/carom.h>
#include <carom/core/constraint_set.h>

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;

const Surface law{.friction = 0.5, .normal_restitution = 0.5};

/// A flap on a pin, beyond its limit, with friction, whose tip is in the floor; the floor may sway.
struct Scene {
  explicit Scene(bool sways) {
    PrescribedMotion motion;
    if (sways) motion.angle = [](double t) { return 0.1 * std::sin(t); };
    floor = system.add(HalfPlane{.point = {0.0, -0.1}, .normal = {0, 1}, .motion = motion}, law, "floor");
    flap = system.add(RigidBody{.mass = rod(1.0, 1.0), .angle = -0.5}, "flap");
    tip = system.add(Point{.body = flap, .position = {0.5, 0.0}}, "tip");
    pin = system.add(Revolute{.from = ground, .to = flap}, "pin");
    stop = system.add(Stop{.joint = pin, .lower = 0.1}, "stop");
    friction = system.add(JointFriction{.joint = pin, .bound = 0.5}, "friction");
  }
  System system;
  ObstacleId floor;
  BodyId flap;
  ShapeId tip;
  JointId pin, stop, friction;
};

TEST(Detector, FindsContactsThenLimits) {
  const Scene scene(false);
  const carom_test::PlacedModel model(scene.system);
  const Detector detector(model.assembly);
  EXPECT_FALSE(detector.has_moving_ground());
  EXPECT_TRUE(detector.needs_rotations());
  EXPECT_TRUE(detector.joints().has_friction(0));
  EXPECT_TRUE(detector.has_static_friction());
  ConstraintSet found;
  detector.find(0, model.state.view(), model.evaluation, 0.0, found);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_FALSE(found[0].key.is_of_joint());
  EXPECT_EQ(detector.name(found[0].key),
            "point 'tip' (feature 0) of rigid body 'flap' on half-plane 'floor'");
  EXPECT_EQ(found[1].tangents(), 0);
  EXPECT_EQ(detector.name(found[1].key), "stop 'stop' (lower)");
  detector.joints().find_friction(0, model.state.view(), model.evaluation, found);
  ASSERT_EQ(found.size(), 3U);
  EXPECT_TRUE(found[2].has_given_bound());
}

TEST(Detector, PairsGiveTheConstraintsOfFind) {
  for (const bool sways : {false, true}) {
    const Scene scene(sways);
    carom_test::PlacedModel model(scene.system);
    model.state.time = 0.7;
    const Detector detector(model.assembly);
    GroundPlaces places;
    detector.place(0.7, places);
    ConstraintSet found;
    detector.find(0, model.state.view(), model.evaluation, places, nullptr, 0.0, found);
    detector.joints().find_friction(0, model.state.view(), model.evaluation, found);
    std::vector<ContactPair> pairs = detector.pairs(0);
    detector.joints().append_friction(0, pairs);
    ASSERT_EQ(pairs.size(), found.size());
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      EXPECT_EQ(moves(detector, pairs[i]), sways && i == 0);
      SingleConstraint at;
      detector.contact(pairs[i], model.state.view(), model.evaluation, places, at);
      EXPECT_EQ(at.key, found[i].key);
      EXPECT_EQ(at.gap, found[i].gap);
      EXPECT_EQ(carom_test::numbers_of(at), carom_test::numbers_of(found[i]));
      EXPECT_EQ(at.drift, found[i].drift);
      EXPECT_EQ(at.surface_velocity, found[i].surface_velocity);
    }
  }
}

// Turning opens contacts of features on arms, and those of centres where the ground turns.
TEST(Detector, RemembersContactsThatTurningMayOpen) {
  for (const bool sways : {false, true}) {
    Scene scene(sways);
    const BodyId ball = scene.system.add(Particle{.mass = 1.0}, "ball");
    const carom_test::PlacedModel model(scene.system);
    const Detector detector(model.assembly);
    const FeatureKey floor{FeatureKey::Owner::obstacle, scene.floor.serial, 0};
    const FeatureKey gone{FeatureKey::Owner::obstacle, 77, 0};
    const FeatureKey centre{FeatureKey::Owner::body, ball.serial, 0};
    const ConstraintKey of_tip{{FeatureKey::Owner::shape, scene.tip.serial, 0}, floor},
        of_ball{centre, floor};
    const std::vector<std::pair<ConstraintKey, ContactMode>> modes{
        {of_ball, ContactMode::stick}, {{centre, gone}, ContactMode::stick}, {of_tip, ContactMode::stick}};
    LastingContacts lasting;
    detector.remember(modes, 1e-3, {}, lasting);
    EXPECT_EQ(lasting.step(), 1e-3);
    EXPECT_TRUE(lasting.contains(of_tip));
    EXPECT_EQ(lasting.contains(of_ball), sways);
    EXPECT_FALSE(lasting.contains({centre, gone}));
    EXPECT_TRUE(lasting.lasts(of_tip, 1e-6, 1.0));
    EXPECT_FALSE(lasting.lasts(of_tip, 1e-4, 1.0));  // more than 8 h^2 d
  }
}

}  // namespace
