#include <carom/core/numerics/rank_revealing_qr.h>

#include <carom/core/numerics/accurate_dot.h>

#include "tests/contact/random_problems.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace carom {
namespace {

using contact_test::Random;

std::vector<double> product(const std::vector<double>& a, const std::vector<double>& x, std::size_t rows) {
  std::vector<double> b(rows, 0.0);
  for (std::size_t i = 0; i < rows; ++i) {
    for (std::size_t j = 0; j < x.size(); ++j) b[i] += a[i * x.size() + j] * x[j];
  }
  return b;
}

TEST(AccurateDot, SurvivesCancellation) {
  // 1e16 + 1 - 1e16 = 1, and products that cancel to their last bits.
  EXPECT_EQ(accurate_dot(std::vector{1e8, 1.0, -1e8}, std::vector{1e8, 1.0, 1e8}, 0.0), 1.0);
  const double a = 1.0 + std::exp2(-30), b = 1.0 - std::exp2(-30);
  EXPECT_EQ(accurate_dot(std::vector{a}, std::vector{b}, -1.0), -std::exp2(-60));
}

TEST(RankRevealingQr, SolvesRegularSystems) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Random random(seed);
    const auto n = static_cast<std::size_t>(random.integer(1, 12));
    std::vector<double> a(n * n), x(n), found(n);
    // Integers: the product is exact, so the error of the solution is all the solver's.
    for (double& value : a) value = random.integer(-9, 9);
    for (double& value : x) value = random.integer(-99, 99);
    RankRevealingQr qr;
    qr.factor(a, n, n, 1e-12);
    if (qr.rank() < n) continue;
    qr.solve(product(a, x, n), found);
    // Refined in twofold precision: correct to the last digits while eps cond << 1.
    if (qr.reciprocal_condition() < 1e-8) continue;
    for (std::size_t i = 0; i < n; ++i) EXPECT_NEAR(found[i], x[i], 1e-14 * 99) << "seed " << seed;
  }
}

TEST(RankRevealingQr, RefinementBeatsTheConditionOfHilbertMatrices) {
  // 360360 H is integral for n = 8; cond = 1.5e10, so plain elimination keeps about 6 digits.
  constexpr std::size_t n = 8;
  std::vector<double> a(n * n), x(n), found(n);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) a[i * n + j] = 360360.0 / static_cast<double>(i + j + 1);
    x[i] = static_cast<double>(i) - 3.0;
  }
  RankRevealingQr qr;
  qr.factor(a, n, n, 1e-15);
  ASSERT_EQ(qr.rank(), n);
  qr.solve(product(a, x, n), found);
  for (std::size_t i = 0; i < n; ++i) EXPECT_NEAR(found[i], x[i], 1e-14);
}

TEST(RankRevealingQr, FindsTheRankWhateverTheUnits) {
  // H H^T of 8 rows on one planar body has rank 3; the columns carry units of 1e-6 to 1e6.
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    Random random(seed);
    constexpr std::size_t n = 8;
    std::vector<double> h(3 * n), a(n * n), scale(n);
    for (double& value : h) value = random.uniform(-1.0, 1.0);
    for (double& value : scale) value = random.log_uniform(1e-6, 1e6);
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) {
        for (std::size_t k = 0; k < 3; ++k) a[i * n + j] += h[3 * i + k] * h[3 * j + k];
        a[i * n + j] *= scale[j];
      }
    }
    RankRevealingQr qr;
    qr.factor(a, n, n, 1e-11);
    EXPECT_EQ(qr.rank(), 3u) << "seed " << seed;
    // Consistent right-hand side: solved although singular.
    std::vector<double> y(n), x(n);
    for (std::size_t j = 0; j < n; ++j) y[j] = random.uniform(-1.0, 1.0) / scale[j];
    const auto b = product(a, y, n);
    qr.solve(b, x);
    const auto reached = product(a, x, n);
    for (std::size_t i = 0; i < n; ++i) EXPECT_NEAR(reached[i], b[i], 1e-13);
    std::vector<double> null(n);
    for (std::size_t k = 0; k < n - 3; ++k) {
      qr.null_vector(k, null);
      double size = 0.0;
      for (std::size_t j = 0; j < n; ++j) size = std::max(size, std::abs(null[j] * scale[j]));
      const auto zero = product(a, null, n);
      for (std::size_t i = 0; i < n; ++i) EXPECT_NEAR(zero[i], 0.0, 1e-13 * size);
    }
  }
}

