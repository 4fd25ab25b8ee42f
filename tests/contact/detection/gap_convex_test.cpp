// The narrow phase of convex outlines where the answer is known: edge on edge, and what is degenerate.

#include <carom/contact/detection/gap_features.h>
#include <carom/contact/detection/narrow_phase.h>

#include "tests/contact/detection/convex_reference.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace {

using namespace carom;
using carom_test::OwnedOutline;
using carom_test::Random;

using Gaps = std::array<GapPoint, 2>;
constexpr double infinity = std::numeric_limits<double>::infinity();

OwnedOutline box(double x, double y, double half_width, double half_height, double radius = 0.0) {
  return {{{x - half_width, y - half_height},
           {x + half_width, y - half_height},
           {x + half_width, y + half_height},
           {x - half_width, y + half_height}},
          radius};
}

OwnedOutline disc(double x, double y, double radius) { return {{{x, y}}, radius}; }

OwnedOutline segment(double x, double y, double x_end, double y_end, double radius = 0.0) {
  return {{{x, y}, {x_end, y_end}}, radius};
}

// Gaps found with a margin, with the one whose point on a is further left first.
std::vector<GapPoint> find(const OwnedOutline& a, const OwnedOutline& b, double margin) {
  Gaps found;
  const int count = find_gaps(a.view(), b.view(), margin, found);
  std::vector<GapPoint> out(found.begin(), found.begin() + count);
  if (count == 2 && out[1].point_a[0] < out[0].point_a[0]) std::swap(out[0], out[1]);
  return out;
}

void expect_gap(const GapPoint& at, Index feature_a, Index feature_b, double gap, const Vec<2>& point_a,
                const Vec<2>& point_b) {
  EXPECT_EQ(at.feature_a, feature_a);
  EXPECT_EQ(at.feature_b, feature_b);
  EXPECT_NEAR(at.gap, gap, 1e-15);
  EXPECT_LE((at.point_a - point_a).norm(), 1e-15);
  EXPECT_LE((at.point_b - point_b).norm(), 1e-15);
}

TEST(GapConvex, DiscsMeetOnTheLineOfCentres) {
  const auto found = find(disc(3, 4, 1), disc(0, 0, 2), 2.5);
  ASSERT_EQ(found.size(), 1U);
  expect_gap(found[0], 0, 0, 2.0, {2.4, 3.2}, {1.2, 1.6});
  EXPECT_EQ(found[0].normal, Vec<2>(0.6, 0.8));
  EXPECT_EQ(found[0].kind, GapKind::vertices);
  EXPECT_EQ(found[0].within, infinity);
  EXPECT_TRUE(find(disc(3, 4, 1), disc(0, 0, 2), 1.9).empty());
  EXPECT_TRUE(find(disc(3, 4, 1), disc(0, 0, 2), -4.0).empty());
  EXPECT_EQ(find(disc(3, 4, 3), disc(0, 0, 2), 0.0).size(), 1U);
}

TEST(GapConvex, OfCentresInOnePlaceTheNormalIsUpwards) {
  const auto found = find(disc(1, 1, 0.5), disc(1, 1, 0.25), 0.0);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].normal, Vec<2>(0, 1));
  EXPECT_EQ(found[0].gap, -0.75);
  expect_gap(found[0], 0, 0, -0.75, {1, 0.5}, {1, 1.25});
}

TEST(GapConvex, NormalsOfTinyDistancesHaveAllDigits) {
  for (const double size : {1e-100, 1e-155, 1e-200, 1e-300, 4e-308}) {
    const auto found = find(disc(3.0 * size, 4.0 * size, 0), disc(0, 0, 0), 0.0);
    EXPECT_TRUE(found.empty());
    Gaps one;
    ASSERT_EQ(find_gaps(disc(3.0 * size, 4.0 * size, 0).view(), disc(0, 0, 0).view(), 1.0, one), 1);
    EXPECT_LE((one[0].normal - Vec<2>(0.6, 0.8)).norm(), 3e-16) << size;
    EXPECT_NEAR(one[0].gap / size, 5.0, 2e-15) << size;
  }
}

