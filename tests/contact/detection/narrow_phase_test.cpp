// Every entry of the narrow phase against brute force, over random pairs: gaps, margins, order, features.

#include <carom/contact/detection/face_chain.h>
#include <carom/contact/detection/gap_face.h>
#include <carom/contact/detection/narrow_phase.h>

#include "tests/contact/detection/convex_reference.h"
#include "tests/shares.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace {

using namespace carom;
using carom_test::core_distance;
using carom_test::Long;
using carom_test::OwnedOutline;
using carom_test::Random;
using carom_test::random_outline;
using carom_test::reference_gap;

using Gaps = std::array<GapPoint, 2>;
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double tolerance = 2e-14;  // sizes and distances are up to 5
constexpr int samples = carom_test::count_of_samples(3000);

OwnedOutline of_form(Random& random, OutlineForm form) {
  OwnedOutline out = random_outline(random);
  while ((out.vertices.size() == 1) != (form == OutlineForm::disc)) out = random_outline(random);
  return out.moved(0.0, random.vec<2>(1.5));
}

// The gap that was found, to the bit.
void expect_same(const GapPoint& one, const GapPoint& other) {
  EXPECT_EQ(one.feature_a, other.feature_a);
  EXPECT_EQ(one.feature_b, other.feature_b);
  EXPECT_EQ(one.kind, other.kind);
  EXPECT_EQ(one.gap, other.gap);
  EXPECT_EQ(one.normal, other.normal);
  EXPECT_EQ(one.point_a, other.point_a);
  EXPECT_EQ(one.point_b, other.point_b);
  EXPECT_EQ(one.within, other.within);
}

// What holds of all entries, whatever their forms. \returns all gaps
std::vector<GapPoint> expect_rules(const PlacedOutline& a, const PlacedOutline& b, Random& random) {
  Gaps all, found;
  const int count = find_gaps(a, b, infinity, all);
  const auto size = static_cast<std::size_t>(count);
  for (std::size_t k = 0; k < size; ++k) {
    const GapPoint& at = all[k];
    EXPECT_NEAR(at.normal.norm(), 1.0, 4e-16);
    EXPECT_LE((at.point_a - at.point_b - at.gap * at.normal).norm(), tolerance);
    expect_same(at, follow_gap(a, at.feature_a, b, at.feature_b));
    expect_same(at.swapped(), follow_gap(b, at.feature_b, a, at.feature_a));
  }
  // Margins alone decide what is found.
  const double margin = count > 0 ? all[random.below(2) == 0 ? 0 : size - 1].gap + random.uniform(-0.1, 0.1)
                                  : random.uniform(-0.5, 0.5);
  const int within = find_gaps(a, b, margin, found);
  const auto expected =
      std::count_if(all.begin(), all.begin() + count, [&](const GapPoint& gap) { return gap.gap <= margin; });
  EXPECT_EQ(within, expected);
  for (int k = 0; k < within; ++k)
    expect_same(found[static_cast<std::size_t>(k)], all[static_cast<std::size_t>(k)]);
  // Roles are swapped with the order.
  EXPECT_EQ(find_gaps(b, a, margin, found), within);
  for (int k = 0; k < within; ++k)
    expect_same(found[static_cast<std::size_t>(k)].swapped(), all[static_cast<std::size_t>(k)]);
  if (count == 2) {
    EXPECT_LE(all[0].gap, all[1].gap);
  }
  return {all.begin(), all.begin() + count};
}

TEST(NarrowPhase, DiscsAndPolygonsHaveTheirDistance) {
  Random random(301);
  for (const OutlineForm form_a : {OutlineForm::disc, OutlineForm::polygon}) {
    for (const OutlineForm form_b : {OutlineForm::disc, OutlineForm::polygon}) {
      for (int i = 0; i < samples && !HasFailure(); ++i) {
        const OwnedOutline a = of_form(random, form_a), b = of_form(random, form_b);
        ASSERT_EQ(PlacedOutline(a.view()).form, form_a);
        const auto gaps = expect_rules(PlacedOutline(a.view()), PlacedOutline(b.view()), random);
        ASSERT_FALSE(gaps.empty());
        EXPECT_NEAR(gaps[0].gap, static_cast<double>(reference_gap(a, b).gap), tolerance);
      }
    }
  }
}

TEST(NarrowPhase, InsideOfACircleTheFarthestVerticesTouch) {
  Random random(302);
  for (int i = 0; i < 2 * samples && !HasFailure(); ++i) {
    const OwnedOutline a = of_form(random, i % 2 == 0 ? OutlineForm::disc : OutlineForm::polygon);
    const OwnedOutline circle{{random.vec<2>()}, random.uniform(1.0, 4.0)};
    const auto gaps = expect_rules(PlacedOutline(a.view()), PlacedOutline::outside_of(circle.view()), random);
    ASSERT_EQ(gaps.size(), std::min<std::size_t>(2, a.vertices.size()));
    std::vector<double> expected;
    for (const Vec<2>& vertex : a.vertices) {
      const Long off = -core_distance(circle, vertex);
      expected.push_back(static_cast<double>(Long(circle.radius) + off - Long(a.radius)));
    }
    std::sort(expected.begin(), expected.end());
    for (std::size_t k = 0; k < gaps.size(); ++k) EXPECT_NEAR(gaps[k].gap, expected[k], tolerance);
  }
}

