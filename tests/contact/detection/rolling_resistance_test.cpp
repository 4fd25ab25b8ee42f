// Rolling resistance as a row along a spin, with a law of its own.

#include <carom/contact/detection/rolling_resistance.h>

#include "tests/constraint_sets.h"
#include "tests/contact/detection/placed_model.h"

#include <carom/carom.h>
#include <carom/core/constraint_set.h>

#include <gtest/gtest.h>

#include <array>

namespace {

using namespace carom;
using namespace carom::planar;

constexpr double radius = 0.3, resistance = 0.02, spin = 5.0;

/// A disc that turns on a floor where sticking takes more than sliding.
System turning_disc() {
  System system;
  system.add(HalfPlane{.normal = {0.0, 1.0}}, {.friction = 0.3,
                                               .normal_restitution = 0.1,
                                               .tangential_restitution = 0.15,
                                               .static_friction = 0.5,
                                               .stribeck_speed = 0.1,
                                               .rolling_resistance = resistance,
                                               .rolling_restitution = 0.2});
  const BodyId disc_body =
      system.add(RigidBody{.mass = disc(1.0, radius), .position = {0.0, radius}, .spin = spin});
  system.add(Disc{.body = disc_body, .radius = radius});
  return system;
}

class RollingResistanceTest : public testing::Test {
protected:
  RollingResistanceTest() {
    Detector(model_.assembly).find(0, model_.state.view(), model_.evaluation, 1e-9, found_);
    EXPECT_EQ(found_.size(), 1U);
    write_rolling_resistance(found_[0], nullptr, row_);
  }

  System system_ = turning_disc();
  carom_test::PlacedModel model_{system_};
  ConstraintSet found_;
  SingleConstraint row_;
};

TEST_F(RollingResistanceTest, IsATangentialRowAttachedToItsContact) {
  EXPECT_EQ(row_.rows, 1);
  EXPECT_EQ(row_.normals, 0);
  EXPECT_EQ(row_.tangents(), 1);
  EXPECT_EQ(row_.attached, 1);
  EXPECT_FALSE(row_.has_given_bound());
  EXPECT_EQ(row_.key, found_[0].key);
  const double* const velocities = model_.state.v.data();
  EXPECT_DOUBLE_EQ(row_.tangential_velocity(velocities), row_.of_joint.length * spin);
  EXPECT_EQ(row_.normal_velocity(velocities), 0.0);
}

TEST_F(RollingResistanceTest, HasTheSameCoefficientAtRestAndAtAnySpeed) {
  EXPECT_DOUBLE_EQ(row_.friction * row_.of_joint.length, resistance);
  EXPECT_EQ(row_.law.sticking_friction(), row_.friction);
  for (const double speed : {0.0, 0.01, 10.0}) {
    EXPECT_EQ(row_.law.friction_at(speed), row_.friction);
    EXPECT_EQ(row_.law.sliding_friction(speed), row_.friction);
  }
  EXPECT_EQ(row_.restitution(0), 0.2);
}

TEST_F(RollingResistanceTest, MayTakeThePlaceOfItsContact) {
  SingleConstraint in_place(found_[0]);
  write_rolling_resistance(in_place, nullptr, in_place);
  EXPECT_EQ(carom_test::numbers_of(in_place), carom_test::numbers_of(row_));
  EXPECT_EQ(in_place.friction, row_.friction);
  EXPECT_EQ(in_place.law.friction, row_.law.friction);
  EXPECT_EQ(in_place.of_joint.length, row_.of_joint.length);
  in_place.start_contact();  // nothing of the spin is left
  EXPECT_EQ(in_place.normals, 1);
  EXPECT_EQ(in_place.attached, 0);
  EXPECT_EQ(in_place.of_joint.length, 1.0);
}

}  // namespace
