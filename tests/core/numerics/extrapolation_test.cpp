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

/// Numbers of the last steps of a function of their count, and how many of them the guess should follow.
template <class F>
std::size_t best_of(F&& number, std::size_t known, const std::vector<double>& weight) {
  std::array<std::vector<double>, most_extrapolated> numbers;
  LastNumbers last{};
  for (std::size_t ago = 0; ago < known; ++ago) {
    for (std::size_t i = 0; i < weight.size(); ++i) numbers[ago].push_back(number(30.0 - double(ago), i));
    last[ago] = numbers[ago].data();  // the others are not read
  }
  return best_steps({0, static_cast<Index>(weight.size())}, last, known, weight.data());
}

TEST(BestSteps, AreAsManyAsAPolynomialNeeds) {
  for (std::size_t degree = 0; degree + 2 <= most_extrapolated; ++degree) {
    const auto number = [&](double n, std::size_t i) {
      return std::pow(n - 30.0, double(degree)) + double(i);  // whole numbers, without rounding
    };
    EXPECT_EQ(best_of(number, most_extrapolated, {1.0, 1.0, 1.0}), degree + 1) << "degree " << degree;
  }
}

TEST(BestSteps, AreFewWhereNumbersJumpFromStepToStep) {
  const auto jumps = [](double n, std::size_t) { return std::fmod(n, 2.0) < 0.5 ? 1.0 : -1.0; };
  EXPECT_EQ(best_of(jumps, most_extrapolated, {1.0, 1.0}), 1U);
  const auto turns = [](double n, std::size_t i) { return std::sin(2.0 * n + double(i)); };
  EXPECT_LE(best_of(turns, most_extrapolated, {1.0, 1.0}), 2U);
}

TEST(BestSteps, AreFewerWhereRoundingIsCoarse) {
  const auto wave = [](double n, std::size_t i) { return std::sin(0.05 * n + double(i)); };
  // Differences: 0.05^k of the wave, some 2^k 1e-4 of rounding, which are alike at k = 3.
  const auto coarse = [&](double n, std::size_t i) { return std::round(wave(n, i) * 1e4) / 1e4; };
  const std::vector<double> weight(20, 1.0);
  EXPECT_GE(best_of(wave, most_extrapolated, weight), 8U);
  EXPECT_GE(best_of(coarse, most_extrapolated, weight), 2U);
  EXPECT_LE(best_of(coarse, most_extrapolated, weight), 4U);
}

TEST(BestSteps, CountNumbersByTheirWeight) {
  const auto number = [](double n, std::size_t i) {
    return i == 2 ? (std::fmod(n, 2.0) < 0.5 ? 1.0 : -1.0) : n * n;  // the last, without a neighbour, jumps
  };
  EXPECT_EQ(best_of(number, most_extrapolated, {1.0, 1.0, 1e-9}), 3U);
  EXPECT_EQ(best_of(number, most_extrapolated, {1.0, 1.0, 1e3}), 1U);
}

TEST(BestSteps, AreThoseWhoseGuessCanBeJudged) {
  const auto line = [](double n, std::size_t) { return n; };
  EXPECT_EQ(best_of(line, 1, {1.0, 1.0}), 1U);
  EXPECT_EQ(best_of(line, 2, {1.0, 1.0}), 1U);
  EXPECT_EQ(best_of(line, 3, {1.0, 1.0}), 2U);
}

}  // namespace