TEST(RankRevealingQr, FindsTheRankOfLargeProducts) {
  // Lengths of columns are brought down from row to row over all pivots: rounding of that must not hide where
  // the rank ends, nor make one up. Integers: the product of n x r and r x n is exact, and has rank r.
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    Random random(seed);
    const auto n = static_cast<std::size_t>(random.integer(30, 90));
    const auto r = static_cast<std::size_t>(random.integer(1, static_cast<int>(n)));
    std::vector<double> left(n * r), right(r * n), a(n * n), y(n), x(n);
    for (double& value : left) value = random.integer(-9, 9);
    for (double& value : right) value = random.integer(-9, 9);
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) {
        for (std::size_t k = 0; k < r; ++k) a[i * n + j] += left[i * r + k] * right[k * n + j];
      }
    }
    RankRevealingQr qr;
    qr.factor(a, n, n, 1e-12);
    EXPECT_EQ(qr.rank(), r) << "seed " << seed << ", n = " << n;
    for (double& value : y) value = random.integer(-99, 99);
    const auto b = product(a, y, n);
    qr.solve(b, x);
    double size = 0.0;
    for (const double value : b) size = std::max(size, std::abs(value));
    const auto reached = product(a, x, n);
    // Some n roundings of the largest term of the product.
    for (std::size_t i = 0; i < n; ++i) EXPECT_NEAR(reached[i], b[i], 1e-12 * size) << "seed " << seed;
  }
}

TEST(RankRevealingQr, PivotsAreThoseOfMeasuredLengths) {
  // Columns of very different lengths of what is left (a graded triangle): each pivot is the longest column.
  constexpr std::size_t n = 40;
  Random random(1);
  std::vector<double> a(n * n, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i; j < n; ++j)
      a[i * n + j] = std::exp2(-static_cast<double>(i)) * random.uniform(0.5, 1.0);
  }
  RankRevealingQr qr;
  qr.factor(a, n, n, 1e-14);
  EXPECT_EQ(qr.rank(), n);
  // Pivots fall by about a half each: the last one over the first is 2^-39 to a factor of n.
  EXPECT_LT(qr.reciprocal_condition(), std::exp2(-39) * n);
  EXPECT_GT(qr.reciprocal_condition(), std::exp2(-39) / n);
}

TEST(RankRevealingQr, FactorsAloneSolveToTheirCondition) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Random random(seed);
    constexpr std::size_t n = 50;
    std::vector<double> a(n * n), x(n), found(n), refined(n);
    for (double& value : a) value = random.uniform(-1.0, 1.0);
    for (double& value : x) value = random.uniform(-1.0, 1.0);
    RankRevealingQr qr;
    qr.factor(a, n, n, 1e-14);
    const auto b = product(a, x, n);
    qr.solve_by_factors(b, found);
    qr.solve(b, refined);
    const double good = 1e-14 / qr.reciprocal_condition();
    for (std::size_t i = 0; i < n; ++i) EXPECT_NEAR(found[i], refined[i], good) << "seed " << seed;
  }
}

TEST(RankRevealingQr, LeastSquares) {
  // Line through (0, 1), (1, 3), (2, 4), (3, 4): normal equations give 1.5 + x.
  const std::vector<double> a{1, 0, 1, 1, 1, 2, 1, 3}, b{1, 3, 4, 4};
  std::vector<double> x(2);
  RankRevealingQr qr;
  qr.factor(a, 4, 2, 1e-12);
  qr.solve(b, x);
  EXPECT_NEAR(x[0], 1.5, 1e-15);
  EXPECT_NEAR(x[1], 1.0, 1e-15);
}

TEST(RankRevealingQr, ZeroMatrix) {
  RankRevealingQr qr;
  qr.factor(std::vector{0.0, 0.0, 0.0, 0.0}, 2, 2, 1e-12);
  EXPECT_EQ(qr.rank(), 0u);
  EXPECT_EQ(qr.reciprocal_condition(), 0.0);
  std::vector<double> x{1.0, 1.0};
  qr.solve(std::vector{1.0, 1.0}, x);
  EXPECT_EQ(x, (std::vector{0.0, 0.0}));
}

}  // namespace
}  // namespace carom
