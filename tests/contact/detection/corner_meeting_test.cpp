// Two sharp corners in one place: which directions are normals of both, and which two contacts they have.

#include "tests/random.h"

#include <carom/contact/detection/corner_meeting.h>
#include <carom/contact/detection/covered_side.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

namespace {

using namespace carom;
using carom_test::Random;

Vec<2> direction(double angle) { return {std::cos(angle), std::sin(angle)}; }

/// A corner whose outward normals are those from one angle counter-clockwise to another.
SharpCorner corner_of_normals(double from, double to, const Vec<2>& at = Vec<2>::Zero()) {
  // An edge with normal n runs counter-clockwise along n turned to the left.
  const Vec<2> in(-std::sin(from), std::cos(from)), out(-std::sin(to), std::cos(to));
  return {at - in, at, at + out, false, 0, 4, 3};
}

SharpCorner point_at(const Vec<2>& at) { return {at, at, at, true, 0, 1, 1}; }

constexpr double pi = 3.14159265358979323846;

TEST(CornerMeeting, OfCardsThatLeanOnEachOtherEitherHasOneEnd) {
  // The left card's upper right corner, leaning to the right by a; from b = the right one to a = the left
  // one.
  const double a = 0.3;
  const SharpCorner left = corner_of_normals(-a, 0.5 * pi - a),
                    right = corner_of_normals(0.5 * pi + a, pi + a);
  const std::optional<CommonCone> cone = common_cone(left, right);
  ASSERT_TRUE(cone);
  EXPECT_FALSE(cone->is_of_one());
  EXPECT_NEAR((cone->lower.normal - direction(pi - a)).norm(), 0.0, 1e-15);
  EXPECT_NEAR((cone->upper.normal - direction(pi + a)).norm(), 0.0, 1e-15);
  EXPECT_TRUE(cone->lower.is_of_a);
  EXPECT_FALSE(cone->upper.is_of_a);
}

TEST(CornerMeeting, OfAPointOnARidgeBothEndsAreOfTheRidge) {
  const std::optional<CommonCone> cone = common_cone(point_at({0.0, 0.0}), corner_of_normals(1.0, 2.5));
  ASSERT_TRUE(cone);
  EXPECT_TRUE(cone->is_of_one());
  EXPECT_FALSE(cone->lower.is_of_a);
  EXPECT_NEAR((cone->lower.normal - direction(1.0)).norm(), 0.0, 1e-15);
  EXPECT_NEAR((cone->upper.normal - direction(2.5)).norm(), 0.0, 1e-15);
}

TEST(CornerMeeting, EdgesThatLieOnEachOtherHaveOneDirection) {
  // A box flush on another one; and a point at the end of a segment, which pushes across it only.
  EXPECT_FALSE(common_cone(corner_of_normals(-0.5 * pi, 0.0), corner_of_normals(0.0, 0.5 * pi)));
  EXPECT_FALSE(common_cone(point_at({0.0, 0.0}), corner_of_normals(-0.5 * pi, 0.5 * pi)));
}

TEST(CornerMeeting, TheConeIsWhatBothConesHaveInCommon) {
  Random random(11);
  int found = 0, of_one = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const double from_a = random.uniform(-pi, pi), to_a = from_a + random.uniform(0.1, 3.0);
    const double from_b = random.uniform(-pi, pi), to_b = from_b + random.uniform(0.1, 3.0);
    const SharpCorner a = corner_of_normals(from_a, to_a), b = corner_of_normals(from_b, to_b);
    const std::optional<CommonCone> cone = common_cone(a, b);
    found += cone ? 1 : 0;
    of_one += cone && cone->is_of_one() ? 1 : 0;
    const auto turns_to = [](double from, double angle) {
      const double turn = std::fmod(angle - from, 2.0 * pi);
      return turn < 0.0 ? turn + 2.0 * pi : turn;
    };
    for (int i = 0; i < 64; ++i) {
      const double angle = random.uniform(-pi, pi);
      const bool is_in =
          turns_to(from_b, angle) <= to_b - from_b && turns_to(from_a, angle + pi) <= to_a - from_a;
      const auto left_of = [&](const Vec<2>& n) { return n[0] * std::sin(angle) - n[1] * std::cos(angle); };
      const bool is_in_cone = cone && left_of(cone->lower.normal) >= 0.0 &&
                              left_of(cone->upper.normal) <= 0.0 &&
                              direction(angle).dot(cone->lower.normal + cone->upper.normal) > 0.0;
      EXPECT_EQ(is_in, is_in_cone) << trial;
    }
    // With the corners in the other order it is the same one, turned by half a circle.
    const std::optional<CommonCone> other = common_cone(b, a);
    ASSERT_EQ(cone.has_value(), other.has_value());
    if (!cone) continue;
    EXPECT_EQ(cone->lower.normal, -other->lower.normal);
    EXPECT_EQ(cone->lower.is_of_a, !other->lower.is_of_a);
    EXPECT_EQ(cone->upper.normal, -other->upper.normal);
  }
  EXPECT_GT(found, 500);
  EXPECT_GT(of_one, 100);
}

