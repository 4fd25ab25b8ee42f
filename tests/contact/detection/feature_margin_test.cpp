// Sharp corners close to each other: which of the two touches an edge of the other outline?

#include "tests/integrators/event_driven/body_scenes.h"

#include <carom/contact/detection/feature_margin.h>

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace {

using namespace body_scenes;

/// A box of 1 m by 1 m, and another one on it whose lower right corner is this far from the upper right
/// corner of the first; each as seen from that corner of the other.
struct TwoCorners {
  std::vector<Vec<2>> corners = corners_of(1.0, 1.0);
  PlaneFrame lower, upper;
  FeatureLengths lengths;

  TwoCorners(double right, double up) { upper.centre = {right, 1.0 + up}; }

  /// The upper box's corner 1 before the lower box, whose corner 2 it is near.
  [[nodiscard]] FeatureRegions of_upper() const {
    return FeatureRegions({upper, lower, corners[1], {corners, 0.0}, {corners, 0.0}, {}, lengths});
  }
  /// The lower box's corner 2 before the upper box.
  [[nodiscard]] FeatureRegions of_lower() const {
    return FeatureRegions({lower, upper, corners[2], {corners, 0.0}, {corners, 0.0}, {}, lengths});
  }
};

TEST(FeatureMargin, ACornerTouchesTheEdgeThatItStandsBefore) {
  // 5e-9 m to the left of the end of the upper edge (feature 4 + 2, from corner 2 on).
  const TwoCorners at(-5e-9, 0.0);
  EXPECT_EQ(at.of_upper().nearest(), 6U);
  EXPECT_TRUE(at.of_upper().may_touch());
}

TEST(FeatureMargin, CornersInOnePlaceTouchEachOther) {
  for (const double off : {-0.9e-9, 0.0, 0.9e-9}) {
    EXPECT_TRUE(TwoCorners(off, 0.0).of_upper().may_touch()) << off;
    EXPECT_TRUE(TwoCorners(off, 0.0).of_lower().may_touch()) << off;
  }
}

// How exact places are is for the user to say, who knows how large the bodies are.
TEST(FeatureMargin, LengthsToWhichCornersAreToldApartAreParameters) {
  TwoCorners at(0.9e-6, 1e-9);
  EXPECT_FALSE(at.of_upper().may_touch());
  at.lengths.corner = 1e-6;
  EXPECT_TRUE(at.of_upper().may_touch());
  EXPECT_EQ(at.of_upper().border(), 2e-6);
  TwoCorners small(0.9e-9, 1e-12);
  small.lengths.corner = 1e-12;
  EXPECT_FALSE(small.of_upper().may_touch());
}

// A vertex that comes to a border stands on either side of it to the rounding that the zero was found to: it
// has come there.
TEST(FeatureMargin, AVertexAtABorderComesToTheNextFeature) {
  const std::vector<Vec<2>> ends{{-1.0, 0.0}, {1.0, 0.0}};
  const Vec<2> disc(0.0, 0.0);
  PlaneFrame of_disc, of_capsule;
  of_disc.velocity = {1.0, 0.0};
  constexpr double rounding = 1e-11;
  for (const double short_of : {-0.9 * rounding, 0.0, 0.9 * rounding, 3.0 * rounding}) {
    of_disc.centre = {1.0 - short_of, 0.2};
    const FeatureRegions regions({of_disc, of_capsule, disc, {{&disc, 1}, 0.1}, {ends, 0.1}, {}, {}});
    const bool there = short_of <= rounding;
    EXPECT_EQ(regions.coming(0.0, rounding) == 1, there) << short_of;  // the round end
  }
}

TEST(FeatureMargin, OfTwoCornersThatOneTouchesThatStandsBeforeAnEdge) {
  // The upper box juts out: its corner stands beyond the end of the edge below it, within what a contact
  // follows it, while the corner of the lower box stands before its edge.
  for (const double beyond : {1.5e-9, 3e-9}) {
    for (const double up : {-1e-14, 0.0, 1e-14}) {
      const TwoCorners at(beyond, up);
      EXPECT_EQ(at.of_upper().nearest(), 2U) << beyond << ' ' << up;  // the corner: the gap is a distance
      EXPECT_FALSE(at.of_upper().may_touch());
      EXPECT_EQ(at.of_lower().nearest(), 4U);
      EXPECT_TRUE(at.of_lower().may_touch());
    }
  }
}

TEST(FeatureMargin, CornersInEachOtherTouch) {
  for (const double right : {-2e-9, 2e-9}) {
    const TwoCorners at(right, -2e-9);
    EXPECT_TRUE(at.of_upper().may_touch() || at.of_lower().may_touch()) << right;
  }
}

TEST(FeatureMargin, BeyondTheEndOfACapsuleIsTheEdgeOnTheSideOfTheVertex) {
  const std::vector<Vec<2>> ends{{-1.0, 0.0}, {1.0, 0.0}};
  const Vec<2> disc = Vec<2>::Zero();
  for (const double side : {-1.0, 1.0}) {
    PlaneFrame of_disc, of_capsule;
    of_disc.centre = {1.0 + 1e-3, 0.2 * side};  // before the right end, on its way to the edge
    of_disc.velocity = {-1.0, 0.0};
    const FeatureRegions regions({of_disc, of_capsule, disc, {{&disc, 1}, 0.1}, {ends, 0.1}, {}, {}});
    ASSERT_EQ(regions.nearest(), 1U);
    // Of two vertices the edge from 0 to 1 looks down (feature 2), the one back up (3).
    EXPECT_EQ(regions.margin(1).beyond, side < 0.0 ? 2U : 3U);
    EXPECT_NEAR(regions.margin(1).value, 1e-3, 1e-15);
  }
}

// A floor between two inner corners: contact that lasts goes on to its ends, but a gap is smooth only as far
// as the point stands before the face, and above the depth of the solid.
TEST(FeatureMargin, OfAFaceBetweenInnerCornersTheGapIsSmoothWithinIt) {
  const std::vector<Vec<2>> ends{{2.0, 0.0}, {0.0, 0.0}};  // free space is on the right of the face
  const std::vector<ChainCorner> corners{ChainCorner::concave, ChainCorner::concave};
  const std::array depths{1.0, 0.0};
  const FaceChain floor{{ends, 0.0}, corners, false, depths, {}};
  constexpr Index face = 2;
  const auto margin = [&](const Vec<2>& at) { return floor.margin(face, at, Vec<2>::Zero()).value; };
  for (const Vec<2>& at : {Vec<2>(0.5, 0.3), Vec<2>(1.0, -0.9), Vec<2>(1.75, -0.2)}) {
    EXPECT_EQ(floor.nearest(at).feature, face);
    EXPECT_EQ(margin(at), std::numeric_limits<double>::infinity());
  }
  EXPECT_DOUBLE_EQ(floor.clearance(face, {0.5, 0.3}), 0.5);
  EXPECT_NEAR(floor.clearance(face, {1.0, -0.9}), 0.1, 1e-15);
  EXPECT_DOUBLE_EQ(floor.clearance(face, {1.75, -0.2}), 0.25);
}

}  // namespace
