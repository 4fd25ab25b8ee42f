#include <carom/core/numerics/compensated_sum.h>

#include "tests/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

namespace {

using carom::CompensatedSum;
constexpr double epsilon = std::numeric_limits<double>::epsilon();

TEST(CompensatedSum, StartsAtZeroOrAtTheGivenValue) {
  EXPECT_EQ(CompensatedSum().value(), 0.0);
  EXPECT_EQ(CompensatedSum(2.5).value(), 2.5);
}

TEST(CompensatedSum, KeepsWhatAHugeTermHides) {
  CompensatedSum sum;
  for (const double term : {1.0, 1e100, 1.0, -1e100}) sum.add(term);
  EXPECT_EQ(sum.value(), 2.0);  // a plain sum gives 0, Kahan's too
}

TEST(CompensatedSum, ErrorDoesNotGrowWithTheNumberOfTerms) {
  constexpr int count = 1'000'000;
  CompensatedSum sum;
  double plain = 0.0;
  for (int i = 0; i < count; ++i) {
    sum.add(0.1);
    plain += 0.1;
  }
  // A million times the double next to 0.1, rounded once.
  const double exact = 0.1 * count;
  EXPECT_LE(std::abs(sum.value() - exact), epsilon * exact);
  EXPECT_GT(std::abs(plain - exact), 1e3 * epsilon * exact) << "the terms do not test anything";
}

TEST(CompensatedSum, CancelsInAnyOrder) {
  carom_test::Random random(11);
  for (int repeat = 0; repeat < 100; ++repeat) {
    std::vector<double> terms;
    double sizes = 0.0;
    for (int i = 0; i < 200; ++i) {
      const double term = random.uniform(-1.0, 1.0) * std::exp2(random.uniform(-40.0, 40.0));
      terms.push_back(term);
      terms.push_back(-term);
      sizes += 2.0 * std::abs(term);
    }
    for (std::size_t i = terms.size(); i > 1; --i) {
      std::swap(terms[i - 1], terms[random.below(static_cast<unsigned>(i))]);
    }
    CompensatedSum sum;
    for (const double term : terms) sum.add(term);
    // Second order in rounding: the corrections are added plainly.
    EXPECT_LE(std::abs(sum.value()), epsilon * epsilon * 400.0 * sizes);
  }
}

TEST(CompensatedSum, GoesOnBitForBitAfterSaving) {
  carom_test::Random random(12);
  CompensatedSum whole;
  for (int i = 0; i < 1000; ++i) whole.add(random.uniform(-1.0, 1.0) / 3.0);
  CompensatedSum resumed(whole.raw(), whole.correction());
  for (int i = 0; i < 1000; ++i) {
    const double term = random.uniform(-1.0, 1.0) / 7.0;
    whole.add(term);
    resumed.add(term);
  }
  EXPECT_EQ(whole.raw(), resumed.raw());
  EXPECT_EQ(whole.correction(), resumed.correction());
}

}  // namespace