TEST(GapConvex, DiscOverPolygon) {
  const OwnedOutline below = box(0, 0, 2, 1, 0.25);
  auto found = find(disc(0.5, 2, 0.5), below, 1.0);  // over its upper edge
  ASSERT_EQ(found.size(), 1U);
  expect_gap(found[0], 0, 6, 0.25, {0.5, 1.5}, {0.5, 1.25});
  EXPECT_EQ(found[0].kind, GapKind::edge_of_b);
  EXPECT_EQ(found[0].normal, Vec<2>(0, 1));
  EXPECT_EQ(found[0].within, 1.5);
  found = find(disc(5, 5, 0.5), below, 10.0);  // off its corner
  ASSERT_EQ(found.size(), 1U);
  expect_gap(found[0], 0, 2, 4.25, {4.7, 4.6}, {2.15, 1.2});
  EXPECT_EQ(found[0].kind, GapKind::vertices);
  EXPECT_EQ(found[0].within, 3.0);
  found = find(disc(1.5, 0.25, 0.5), below, 0.0);  // its centre inside: out by the nearest edge
  ASSERT_EQ(found.size(), 1U);
  expect_gap(found[0], 0, 5, -0.5 - 0.75, {1.0, 0.25}, {2.25, 0.25});
}

TEST(GapConvex, BoxOnBoxTouchesAtTheEndsOfTheOverlap) {
  const OwnedOutline below = box(0, 0, 1, 1);
  auto found = find(box(0, 2, 0.5, 1), below, 0.0);  // both ends of the upper one
  ASSERT_EQ(found.size(), 2U);
  expect_gap(found[0], 0, 6, 0.0, {-0.5, 1}, {-0.5, 1});
  expect_gap(found[1], 1, 6, 0.0, {0.5, 1}, {0.5, 1});
  found = find(box(0, 2, 3, 1), below, 0.0);  // both ends of the lower one
  ASSERT_EQ(found.size(), 2U);
  expect_gap(found[0], 4, 3, 0.0, {-1, 1}, {-1, 1});
  expect_gap(found[1], 4, 2, 0.0, {1, 1}, {1, 1});
  found = find(box(1, 2.25, 1, 1), below, 0.25);  // one end of each, with a gap
  ASSERT_EQ(found.size(), 2U);
  expect_gap(found[0], 0, 6, 0.25, {0, 1.25}, {0, 1});
  expect_gap(found[1], 4, 2, 0.25, {1, 1.25}, {1, 1});
  EXPECT_TRUE(find(box(1, 2.25, 1, 1), below, 0.2).empty());
  for (const double depth : {0.0, 0.25, -0.25}) {  // the same ends: the lower one's edge has them
    found = find(box(0, 2 - depth, 1, 1), below, 0.5);
    ASSERT_EQ(found.size(), 2U);
    expect_gap(found[0], 0, 6, -depth, {-1, 1 - depth}, {-1, 1});
    expect_gap(found[1], 1, 6, -depth, {1, 1 - depth}, {1, 1});
  }
}

TEST(GapConvex, RoundedBoxesTouchAtTheEndsOfTheOverlap) {
  const auto found = find(box(1, 2.5, 1, 1, 0.25), box(0, 0, 1, 1, 0.125), 0.25);
  ASSERT_EQ(found.size(), 2U);
  expect_gap(found[0], 0, 6, 0.125, {0, 1.25}, {0, 1.125});
  expect_gap(found[1], 4, 2, 0.125, {1, 1.25}, {1, 1.125});
}

TEST(GapConvex, EndsOfTiltedEdgesCountWithinTheMargin) {
  const OwnedOutline below = box(0, 0, 10, 1);
  const double tilt = 0.01;
  const OwnedOutline above = box(0, 0, 1, 1).moved(tilt, {0, 2});  // rises to the right
  const double low = 1.0 - std::cos(tilt) - std::sin(tilt), high = low + 2.0 * std::sin(tilt);
  auto found = find(above, below, high + 1e-9);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_NEAR(found[0].gap, low, 1e-15);
  EXPECT_NEAR(found[1].gap, high, 1e-15);
  EXPECT_EQ(found[1].kind, GapKind::edge_of_b);
  found = find(above, below, high - 1e-9);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(found[0].gap, low, 1e-15);
  EXPECT_TRUE(find(above, below, low - 1e-9).empty());
}

