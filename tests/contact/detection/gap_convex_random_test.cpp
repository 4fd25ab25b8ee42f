// The narrow phase of convex outlines against the same by another way, over random pairs.

#include <carom/contact/detection/gap_features.h>
#include <carom/contact/detection/narrow_phase.h>

#include "tests/contact/detection/convex_reference.h"
#include "tests/shares.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace {

using namespace carom;
using carom_test::core_distance;
using carom_test::Long;
using carom_test::OwnedOutline;
using carom_test::Random;
using carom_test::random_outline;
using carom_test::random_pair;
using carom_test::reference_gap;
using carom_test::ReferenceGap;

using Gaps = std::array<GapPoint, 2>;
constexpr double far = 100.0;  // more than any gap here
// Sizes and distances are up to 5; the rounding of some ten operations.
constexpr double tolerance = 2e-14;
constexpr int samples = carom_test::count_of_samples(20000);

double normal_error(const GapPoint& at, const ReferenceGap& reference) {
  return static_cast<double>(
      std::hypot(Long(at.normal[0]) - reference.normal.x, Long(at.normal[1]) - reference.normal.y));
}

// On the surface of an outline, where that looks along a direction: in the set, and nothing of it is farther.
void expect_on_surface(const OwnedOutline& of, const Vec<2>& point, const Vec<2>& direction) {
  EXPECT_LE(static_cast<double>(core_distance(of, point)) - of.radius, tolerance);
  double farthest = -far;
  for (const Vec<2>& vertex : of.vertices) farthest = std::max(farthest, direction.dot(vertex));
  EXPECT_NEAR(direction.dot(point), farthest + of.radius, tolerance);
}

void expect_same_swapped(const Gaps& found, const Gaps& swapped, int count) {
  for (int k = 0; k < count; ++k) {
    const GapPoint &one = found[static_cast<std::size_t>(k)],
                   other = swapped[static_cast<std::size_t>(k)].swapped();
    EXPECT_EQ(one.feature_a, other.feature_a);
    EXPECT_EQ(one.feature_b, other.feature_b);
    EXPECT_EQ(one.kind, other.kind);
    EXPECT_EQ(one.gap, other.gap);
    EXPECT_EQ(one.normal, other.normal);
    EXPECT_EQ(one.point_a, other.point_a);
    EXPECT_EQ(one.point_b, other.point_b);
    EXPECT_EQ(one.within, other.within);
  }
}

TEST(GapConvexRandom, IsTheDistanceOrTheLeastOverlap) {
  Random random(1);
  int overlapping = 0, undirected = 0;
  constexpr int pairs = carom_test::count_of_samples(100000);
  for (int i = 0; i < pairs && !HasFailure(); ++i) {
    SCOPED_TRACE(i);
    const auto [a, b] = random_pair(random);
    const ReferenceGap reference = reference_gap(a, b);
    Gaps found;
    const int count = find_gaps(a.view(), b.view(), far, found);
    ASSERT_GE(count, 1);
    const GapPoint& at = found[0];
    EXPECT_NEAR(at.gap, static_cast<double>(reference.gap), tolerance);
    EXPECT_NEAR(at.normal.norm(), 1.0, 4e-16);
    EXPECT_LE((at.point_a - at.point_b - at.gap * at.normal).norm(), tolerance);
    EXPECT_GE(at.within, -tolerance);
    overlapping += reference.core < 0 ? 1 : 0;
    expect_on_surface(a, at.point_a, -at.normal);
    expect_on_surface(b, at.point_b, at.normal);
    // Hulls that touch but for rounding have no direction, or that of an edge; an overlap may have two that
    // are equally good.
    const bool is_directed = reference.next > 1e-12L && std::abs(reference.core) > 1e-13L;
    undirected += is_directed ? 0 : 1;
    // Edges are at least some 0.05 long.
    if (is_directed) {
      EXPECT_LE(normal_error(at, reference), tolerance);
    }
    EXPECT_GE(found[count == 2 ? 1 : 0].gap, at.gap - tolerance);
  }
  EXPECT_GT(overlapping, pairs / 5);
  EXPECT_LT(undirected, pairs / 10);
}

TEST(GapConvexRandom, MarginAloneDecidesWhatIsFound) {
  Random random(2);
  int none_found = 0, one_found = 0;
  for (int i = 0; i < samples && !HasFailure(); ++i) {
    SCOPED_TRACE(i);
    const auto [a, b] = random_pair(random);
    Gaps all, found;
    const int of_all = find_gaps(a.view(), b.view(), far, all);
    const double margin = random.uniform(-0.2, 0.3);
    const int count = find_gaps(a.view(), b.view(), margin, found);
    int expected = 0;
    for (int k = 0; k < of_all; ++k) expected += all[static_cast<std::size_t>(k)].gap <= margin ? 1 : 0;
    ASSERT_EQ(count, expected);
    expect_same_swapped(found, {all[0].swapped(), all[1].swapped()}, count);
    none_found += count == 0 ? 1 : 0;
    one_found += count == 1 ? 1 : 0;
  }
  EXPECT_GT(none_found, samples / 20);
  EXPECT_GT(one_found, samples / 20);
}

TEST(GapConvexRandom, OrderOfOutlinesSwapsRolesToTheBit) {
  Random random(3);
  for (int i = 0; i < samples && !HasFailure(); ++i) {
    SCOPED_TRACE(i);
    const auto [a, b] = random_pair(random);
    const bool is_in_one_place = a.vertices == b.vertices;  // of two points: then the direction is a choice
    if (is_in_one_place) continue;
    Gaps found, swapped;
    const int count = find_gaps(a.view(), b.view(), far, found);
    ASSERT_EQ(find_gaps(b.view(), a.view(), far, swapped), count);
    expect_same_swapped(found, swapped, count);
  }
}

TEST(GapConvexRandom, MovesWithTheOutlines) {
  Random random(4);
  int other_features = 0;
  for (int i = 0; i < samples && !HasFailure(); ++i) {
    SCOPED_TRACE(i);
    const auto [a, b] = random_pair(random);
    const double angle = random.uniform(-3.0, 3.0);
    const Vec<2> shift = random.vec<2>(3.0);
    Gaps found, moved;
    ASSERT_GE(find_gaps(a.view(), b.view(), far, found), 1);
    ASSERT_GE(find_gaps(a.moved(angle, shift).view(), b.moved(angle, shift).view(), far, moved), 1);
    EXPECT_NEAR(found[0].gap, moved[0].gap, tolerance);
    // Rounding decides what meets where two are equally close, as where outlines touch with corners.
    if (found[0].feature_a != moved[0].feature_a || found[0].feature_b != moved[0].feature_b) {
      ++other_features;
      continue;
    }
    EXPECT_LE((OwnedOutline{{found[0].point_a}}.moved(angle, shift).vertices[0] - moved[0].point_a).norm(),
              2e-12);  // along an edge rounding counts as often as it is shorter than 1
  }
  EXPECT_LT(other_features, samples / 10);
}

TEST(GapConvexRandom, TrackedGapIsTheOneFound) {
  Random random(5);
  for (int i = 0; i < 5000 && !HasFailure(); ++i) {
    const auto [a, b] = random_pair(random);
    Gaps found;
    const int count = find_gaps(a.view(), b.view(), far, found);
    for (int k = 0; k < count; ++k) {
      const GapPoint& at = found[static_cast<std::size_t>(k)];
      Gaps again{gap_of_features(a.view(), at.feature_a, b.view(), at.feature_b).swapped(), {}};
      expect_same_swapped({at, {}}, again, 1);
    }
  }
}

}  // namespace
