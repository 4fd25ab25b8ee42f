// Facts of a clock group: what its loads and contacts are functions of.

#include <carom/carom.h>
#include <carom/contact/detection/detector.h>
#include <carom/core/assembly.h>
#include <carom/integrators/event_driven/smooth_motion.h>

#include <gtest/gtest.h>

#include <utility>

namespace {

using namespace carom;
using namespace carom::planar;

/// Whether a model of one component evaluates sines and cosines of its bodies' angles.
bool needs_rotations(System system) {
  const Assembly assembly(std::move(system));
  const Detector detector(assembly);
  const EventDriven options;
  MotionMemory memory(assembly);
  const SmoothMotion motion(assembly, detector, {{0}, {}}, options, memory);
  return motion.model().loads.needs_rotations;
}

struct OnFloor {
  System system;
  BodyId body;
};

OnFloor over_floor() {
  OnFloor made;
  made.system.add(Gravity{{0.0, -9.81}});
  made.system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = 0.3, .normal_restitution = 0.5});
  made.body = made.system.add(RigidBody{.mass = disc(1.0, 0.1), .position = {0.0, 1.0}});
  return made;
}

TEST(GroupModel, ADiscOverAFloorNeedsNoRotations) {
  OnFloor model = over_floor();
  model.system.add(Disc{.body = model.body, .radius = 0.1});
  EXPECT_FALSE(needs_rotations(std::move(model.system)));
}

TEST(GroupModel, AFeatureOffTheCentreNeedsRotations) {
  OnFloor model = over_floor();
  model.system.add(Disc{.body = model.body, .radius = 0.1, .centre = {0.01, 0.0}});
  EXPECT_TRUE(needs_rotations(std::move(model.system)));
}

TEST(GroupModel, ASpringOffTheCentreNeedsRotations) {
  OnFloor model = over_floor();
  model.system.add(Disc{.body = model.body, .radius = 0.1});
  model.system.add(
      SpringDamper{.from = {ground, {0.0, 3.0}}, .to = {model.body, {0.1, 0.0}}, .stiffness = 10.0});
  EXPECT_TRUE(needs_rotations(std::move(model.system)));
}

TEST(GroupModel, ParticlesHaveNone) {
  System system;
  const BodyId mass = system.add(Particle{.mass = 1.0, .position = {0.0, 1.0}});
  system.add(SpringDamper{.from = {ground, {0.0, 3.0}}, .to = mass, .stiffness = 10.0});
  EXPECT_FALSE(needs_rotations(std::move(system)));
}

TEST(GroupModel, AJointNeedsRotations) {
  OnFloor model = over_floor();
  model.system.add(Revolute{.from = {ground, {0.0, 2.0}}, .to = {model.body, {0.0, 1.0}}});
  EXPECT_TRUE(needs_rotations(std::move(model.system)));
}

TEST(GroupModel, ShapesOnGroundNeedRotations) {
  OnFloor model = over_floor();
  model.system.add(Disc{.body = model.body, .radius = 0.1});
  model.system.add(Peg{.radius = 0.2}, Surface{.friction = 0.3, .normal_restitution = 0.5});
  EXPECT_TRUE(needs_rotations(std::move(model.system)));
}

}  // namespace
