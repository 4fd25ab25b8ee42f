// The largest of some numbers, two at a time: any number of them, and none that is no number.

#include <carom/core/numerics/largest_of.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace {

using namespace carom;

double largest_magnitude(Range range, const std::vector<double>& of) {
  return largest_of(range, [&](auto at) { return magnitude(at(of.data())); });
}

TEST(LargestOf, IsThatOfItsRange) {
  const std::vector<double> numbers{9.0, -3.0, 1.0, 4.0, -5.0, 2.0, 8.0};
  for (Index begin = 0; begin < 7; ++begin) {
    for (Index end = begin; end <= 7; ++end) {
      double largest = 0.0;
      for (Index i = begin; i < end; ++i) largest = std::max(largest, std::abs(numbers[i]));
      EXPECT_EQ(largest_magnitude({begin, end}, numbers), largest) << begin << " to " << end;
    }
  }
}

TEST(LargestOf, PassesOverWhatIsNoNumber) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t place = 0; place < 5; ++place) {
    std::vector<double> numbers{1.0, 2.0, 3.0, 2.0, 1.0};
    numbers[place] = nan;
    EXPECT_EQ(largest_magnitude({0, 5}, numbers), place == 2 ? 2.0 : 3.0) << place;
  }
  const std::vector<double> above{0.0, 6.0, 0.0}, below{0.0, 2.0, 0.0};
  EXPECT_EQ(largest_of({0, 3}, [&](auto at) { return at(above.data()) / at(below.data()); }), 3.0);
}

TEST(LargestOf, CombinesArrays) {
  const std::vector<double> a{1.0, 2.0, 3.0}, b{3.0, 3.0, 1.0};
  EXPECT_EQ(largest_of({0, 3}, [&](auto at) { return at(a.data()) * at(b.data()); }), 6.0);
}

}  // namespace
