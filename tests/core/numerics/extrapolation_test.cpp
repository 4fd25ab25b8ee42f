// The guess at the next of some numbers: polynomials are continued exactly, by as many numbers as they need.

#include <carom/core/numerics/extrapolation.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace {

using namespace carom;

/// Values of polynomials of every degree below most_extrapolated at n; small whole numbers have no rounding.
std::vector<double> powers(int n) {
  std::vector<double> values;
  for (std::size_t degree = 0; degree < most_extrapolated; ++degree) {
    values.push_back(3.0 - 2.0 * std::pow(n, static_cast<double>(degree)));
  }
  return values;
}

TEST(Extrapolation, ContinuesPolynomialsOfADegreeBelowTheNumberOfSteps) {
  std::array<std::vector<double>, most_extrapolated> numbers;
  LastNumbers last{};
  for (std::size_t ago = 0; ago < most_extrapolated; ++ago) {
    numbers[ago] = powers(7 - static_cast<int>(ago));
    last[ago] = numbers[ago].data();
  }
  for (std::size_t steps = 1; steps <= most_extrapolated; ++steps) {
    LastNumbers known = last;
    for (std::size_t ago = steps; ago < most_extrapolated; ++ago) known[ago] = nullptr;  // not read
    std::vector<double> guess(most_extrapolated, 0.0);
    extrapolate({0, static_cast<Index>(most_extrapolated)}, known, steps, guess.data());
    for (std::size_t degree = 0; degree < most_extrapolated; ++degree) {
      if (degree < steps) {
        EXPECT_EQ(guess[degree], powers(8)[degree]) << steps << " steps, degree " << degree;
      } else {
        EXPECT_NE(guess[degree], powers(8)[degree]) << steps << " steps, degree " << degree;
      }
    }
  }
}

TEST(Extrapolation, WritesItsRangeAlone) {
  const std::vector<double> now{1.0, 2.0, 3.0, 4.0}, before{0.0, 0.0, 0.0, 0.0};
  std::vector<double> guess(4, -1.0);
  extrapolate({1, 3}, {now.data(), before.data()}, 2, guess.data());
  EXPECT_EQ(guess, (std::vector<double>{-1.0, 4.0, 6.0, -1.0}));
}

}  // namespace
