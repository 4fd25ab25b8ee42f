#include <carom/carom.h>

#include <gtest/gtest.h>

#include "tests/model_error.h"

#include <cmath>
#include <limits>

namespace {

using namespace carom;
using namespace carom::planar;

TEST(DescribedPlace, IsThatOfTheDescription) {
  System system;
  const BodyId dot = system.add(Particle{.mass = 1.0, .position = {3, 4}});
  const BodyId plate =
      system.add(RigidBody{.mass = disc(1.0, 1.0), .position = {1, 2}, .angle = std::acos(-1.0) / 2.0});
  EXPECT_EQ(described_place(system, ground).point({5, 6}), Vec<2>(5, 6));
  EXPECT_EQ(described_place(system, dot).point({0, 0}), Vec<2>(3, 4));
  EXPECT_LE((described_place(system, plate).point({1, 0}) - Vec<2>(1, 3)).norm(), 1e-15);
}

TEST(JointEnds, AreOnDifferentBodies) {
  System system;
  const BodyId dot = system.add(Particle{.mass = 1.0});
  const PartCheck check("joint", system);
  EXPECT_NO_THROW(check_joint_ends(check, ground, dot));
  EXPECT_MODEL_ERROR(check_joint_ends(check, dot, dot), "joint");
  EXPECT_MODEL_ERROR(check_turning_end(check, dot, "from"), "from");
  EXPECT_NO_THROW(check_turning_end(check, ground, "from"));
}

TEST(JointEnds, AnAxisHasADirection) {
  const System system;
  const PartCheck check("joint", system);
  EXPECT_EQ(checked_axis(check, {0.0, 1e-200}, "axis"), Vec<2>(0.0, 1.0));
  EXPECT_MODEL_ERROR(checked_axis(check, {0.0, 0.0}, "axis"), "axis");
  EXPECT_MODEL_ERROR(checked_axis(check, {std::numeric_limits<double>::infinity(), 0.0}, "axis"), "axis");
}

}  // namespace
