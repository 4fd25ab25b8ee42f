// Elimination with full pivoting: solutions against a residual, the rank and the null vectors of matrices
// whose rows depend on each other, and numbers that are none.

#include <carom/core/numerics/full_pivoting.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <random>
#include <vector>

namespace {

using carom::FullPivoting;

constexpr double dependent_pivot = 1e-11;

std::vector<double> random_numbers(std::mt19937& engine, std::size_t count) {
  std::uniform_real_distribution<double> draw(-1.0, 1.0);
  std::vector<double> numbers(count);
  std::generate(numbers.begin(), numbers.end(), [&] { return draw(engine); });
  return numbers;
}

/// n x n, of a rank: products of n x rank and rank x n numbers.
std::vector<double> random_matrix(std::mt19937& engine, std::size_t n, std::size_t rank) {
  const std::vector<double> a = random_numbers(engine, n * rank), b = random_numbers(engine, rank * n);
  std::vector<double> matrix(n * n, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < rank; ++k) {
      for (std::size_t j = 0; j < n; ++j) matrix[i * n + j] += a[i * rank + k] * b[k * n + j];
    }
  }
  return matrix;
}

std::vector<double> times(const std::vector<double>& matrix, const std::vector<double>& x) {
  const std::size_t n = x.size();
  std::vector<double> result(n, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) result[i] += matrix[i * n + j] * x[j];
  }
  return result;
}

double size_of(const std::vector<double>& x) {
  double largest = 0.0;
  for (const double number : x) largest = std::max(largest, std::abs(number));
  return largest;
}

void expect_near(const std::vector<double>& a, const std::vector<double>& b, double tolerance) {
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], tolerance) << i;
}

// Sizes on both sides of that from which rows are searched wide.
TEST(FullPivoting, SolvesWhatHasASolution) {
  std::mt19937 engine(3);
  FullPivoting factors;
  for (const std::size_t n : {1U, 2U, 3U, 4U, 8U, 9U, 17U, 40U}) {
    for (std::size_t rank = (n + 1) / 2; rank <= n; ++rank) {
      SCOPED_TRACE(testing::Message() << n << " rows of rank " << rank);
      const std::vector<double> matrix = random_matrix(engine, n, rank);
      const std::vector<double> given = times(matrix, random_numbers(engine, n));
      factors.reset(n);
      std::copy(matrix.begin(), matrix.end(), factors.matrix());
      std::vector<double> x = given;
      ASSERT_TRUE(factors.solve(dependent_pivot, x));
      ASSERT_EQ(factors.rank(), rank);
      // Rounding of n terms for each of n rows, of numbers of the size of the answer.
      const double rounding = 1e-15 * static_cast<double>(n * n);
      expect_near(times(matrix, x), given, rounding * std::max(1.0, size_of(x)));
      std::vector<double> null;
      for (std::size_t free = rank; free < n; ++free) {
        EXPECT_EQ(x[factors.column(free)], 0.0);
        factors.null_vector(free, null);
        EXPECT_EQ(null[factors.column(free)], 1.0);
        expect_near(times(matrix, null), std::vector<double>(n, 0.0),
                    rounding * std::max(1.0, size_of(null)));
      }
    }
  }
}

TEST(FullPivoting, SolvesAnotherRightSideWithTheSameBits) {
  std::mt19937 engine(5);
  FullPivoting factors, once;
  for (const std::size_t n : {1U, 2U, 5U, 17U, 40U}) {
    for (std::size_t rank = (n + 1) / 2; rank <= n; ++rank) {
      const std::vector<double> matrix = random_matrix(engine, n, rank);
      std::vector<double> first = times(matrix, random_numbers(engine, n));
      factors.reset(n);
      std::copy(matrix.begin(), matrix.end(), factors.matrix());
      ASSERT_TRUE(factors.solve(dependent_pivot, first));
      for (int repeat = 0; repeat < 2; ++repeat) {
        std::vector<double> again = times(matrix, random_numbers(engine, n)), whole = again;
        once.reset(n);
        std::copy(matrix.begin(), matrix.end(), once.matrix());
        ASSERT_TRUE(once.solve(dependent_pivot, whole));
        ASSERT_TRUE(factors.solve_again(again));
        EXPECT_EQ(again, whole) << n << " rows of rank " << rank;
      }
    }
  }
}

TEST(FullPivoting, SaysThatANumberIsNone) {
  std::mt19937 engine(4);
  FullPivoting factors;
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    for (const std::size_t n : {1U, 2U, 5U, 20U}) {
      for (const std::size_t at : {std::size_t{0}, n * n / 2, n * n - 1}) {
        std::vector<double> matrix = random_matrix(engine, n, n);
        matrix[at] = bad;
        factors.reset(n);
        std::copy(matrix.begin(), matrix.end(), factors.matrix());
        std::vector<double> right(n, 1.0);
        const bool solved = factors.solve(dependent_pivot, right);
        EXPECT_TRUE(!solved || (n == 1 && right[0] == 0.0)) << bad << " at " << at << " of " << n;  // 1 / inf
      }
      std::vector<double> right(n, bad);
      const std::vector<double> matrix = random_matrix(engine, n, n);
      factors.reset(n);
      std::copy(matrix.begin(), matrix.end(), factors.matrix());
      EXPECT_FALSE(factors.solve(dependent_pivot, right));
    }
  }
}

}  // namespace
