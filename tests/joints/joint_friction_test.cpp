#include <carom/contact/detection/detector.h>
#include <carom/core/constraint_set.h>
#include <carom/joints/joint_friction.h>

#include <carom/joints/driver.h>
#include <carom/joints/gravity.h>
#include <carom/joints/prismatic.h>
#include <carom/joints/revolute.h>
#include <carom/joints/rod.h>

#include "tests/joints/element_pairs.h"
#include "tests/joints/joint_model.h"
#include "tests/model_error.h"

#include <limits>

namespace {

using namespace carom;
using namespace carom::planar;
using namespace carom_test;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

struct Wheel {
  System system;
  BodyId wheel = system.add(RigidBody{.mass = disc(2.0, 1.0)}, "wheel");
  BodyId dot = system.add(Particle{.mass = 1.0, .position = {3, 4}}, "dot");
  JointId pin = system.add(Revolute{.from = ground, .to = wheel}, "pin");
  JointId rod = system.add(Rod{.from = wheel, .to = dot}, "rod");
  JointId nail = system.add(Revolute{.from = {ground, {3, 4}}, .to = dot}, "nail");
};

TEST(JointFriction, BindsNothing) {
  Wheel wheel;
  const JointId friction = wheel.system.add(JointFriction{.joint = wheel.pin, .bound = 0.5}, "rubbing");
  const JointKind& kind = wheel.system.joint_kinds().kind_of(friction.serial);
  EXPECT_EQ(kind.rows(), 0u);
  EXPECT_EQ(kind.limits(), 0u);
  EXPECT_EQ(kind.friction_rows(), 1u);
  EXPECT_EQ(wheel.system.joint_kinds().kind_of(wheel.pin.serial).friction_rows(), 0u);
  const double force = -0.3;
  EXPECT_EQ(kind.reaction({}, 0, &force).moment, -0.3);
}

TEST(JointFriction, ContactsHaveItsCoordinate) {
  Wheel wheel;
  const BodyId block =
      wheel.system.add(RigidBody{.mass = disc(1.0, 0.3), .position = {0.6, 0.0}, .velocity = {1.0, 2.0}});
  const JointId slide = wheel.system.add(Prismatic{.from = wheel.wheel, .to = block, .axis = {1, 0}});
  const JointId friction =
      wheel.system.add(JointFriction{.joint = slide, .bound = 0.5, .static_factor = 1.5}, "rubbing");
  JointModel model(wheel.system);
  const Detector detector(model.assembly);
  const Index component = 0;  // all hang together
  ASSERT_TRUE(detector.joints().has_friction(component));
  ConstraintSet found;
  detector.joints().find_friction(component, model.state.view(), model.evaluation, found);
  ASSERT_EQ(found.size(), 1u);
  const Constraint& contact = found[0];
  EXPECT_TRUE(contact.has_given_bound());
  EXPECT_TRUE(contact.key.is_of_joint());
  EXPECT_EQ(contact.rows, 1);
  EXPECT_EQ(contact.of_joint.friction_bound, 0.5);
  EXPECT_EQ(contact.law.sticking_friction(), 1.5);
  EXPECT_EQ(contact.gap, 0.0);
  EXPECT_EQ(detector.name(contact.key), wheel.system.name(friction));
  ConstraintKey second = contact.key;
  second.a.feature = 1;
  EXPECT_MODEL_ERROR((void)detector.name(second), "feature 1 of joint", "keys of contacts");
  EXPECT_EQ(contact.normal_velocity(model.state.v.data()), 0.0);
  EXPECT_DOUBLE_EQ(contact.tangential_velocity(model.state.v.data()), model.state.rate(slide));
  EXPECT_TRUE(detector.pairs(component).empty());
  std::vector<ContactPair> pairs;
  detector.joints().append_friction(component, pairs);
  EXPECT_EQ(pairs.size(), 1u);
}

TEST(JointFriction, RefusesWhatCannotBe) {
  Wheel wheel;
  System& system = wheel.system;
  EXPECT_MODEL_ERROR(system.add(JointFriction{}), "joint friction", "joint is not given");
  EXPECT_MODEL_ERROR(system.add(JointFriction{.joint = wheel.rod, .bound = 1.0}), "rod",
                     "a joint with a coordinate");
  EXPECT_MODEL_ERROR(system.add(JointFriction{.joint = wheel.nail, .bound = 1.0}), "nail", "particles");
  EXPECT_MODEL_ERROR(system.add(JointFriction{.joint = wheel.pin}), "bound is 0", "one of them > 0");
  EXPECT_MODEL_ERROR(system.add(JointFriction{.joint = wheel.pin, .bound = -1.0}), "bound is -1");
  EXPECT_MODEL_ERROR(system.add(JointFriction{.joint = wheel.pin, .bound = nan}), "bound is nan");
  EXPECT_MODEL_ERROR(system.add(JointFriction{.joint = wheel.pin, .coefficient = infinity}),
                     "coefficient is inf");
  EXPECT_MODEL_ERROR(system.add(JointFriction{.joint = wheel.pin, .bound = 1.0, .static_factor = 0.9}),
                     "static_factor is 0.9", ">= 1");
  EXPECT_MODEL_ERROR(system.add(JointFriction{.joint = wheel.pin, .bound = 1.0, .static_factor = nan}),
                     "static_factor is nan");
  System other;
  EXPECT_MODEL_ERROR(other.add(JointFriction{.joint = wheel.pin, .bound = 1.0}), "a joint of this system");
  const JointId friction = system.add(JointFriction{.joint = wheel.pin, .bound = 1.0}, "rubbing");
  EXPECT_MODEL_ERROR(system.add(JointFriction{.joint = wheel.pin, .bound = 1.0}), "which has", "rubbing",
                     "a joint without friction");
  EXPECT_MODEL_ERROR(system.remove(wheel.pin), "rubbing");
  EXPECT_MODEL_ERROR(system.add(Stop{.joint = friction, .lower = 0.0}), "a joint with a coordinate");
  system.remove(friction);
  EXPECT_NO_THROW(system.add(JointFriction{.joint = wheel.pin, .bound = 2.0}));
}

TEST(JointFriction, GoesWithStopsAndDriversInAnyOrder) {
  Wheel wheel;
  wheel.system.add(Stop{.joint = wheel.pin, .lower = -1.0});
  wheel.system.add(JointFriction{.joint = wheel.pin, .bound = 1.0});
  EXPECT_NO_THROW(wheel.system.add(Driver{.joint = wheel.pin, .position = [](double t) { return t; }}));
}

TEST(JointFriction, ChangesTheFingerprint) {
  const auto print = [](const JointFriction& law) {
    Wheel wheel;
    JointFriction part = law;
    part.joint = wheel.pin;
    wheel.system.add(part);
    Fingerprint out;
    wheel.system.joint_kinds().kind_of(3).fingerprint(out);
    return out.value();
  };
  const auto plain = print({.bound = 1.0});
  EXPECT_EQ(print({.bound = 1.0}), plain);
  EXPECT_NE(print({.bound = 2.0}), plain);
  EXPECT_NE(print({.bound = 1.0, .coefficient = 0.1}), plain);
  EXPECT_NE(print({.bound = 1.0, .static_factor = 1.1}), plain);
}

}  // namespace