// Corners along x, of which some are convex, others concave: free space is above.
std::vector<Vec<2>> terrain(Random& random) {
  std::vector<Vec<2>> line;
  for (int k = 0; k < 8; ++k)
    line.push_back({3.5 - k + random.uniform(-0.3, 0.3), random.uniform(-0.4, 0.4)});
  return line;
}

double least_gap(const OwnedOutline& a, const std::vector<Vec<2>>& line) {
  double least = infinity;
  for (std::size_t k = 0; k + 1 < line.size(); ++k)
    least = std::min(least, static_cast<double>(reference_gap(a, {{line[k], line[k + 1]}, 0.0}).gap));
  return least;
}

TEST(NarrowPhase, AboveFacesTheGapIsTheDistance) {
  Random random(303);
  for (int i = 0; i < 2 * samples && !HasFailure(); ++i) {
    const std::vector<Vec<2>> line = terrain(random);
    const OwnedOutline a = of_form(random, i % 2 == 0 ? OutlineForm::disc : OutlineForm::polygon);
    double lowest = infinity, least = infinity;
    for (const Vec<2>& vertex : a.vertices) lowest = std::min(lowest, vertex[1]);
    const OwnedOutline above = a.moved(0.0, {0.0, 0.5 - lowest + random.uniform(0.0, 0.5)});
    for (std::size_t k = 0; k + 1 < line.size(); ++k) {
      const bool is_first = k == 0, is_last = k + 2 == line.size();
      const GroundFace face{line[is_first ? 0 : k - 1],
                            line[k],
                            line[k + 1],
                            line[is_last ? k + 1 : k + 2],
                            is_first,
                            is_last,
                            0.1};
      for (const GapPoint& gap : expect_rules(PlacedOutline(above.view()), PlacedOutline(face), random))
        least = std::min(least, gap.gap);
    }
    EXPECT_NEAR(least, least_gap(above, line), tolerance);
  }
}

// One whose corners are all convex, or flat: others are ends of chains.
TEST(NarrowPhase, OfAChainTheNearestFeatureTouches) {
  Random random(304);
  int behind = 0;
  for (int i = 0; i < samples && !HasFailure(); ++i) {
    std::vector<Vec<2>> line;
    for (int k = 0; k < 6; ++k) {
      const double angle = 0.3 + 0.4 * (k + random.uniform(-0.3, 0.3));
      line.push_back({2.0 * std::cos(angle), 2.0 * std::sin(angle)});
    }
    std::vector<ChainCorner> corners(line.size(), ChainCorner::convex);
    corners.front() = corners.back() = ChainCorner::free;
    const std::vector<double> depths(line.size(), 0.5);
    const FaceChain chain{{line, 0.0}, corners, false, depths, {}};
    const OwnedOutline disc{{{random.uniform(-2.5, 2.5), random.uniform(0.0, 3.0)}},
                            random.uniform(0.0, 0.5)};
    const auto gaps = expect_rules(PlacedOutline(disc.view()), PlacedOutline(chain), random);
    ASSERT_EQ(gaps.size(), 1U);
    const double distance = least_gap(disc, line) + disc.radius, found = gaps[0].gap + disc.radius;
    EXPECT_NEAR(std::abs(found), distance, tolerance);
    // In the solid it is behind a face.
    if (found < 0.0) {
      ++behind;
      EXPECT_EQ(gaps[0].kind, GapKind::edge_of_b);
      EXPECT_LT(disc.vertices[0].norm(), 2.0);
    }
    EXPECT_EQ(chain.is_below(gaps[0].feature_b, found), found < -0.5);
    EXPECT_EQ(gaps[0].gap, nearest_gap(PlacedOutline(disc.view()), PlacedOutline(chain)).gap);
  }
  EXPECT_GT(behind, samples / 10);
}

TEST(NarrowPhase, PlacesThatAreNoNumbersHaveNoGap) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const OwnedOutline lost{{{nan, 0.0}}, 0.1}, disc{{{0.0, 0.0}}, 1.0},
      box{{{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}}, 0.0};
  const std::array<Vec<2>, 2> ends{Vec<2>(1.0, 0.0), Vec<2>(-1.0, 0.0)};
  const std::array<ChainCorner, 2> corners{ChainCorner::free, ChainCorner::free};
  const std::array<double, 2> depths{1.0, 0.0};
  const FaceChain chain{{ends, 0.0}, corners, false, depths, {}};
  const GroundFace face{ends[0], ends[0], ends[1], ends[1], true, true, 1.0};
  for (const PlacedOutline& b :
       {PlacedOutline(disc.view()), PlacedOutline(box.view()), PlacedOutline::outside_of(disc.view()),
        PlacedOutline(chain), PlacedOutline(face)}) {
    Gaps found;
    EXPECT_EQ(find_gaps(PlacedOutline(lost.view()), b, infinity, found), 0);
    EXPECT_TRUE(std::isnan(nearest_gap(PlacedOutline(lost.view()), b).gap));
  }
}

}  // namespace