// Each of the two contacts of nearly parallel edges is the gap of a corner and an edge, whose projection is
// within that edge; between them there is nothing closer.
TEST(GapConvex, NearlyParallelEdgesMeetAtBothEnds) {
  Random random(7);
  int mixed = 0;
  for (int i = 0; i < 20000 && !HasFailure(); ++i) {
    SCOPED_TRACE(i);
    const double shift = random.uniform(-1.7, 1.7),
                 tilt = random.uniform(-1.0, 1.0) * std::pow(10.0, random.uniform(-17, -3));
    const double gap = random.uniform(-0.01, 0.01);
    const OwnedOutline below = box(0, 0, 1, 0.5), above = box(0, 0, 0.8, 0.5).moved(tilt, {shift, 1.0 + gap});
    const auto found = find(above, below, 0.1);
    ASSERT_EQ(found.size(), 2U);
    const double from = std::max(-1.0, shift - 0.8), to = std::min(1.0, shift + 0.8);
    const double slack = 2.0 * std::abs(tilt) + 1e-15;
    EXPECT_NEAR(found[0].point_a[0], from, slack);
    EXPECT_NEAR(found[1].point_a[0], to, slack);
    for (const GapPoint& at : found) {
      EXPECT_NEAR(at.gap, gap + tilt * (at.point_a[0] - shift), 2.0 * tilt * tilt + 1e-15);
      EXPECT_GE(at.within, -1e-15);
      EXPECT_NE(at.kind, GapKind::vertices);
    }
    mixed += found[0].kind != found[1].kind ? 1 : 0;
  }
  EXPECT_GT(mixed, 5000);
}

TEST(GapConvex, ParallelEdgesBesideEachOtherMeetAtTheirCorners) {
  for (const double tilt : {0.0, 1e-17, -1e-17, 1e-9, -1e-9}) {
    const auto found = find(box(0, 0, 1, 1).moved(tilt, {5, 4}), box(0, 0, 1, 1), 10.0);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].kind, GapKind::vertices);
    EXPECT_EQ(found[0].feature_a, 0U);
    EXPECT_EQ(found[0].feature_b, 2U);
    EXPECT_NEAR(found[0].gap, std::sqrt(13.0), 1e-8);
  }
}

TEST(GapConvex, BoxesCornerOnCorner) {
  const auto found = find(box(2, 2, 1, 1), box(0, 0, 1, 1), 0.0);
  ASSERT_FALSE(found.empty());
  for (const GapPoint& at : found) {
    EXPECT_EQ(at.gap, 0.0);
    EXPECT_EQ(at.point_a, Vec<2>(1, 1));
    EXPECT_EQ(at.point_b, Vec<2>(1, 1));
    EXPECT_EQ(at.within, 0.0);
  }
}

TEST(GapConvex, SegmentsInOneLine) {
  auto found = find(segment(2, 2, 3, 3), segment(0, 0, 1, 1), 5.0);  // apart
  ASSERT_EQ(found.size(), 1U);
  expect_gap(found[0], 0, 1, std::sqrt(2.0), {2, 2}, {1, 1});
  EXPECT_EQ(found[0].kind, GapKind::vertices);
  found = find(segment(0.5, 0.5, 3, 3), segment(0, 0, 1, 1), 5.0);  // overlapping, without thickness
  ASSERT_EQ(found.size(), 2U);
  EXPECT_NEAR(found[0].gap, 0.0, 1e-15);
  EXPECT_NEAR(found[1].gap, 0.0, 1e-15);
  found = find(disc(3, 3, 0), segment(0, 0, 1, 1, 0.5), 5.0);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(found[0].gap, std::sqrt(8.0) - 0.5, 1e-15);
  // A line of no round numbers, where rounding makes one stand beside the other.
  Random random(8);
  for (int i = 0; i < 2000; ++i) {
    const double angle = random.uniform(-3, 3), gap = random.uniform(0.0, 1.0);
    const Vec<2> shift = random.vec<2>(1.0);
    found = find(segment(1 + gap, 0, 3, 0).moved(angle, shift), segment(0, 0, 1, 0).moved(angle, shift), 5.0);
    ASSERT_GE(found.size(), 1U);
    EXPECT_NEAR(found[0].gap, gap, 3e-15);
  }
}

TEST(GapConvex, CapsulesSideBySide) {
  const auto found = find(segment(0, 1, 4, 1, 0.25), segment(3, 0, -2, 0, 0.5), 0.5);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].gap, 0.25);
  EXPECT_EQ(found[1].gap, 0.25);
  EXPECT_EQ(found[0].point_a, Vec<2>(0, 0.75));
  EXPECT_EQ(found[1].point_a, Vec<2>(3, 0.75));
}

