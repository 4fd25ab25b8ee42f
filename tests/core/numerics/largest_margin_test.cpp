// The largest margin of random lines: multipliers prove it, as those of any linear program do.

#include "tests/random.h"

#include <carom/core/numerics/largest_margin.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace {

using namespace carom;
using carom_test::Random;

constexpr double rounding = 1e-10;  // of numbers of the size of 1, through up to 40 pivots

/// Lines a + s . x.
struct Lines {
  std::vector<double> at;
  std::vector<std::vector<double>> slopes;

  [[nodiscard]] double least(std::span<const double> x) const {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < at.size(); ++i) {
      double value = at[i];
      for (std::size_t k = 0; k < x.size(); ++k) value += slopes[i][k] * x[k];
      least = std::min(least, value);
    }
    return least;
  }
};

bool solve(const Lines& lines, std::size_t unknowns, double bound, LargestMargin& program) {
  program.start(unknowns);
  for (std::size_t i = 0; i < lines.at.size(); ++i) {
    const std::span<double> slopes = program.add(lines.at[i]);
    std::copy(lines.slopes[i].begin(), lines.slopes[i].end(), slopes.begin());
  }
  return program.solve(bound);
}

/// Numbers y >= 0 with sum y = 1 and sum y s = 0 bound every margin by sum y a: that one is reached proves
/// it.
void expect_largest(const Lines& lines, std::size_t unknowns, double bound, const LargestMargin& program) {
  double sum = 0.0, largest = 0.0;
  std::vector<double> slope(unknowns, 0.0);
  for (std::size_t i = 0; i < lines.at.size(); ++i) {
    const double y = program.multipliers()[i];
    EXPECT_GE(y, -rounding);
    sum += y;
    largest += y * lines.at[i];
    for (std::size_t k = 0; k < unknowns; ++k) slope[k] += y * lines.slopes[i][k];
  }
  EXPECT_LE(sum, 1.0 + rounding);
  largest += (1.0 - sum) * bound;
  for (const double s : slope) EXPECT_NEAR(s, 0.0, rounding);
  EXPECT_NEAR(std::min(lines.least(program.x()), bound), largest, rounding);
}

Lines random_lines(Random& random, std::size_t lines, std::size_t unknowns) {
  Lines out;
  for (std::size_t i = 0; i < lines; ++i) {
    out.at.push_back(random.uniform(-1.0, 1.0));
    std::vector<double>& slopes = out.slopes.emplace_back();
    for (std::size_t k = 0; k < unknowns; ++k) slopes.push_back(random.uniform(-1.0, 1.0));
  }
  return out;
}

TEST(LargestMargin, MultipliersProveItForRandomLines) {
  Random random(11);
  LargestMargin program;
  for (int trial = 0; trial < 400; ++trial) {
    const std::size_t unknowns = 1 + random.below(9), count = unknowns + 1 + random.below(90);
    const Lines lines = random_lines(random, count, unknowns);
    ASSERT_TRUE(solve(lines, unknowns, 100.0, program));
    expect_largest(lines, unknowns, 100.0, program);
  }
}

TEST(LargestMargin, LinesThatAreEqualOrDependEndToo) {
  Random random(12);
  LargestMargin program;
  for (int trial = 0; trial < 200; ++trial) {
    const std::size_t unknowns = 2 + random.below(4);
    Lines lines = random_lines(random, 20, unknowns);
    for (std::size_t i = 0; i < 20; ++i) {
      lines.slopes[i].back() = lines.slopes[i].front();  // one unknown is not needed
      lines.at.push_back(lines.at[i]);
      lines.slopes.push_back(lines.slopes[i]);
      if (i % 2 == 0) lines.at[i] = 0.0;
    }
    ASSERT_TRUE(solve(lines, unknowns, 100.0, program));
    expect_largest(lines, unknowns, 100.0, program);
  }
}

TEST(LargestMargin, WithoutALargestOneTheBoundIsReached) {
  LargestMargin program;
  const Lines rise{{-1.0, 0.0}, {{1.0, 0.0}, {1.0, 1.0}}};
  ASSERT_TRUE(solve(rise, 2, 3.0, program));
  EXPECT_GE(rise.least(program.x()), 3.0 - rounding);
  EXPECT_EQ(program.multipliers()[0] + program.multipliers()[1], 0.0);
}

TEST(LargestMargin, UnknownsThatNoLineNeedsStayZero) {
  LargestMargin program;
  const Lines lines{{1.0, 2.0}, {{1.0, 0.0}, {-1.0, 0.0}}};
  ASSERT_TRUE(solve(lines, 2, 10.0, program));
  EXPECT_NEAR(program.x()[0], 0.5, rounding);
  EXPECT_EQ(program.x()[1], 0.0);
}

}  // namespace
