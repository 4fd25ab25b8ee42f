#include <carom/contact/detection/gap_point_half_space.h>

#include "tests/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <type_traits>
#include <vector>

namespace {

using namespace carom;

constexpr double epsilon = std::numeric_limits<double>::epsilon();

template <class D>
class GapPointHalfSpace : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(GapPointHalfSpace, Dimensions);

TYPED_TEST(GapPointHalfSpace, IsTheHeightOverTheBoundary) {
  constexpr int D = TypeParam::value;
  carom_test::Random random(4101);
  for (int repeat = 0; repeat < 100; ++repeat) {
    const Vec<D> origin = random.vec<D>(), normal = random.vec<D>().normalized();
    Vec<D> along = random.vec<D>();
    along -= along.dot(normal) * normal;
    const double height = random.uniform(-2.0, 2.0);
    const Vec<D> point = origin + along + height * normal;
    const Gap gap = gap_point_half_space<D>(point.data(), origin, normal);
    EXPECT_NEAR(gap.distance, height, 32 * epsilon);
    EXPECT_EQ(Vec<D>(gap.normal.data()), normal);
  }
}

// The pre-check of many points decides as the gap of each of them does, to the bit.
TYPED_TEST(GapPointHalfSpace, ManyPointsAreWithinAsEachOfThem) {
  constexpr int D = TypeParam::value;
  carom_test::Random random(4102);
  constexpr Index stride = D + 1;
  for (const Index count : {Index{0}, Index{1}, Index{9}, Index{64}}) {
    for (int repeat = 0; repeat < 100; ++repeat) {
      const Vec<D> origin = random.vec<D>(), normal = random.vec<D>().normalized();
      std::vector<double> numbers{0.0};
      for (Index i = 0; i < stride * count; ++i) numbers.push_back(random.uniform(-1.0, 1.0));
      if (count > 1) numbers[0] = std::numeric_limits<double>::quiet_NaN();
      const PointRow row{numbers.data(), stride, count};
      const auto distance = [&](Index i) {
        return gap_point_half_space<D>(row.point(i), origin, normal).distance;
      };
      const double margin = count > 1 ? distance(1) : random.uniform(-1.0, 1.0);  // one just within
      std::uint64_t expected = 0;
      for (Index i = 0; i < count; ++i) expected |= std::uint64_t{!(distance(i) > margin)} << i;
      EXPECT_EQ(points_in_half_space<D>(row, origin, normal, margin), expected);
      if (count > 1) {
        EXPECT_NE(expected & 1, 0U);  // no number
        const std::uint64_t less = points_in_half_space<D>(row, origin, normal, margin - 1e-9);
        EXPECT_EQ(less & 2, 0U);
      }
    }
  }
}

}  // namespace
