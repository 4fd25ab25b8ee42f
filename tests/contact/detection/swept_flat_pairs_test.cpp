// Pairs without outlines that may close on a path: points before half-planes, and limits of joints.

#include "tests/contact/detection/moved_model.h"

#include <carom/carom.h>
#include <carom/contact/detection/swept_pairs.h>
#include <carom/core/numerics/never.h>

#include <gtest/gtest.h>

#include <cmath>
#include <span>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::every_pair;
using carom_test::MovedModel;

constexpr double rounding = 1e-12;  // numbers of about 1

System turning_bar_in_a_bearing(bool with_stop) {
  System system;
  system.set_default_law({.friction = 0.0, .normal_restitution = 0.0});
  system.add(HalfPlane{.normal = {0.0, 1.0}});
  const BodyId bar = system.add(
      RigidBody{.mass = rod(1.0, 1.0), .position = {0.0, 0.3}, .velocity = {0.5, -0.2}, .spin = 3.0});
  system.add(Point{.body = bar, .position = {0.4, 0.0}});
  system.add(Point{.body = bar, .position = {0.0, 0.0}});
  if (!with_stop) return system;
  const BodyId arm = system.add(RigidBody{.mass = rod(1.0, 1.0), .position = {5.0, 5.0}});
  const JointId pin = system.add(Revolute{.from = ground, .to = arm});
  system.add(Stop{.joint = pin, .lower = -1.0, .upper = 1.0, .restitution = 0.5});
  return system;
}

TEST(SweptFlatPairs, OfPointsThatTurnHaveBoundsOfClosedForm) {
  const MovedModel model(turning_bar_in_a_bearing(false), 1.0);
  SweptPairs pairs(model.assembly, model.detector, FlatPairs::turning);
  (void)pairs.find_outlines(model.path);
  const std::span<const SweptPair> found = pairs.find_pairs(model.path, every_pair);
  ASSERT_EQ(found.size(), 1U);  // not the point at the centre
  // Gap 0.3 - 0.2 t + 0.4 sin 3 t: of its rate the bound is a speed, of its sixth derivative 0.4 3^6.
  EXPECT_NEAR(found[0].gap, 0.3, rounding);
  EXPECT_NEAR(found[0].fastest, std::hypot(0.5, 0.2) + 0.4 * 3.0, rounding);
  EXPECT_NEAR(found[0].sixth, 0.4 * 729.0, 1e-9);
  SweptPairs all(model.assembly, model.detector, FlatPairs::all);
  (void)all.find_outlines(model.path);
  EXPECT_EQ(all.find_pairs(model.path, every_pair).size(), 2U);
}

TEST(SweptFlatPairs, LimitsOfJointsAreListedWithoutBoundsWhereAllAre) {
  const MovedModel model(turning_bar_in_a_bearing(true), 1.0);
  for (const FlatPairs which : {FlatPairs::turning, FlatPairs::all}) {
    SweptPairs pairs(model.assembly, model.detector, which);
    (void)pairs.find_outlines(model.path);
    int limits = 0;
    for (const SweptPair& of : pairs.find_pairs(model.path, every_pair)) {
      if (of.pair.joint_row == none) continue;
      ++limits;
      EXPECT_EQ(of.fastest, never);
      EXPECT_GT(of.gap, 0.0);
    }
    EXPECT_EQ(limits, which == FlatPairs::all ? 2 : 0);
  }
}

}  // namespace