TEST(CornerMeeting, CornersMeetInOnePlaceWhenTheyCameFromThereAndWhereTheyDidBefore) {
  const SharpCorner ridge = corner_of_normals(1.0, 2.5);
  const auto meets = [&](const Vec<2>& at, const Vec<2>& velocity, bool lasts) {
    const SharpCorner point = point_at(at);
    const ConeEnd lower{direction(1.0), false, false}, upper{direction(2.5), false, true};
    GapPoint first = gap_along(lower, point, ridge);
    const GapPoint other = gap_along(upper, point, ridge);
    if (other.gap > first.gap) first = other;
    return second_contact(first, {point, ridge, 1e-9, lasts, velocity}).has_value();
  };
  const Vec<2> middle = direction(1.75), aside = direction(1.4);
  EXPECT_TRUE(meets({0.0, 0.0}, {0.0, 0.0}, false));
  EXPECT_TRUE(meets(-1e-3 * middle, {0.0, 0.0}, false));  // gaps are the same
  EXPECT_FALSE(meets(-1e-3 * aside, {0.0, 0.0}, false));  // and here they are not,
  EXPECT_FALSE(meets(-1e-3 * aside, {0.0, 0.0}, true));
  EXPECT_FALSE(meets(-1e-5 * aside, {0.0, 0.0}, false));
  EXPECT_TRUE(meets(-1e-5 * aside, {0.0, 0.0}, true));       // unless they met before and are near,
  EXPECT_TRUE(meets(-1e-3 * aside, -2.0 * aside, false));    // or came straight from the corner
  EXPECT_FALSE(meets(-1e-3 * aside, -2.0 * middle, false));  // not from beside it,
  const Vec<2> along = direction(1.0 - 0.5 * pi);
  EXPECT_FALSE(meets(1e-3 * along, along, false));  // or along an edge
}

// Two outlines with faces that lie on each other, turned by `turn` against the line x = 0 between them,
// either the image of the other: at the end of the overlap away from where corners meet, either face has a
// contact.
TEST(CornerMeeting, FacesThatSeparateEquallyHaveAContactEach) {
  Random random(7);
  for (int trial = 0; trial < 100; ++trial) {
    SCOPED_TRACE(trial);
    const double turn = random.uniform(1e-4, 0.2), depth = random.uniform(0.0, 1e-2);
    // The upper right corner of the left outline, and its image.
    const SharpCorner b = corner_of_normals(-turn, random.uniform(0.2, 1.5), {depth, 0.0});
    SharpCorner a;
    const auto in_mirror = [](const Vec<2>& point) { return Vec<2>(-point[0], point[1]); };
    a = {in_mirror(b.behind), in_mirror(b.at), in_mirror(b.before), false, 0, 4, 3};
    CornerMeeting meeting{a, b, 1e-9};
    const GapPoint first = gap_along({direction(-turn), false, false}, a, b);
    ASSERT_EQ(first.kind, GapKind::edge_of_b);
    const std::optional<GapPoint> other = along_other_face(first, meeting);
    ASSERT_TRUE(other);
    EXPECT_EQ(other->kind, GapKind::edge_of_a);
    EXPECT_NEAR((other->normal - direction(turn)).norm(), 0.0, 1e-14);
    EXPECT_NEAR(other->gap, first.gap, 1e-14);
    // Where one of them lies farther in the other, its face is no longer the one that separates.
    meeting.a.at[1] += 1e-3;
    meeting.a.before[1] += 1e-3;
    meeting.a.behind[1] += 1e-3;
    EXPECT_FALSE(along_other_face(first, meeting));
  }
}

