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

// The pre-check of many points decides as the gaps of all of them do, to the bit.
TYPED_TEST(GapPointHalfSpace, AnyIsTheLeastOfAll) {
  constexpr int D = TypeParam::value;
  carom_test::Random random(4102);
  constexpr Index stride = D + 1, count = 9;
  for (int repeat = 0; repeat < 100; ++repeat) {
    const Vec<D> origin = random.vec<D>(), normal = random.vec<D>().normalized();
    std::vector<double> numbers;
    for (Index i = 0; i < stride * count; ++i) numbers.push_back(random.uniform(-1.0, 1.0));
    double least = std::numeric_limits<double>::infinity();
    for (Index i = 0; i < count; ++i) {
      least = std::min(least, gap_point_half_space<D>(numbers.data() + i * stride, origin, normal).distance);
    }
    const PointRow row{numbers.data(), stride, count};
    EXPECT_TRUE(any_point_in_half_space<D>(row, origin, normal, least));
    EXPECT_FALSE(any_point_in_half_space<D>(row, origin, normal, least - 1e-9));
    EXPECT_FALSE(any_point_in_half_space<D>({numbers.data(), stride, 0}, origin, normal, 10.0));
  }
}

}  // namespace