TEST(GapConvex, CrossingSegmentsAreSeparatedTheShortestWay) {
  const auto found = find(segment(-0.25, -1, -0.25, 1), segment(-1, 0, 3, 0), 0.0);
  ASSERT_GE(found.size(), 1U);
  Gaps one;
  ASSERT_GE(find_gaps(segment(-0.25, -1, -0.25, 1).view(), segment(-1, 0, 3, 0).view(), 0.0, one), 1);
  EXPECT_EQ(one[0].gap, -0.75);
  EXPECT_EQ(one[0].normal, Vec<2>(-1, 0));
}

TEST(GapConvex, OneWithinTheOther) {
  Gaps found;
  ASSERT_GE(find_gaps(box(0.25, 0, 0.5, 0.5).view(), box(0, 0, 2, 2).view(), 0.0, found), 1);
  EXPECT_EQ(found[0].gap, -2.25);
  EXPECT_EQ(found[0].normal, Vec<2>(1, 0));
  ASSERT_GE(find_gaps(box(0, 0, 1, 1).view(), box(0, 0, 1, 1).view(), 0.0, found), 1);  // the very same
  EXPECT_EQ(found[0].gap, -2.0);
}

TEST(GapConvex, EdgesWithoutLengthAreLeftOut) {
  const OwnedOutline repeated{{{0, 0}, {0, 0}, {1, 0}, {1, 1}, {1, 1}, {0, 1}}, 0.0};
  const auto found = find(disc(0.5, 2, 0.5), repeated, 1.0);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].gap, 0.5);
  const auto points = find(segment(1, 1, 1, 1, 0.5), segment(4, 5, 4, 5, 0.5), 5.0);
  ASSERT_EQ(points.size(), 1U);
  EXPECT_EQ(points[0].gap, 4.0);
}

TEST(GapConvex, TrackedGapGoesOnBeyondTheEdge) {
  const OwnedOutline below = box(0, 0, 1, 1);
  const auto gap_of = [&](double x, double y, Index feature) {
    return gap_of_features(disc(x, y, 0.5).view(), 0, below.view(), feature);
  };
  EXPECT_EQ(gap_of(0.75, 2, 6).gap, 0.5);
  EXPECT_EQ(gap_of(0.75, 2, 6).within, 0.25);
  EXPECT_EQ(gap_of(1.5, 2, 6).gap, 0.5);
  EXPECT_EQ(gap_of(1.5, 2, 6).within, -0.5);
  EXPECT_EQ(gap_of(1.5, -2, 6).gap, -3.5);
  EXPECT_EQ(gap_of(4, 5, 2).gap, 4.5);
  EXPECT_EQ(gap_of(4, 5, 2).within, 3.0);
  EXPECT_EQ(gap_of(0.25, 5, 2).within, -0.75);
  EXPECT_EQ(gap_of_features(below.view(), 6, disc(0.75, 2, 0.5).view(), 0).kind, GapKind::edge_of_a);
  EXPECT_EQ(gap_of_features(below.view(), 6, disc(0.75, 2, 0.5).view(), 0).normal, Vec<2>(0, -1));
}

// A corner that cannot be told from none: rounding chooses before which of its edges a point stands that has
// sunk in by less than it is beside the corner.
TEST(GapConvex, BesideACornerInLineThereIsAnEdge) {
  constexpr double slope = 2.5e-7;
  const std::vector<Vec<2>> corners{{-1.0, -1.0}, {1.0, -1.0}, {1.0, -slope}, {0.0, 0.0}, {-1.0, 0.0}};
  for (const double beside : {1e-13, 1e-12, 1e-11, 1e-10, 1e-9, 1e-6}) {
    for (const double sunk : {0.0, 1e-16, 1e-15, 1e-14, 1e-13}) {
      for (const double x : {-beside, beside}) {
        const Vec<2> point(x, -sunk - (x > 0.0 ? slope * x : 0.0));
        Gaps found;
        ASSERT_EQ(find_gaps({{&point, 1}, 0.0}, {corners, 0.0}, 1e-9, found), 1) << x << ", " << sunk;
        EXPECT_EQ(found[0].kind, GapKind::edge_of_b) << x << ", " << sunk;
        EXPECT_EQ(found[0].feature_b, x > 0.0 ? 7U : 8U) << x << ", " << sunk;
        EXPECT_NEAR(found[0].gap, -sunk, 1e-15) << x << ", " << sunk;
      }
    }
  }
}

}  // namespace