TEST(CornerMeeting, FacesThatLieFlatOnEachOtherHaveOneContact) {
  const SharpCorner b = corner_of_normals(0.0, 1.0), a = corner_of_normals(2.0, pi);
  const GapPoint first = gap_along({direction(0.0), false, false}, a, b);
  EXPECT_FALSE(along_other_face(first, {a, b, 1e-9}));
}

/// Which side of the upper left corner of a box, in the origin, another box covers that lies left of it.
HiddenSide hidden_beside(double higher, double apart, double turned = 0.0) {
  std::vector<Vec<2>> box{{-1.0, -0.5}, {0.0, -0.5}, {0.0, 0.0}, {-1.0, 0.0}};
  for (Vec<2>& corner : box) {
    const Vec<2> at = corner;
    corner = Vec<2>(std::cos(turned) * at[0] - std::sin(turned) * at[1] - apart,
                    std::sin(turned) * at[0] + std::cos(turned) * at[1] + higher);
  }
  const std::vector<Vec<2>> own{{0.0, -0.5}, {2.0, -0.5}, {2.0, 0.0}, {0.0, 0.0}};
  return side_covered_by({box, 0.0}, SharpCorner::of({own, 0.0}, 3), FeatureLengths{});
}

TEST(CornerMeeting, ANeighbourCoversASideWhereItIsFlush) {
  const double same = FeatureLengths{}.corner;
  for (const double part : {-0.9, 0.0, 0.9}) {
    EXPECT_EQ(hidden_beside(part * same, 0.0), HiddenSide::behind);
    EXPECT_EQ(hidden_beside(0.0, part * same), HiddenSide::behind);
  }
  for (const double part : {-2.0, 2.0}) EXPECT_EQ(hidden_beside(part * same, 0.0), HiddenSide::neither);
  EXPECT_EQ(hidden_beside(0.0, 2.0 * same), HiddenSide::neither);
  EXPECT_EQ(hidden_beside(0.0, 0.0, 1e-5), HiddenSide::neither);
  EXPECT_EQ(hidden_beside(0.0, 0.0, -1e-5), HiddenSide::neither);
}

TEST(CornerMeeting, WhatSlidesOverAFlushSeamMeetsNoSide) {
  // The lower right corner of a box, a, as near before the upper left one of the second tile as may be.
  for (const double before : {1e-13, 1e-10}) {
    SharpCorner tile = corner_of_normals(0.5 * pi, pi);
    tile.hidden = HiddenSide::behind;
    const SharpCorner box = corner_of_normals(-0.5 * pi, 0.0, {-before, 0.0});
    CornerMeeting meeting{box, tile, 1e-9};
    GapPoint contact = gap_along({{-1.0, 0.0}, false, true}, box, tile);
    EXPECT_NEAR(contact.gap, before, 1e-25);
    EXPECT_TRUE(leave_hidden_side(contact, meeting));
    EXPECT_NEAR((contact.normal - direction(0.5 * pi)).norm(), 0.0, 1e-15);
    EXPECT_FALSE(second_contact(contact, meeting));
  }
}

}  // namespace
