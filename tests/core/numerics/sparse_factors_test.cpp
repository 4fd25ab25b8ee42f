#include <carom/core/numerics/sparse_factors.h>

#include "tests/random.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/QR>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace {

using namespace carom;
using carom_test::Random;
using Entries = std::vector<std::pair<Index, Index>>;

/// Places of the lower triangle that are not zero, the diagonal among them, in random order.
Entries entries_of(const Eigen::MatrixXd& matrix, Random& random) {
  Entries entries;
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    for (Eigen::Index j = 0; j <= i; ++j) {
      if (i == j || matrix(i, j) != 0.0) entries.emplace_back(static_cast<Index>(i), static_cast<Index>(j));
    }
  }
  for (std::size_t i = entries.size(); i > 1; --i) {
    std::swap(entries[i - 1], entries[random.below(static_cast<unsigned>(i))]);
  }
  return entries;
}

using Places = std::vector<SparseFactors::Place>;

/// Analyses blocks of one row each.
Places analyse(SparseFactors& factors, Index size, const Entries& entries) {
  return factors.analyse(std::vector<Index>(size, 1), entries);
}

void set_values(SparseFactors& factors, const Places& places, const Entries& entries,
                const Eigen::MatrixXd& matrix) {
  for (std::size_t i = 0; i < entries.size(); ++i) {
    factors.values()[places[i].first] = matrix(entries[i].first, entries[i].second);
  }
}

Eigen::VectorXd solved(SparseFactors& factors, Eigen::VectorXd right) {
  factors.solve(right.data());
  return right;
}

/// G of rows that join few columns.
Eigen::MatrixXd random_rows(Eigen::Index rows, Eigen::Index columns, Random& random) {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(rows, columns);
  for (Eigen::Index i = 0; i < rows; ++i) {
    for (int k = 0; k < 3; ++k) {
      matrix(i, random.below(static_cast<unsigned>(columns))) += random.uniform(-1.0, 1.0);
    }
  }
  return matrix;
}

Eigen::VectorXd random_vector(Eigen::Index size, Random& random) {
  Eigen::VectorXd result(size);
  for (double& x : result) x = random.uniform(-1.0, 1.0);
  return result;
}

TEST(SparseFactors, OfNothingDoNothing) {
  SparseFactors factors;
  factors.factor();
  factors.solve(nullptr);
  analyse(factors, 0, {});
  factors.factor();
  factors.solve(nullptr);
  EXPECT_EQ(factors.size(), 0u);
  EXPECT_EQ(factors.fill(), 0u);
}

TEST(SparseFactors, OfOneRowDivide) {
  SparseFactors factors;
  const Entries entries{{0, 0}};
  const Places places = analyse(factors, 1, entries);
  for (const double value : {4.0, 1e-200, 1e200}) {
    factors.values()[places[0].first] = value;
    factors.factor();
    double x = 2.0;
    factors.solve(&x);
    EXPECT_NEAR(x, 2.0 / value, 1e-15 * x);
  }
}

TEST(SparseFactors, MeetADenseSolution) {
  Random random(401);
  for (int repeat = 0; repeat < 200; ++repeat) {
    const Eigen::Index size = 1 + random.below(30);
    const Eigen::MatrixXd rows = random_rows(size, size + 10, random);
    // The diagonal keeps the condition below about 100.
    const Eigen::MatrixXd matrix = rows * rows.transpose() + 0.1 * Eigen::MatrixXd::Identity(size, size);
    const Entries entries = entries_of(matrix, random);
    SparseFactors factors;
    const Places places = analyse(factors, static_cast<Index>(size), entries);
    EXPECT_EQ(factors.size(), static_cast<Index>(size));
    set_values(factors, places, entries, matrix);
    factors.factor();
    const Eigen::VectorXd right = random_vector(size, random);
    const Eigen::VectorXd expected = matrix.ldlt().solve(right), found = solved(factors, right);
    EXPECT_LE((found - expected).cwiseAbs().maxCoeff(), 1e-13 * (1.0 + expected.cwiseAbs().maxCoeff()));
    // Again, and with other numbers in the same places.
    EXPECT_EQ(solved(factors, right), found);
    const Eigen::MatrixXd other = 3.0 * matrix + Eigen::MatrixXd(matrix.diagonal().asDiagonal());
    set_values(factors, places, entries, other);
    factors.factor();
    EXPECT_LE((other * solved(factors, right) - right).cwiseAbs().maxCoeff(), 1e-13);
    set_values(factors, places, entries, matrix);
    factors.factor();
    EXPECT_EQ(solved(factors, right), found);
  }
}

TEST(SparseFactors, TheOrderOfEntriesDoesNotMatter) {
  Random random(402);
  const Eigen::MatrixXd rows = random_rows(20, 30, random);
  const Eigen::MatrixXd matrix = rows * rows.transpose() + 0.1 * Eigen::MatrixXd::Identity(20, 20);
  const Eigen::VectorXd right = random_vector(20, random);
  Eigen::VectorXd first;
  for (int repeat = 0; repeat < 5; ++repeat) {
    const Entries entries = entries_of(matrix, random);
    SparseFactors factors;
    const Places places = analyse(factors, 20, entries);
    set_values(factors, places, entries, matrix);
    factors.factor();
    const Eigen::VectorXd found = solved(factors, right);
    if (repeat == 0) first = found;
    EXPECT_EQ(found, first);
  }
}

/// The matrix by blocks of these sizes.
struct Blocks {
  std::vector<Index> sizes, first{0};
  Entries entries;
  Places places;

  Blocks(SparseFactors& factors, const std::vector<Index>& of, const Eigen::MatrixXd& matrix) : sizes(of) {
    for (const Index size : sizes) first.push_back(first.back() + size);
    for (Index a = 0; a < sizes.size(); ++a) {
      for (Index b = 0; b <= a; ++b) {
        if (a == b || !matrix.block(first[a], first[b], sizes[a], sizes[b]).isZero(0.0)) {
          entries.emplace_back(a, b);
        }
      }
    }
    places = factors.analyse(sizes, entries);
    for (std::size_t i = 0; i < entries.size(); ++i) {
      const auto [a, b] = entries[i];
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> block =
          matrix.block(first[a], first[b], sizes[a], sizes[b]);
      if (places[i].transposed) block = block.transpose().eval();
      std::copy_n(block.data(), block.size(), factors.values().data() + places[i].first);
    }
    factors.factor();
  }
};

TEST(SparseFactors, OfBlocksMeetADenseSolution) {
  Random random(406);
  for (int repeat = 0; repeat < 200; ++repeat) {
    // All of one size, or of several.
    const Index usual = random.below(5);
    std::vector<Index> sizes(1 + random.below(12));
    Index size = 0;
    for (Index& of : sizes) size += of = usual == 0 ? 1 + random.below(SparseFactors::most_rows) : usual;
    const Eigen::MatrixXd rows = random_rows(size, size + 10, random);
    const Eigen::MatrixXd matrix = rows * rows.transpose() + 0.1 * Eigen::MatrixXd::Identity(size, size);
    SparseFactors factors;
    const Blocks blocks(factors, sizes, matrix);
    EXPECT_EQ(factors.size(), size);
    const Eigen::VectorXd right = random_vector(size, random);
    const Eigen::VectorXd expected = matrix.ldlt().solve(right), found = solved(factors, right);
    EXPECT_LE((found - expected).cwiseAbs().maxCoeff(), 1e-13 * (1.0 + expected.cwiseAbs().maxCoeff()));
    EXPECT_EQ(solved(factors, right), found);
    // A copy has numbers of its own.
    SparseFactors copy = factors;
    const Blocks others(factors, sizes, Eigen::MatrixXd(2.0 * matrix));
    EXPECT_EQ(solved(copy, right), found);
    EXPECT_LE((solved(factors, right) - 0.5 * found).norm(), 1e-13 * (1.0 + found.norm()));
  }
}

TEST(SparseFactors, OfPairsInChainsAndTreesMeetADenseSolution) {
  Random random(407);
  for (int repeat = 0; repeat < 200; ++repeat) {
    const Index count = 1 + random.below(20), size = 2 * count;
    // Heavy diagonals: positive definite.
    Eigen::MatrixXd matrix = 8.0 * Eigen::MatrixXd::Identity(size, size);
    std::vector<int> branches(count, 0);
    for (Index block = 1; block < count; ++block) {
      Index other = repeat % 2 == 0 ? block - 1 : random.below(block);
      while (branches[other] == 2) other = random.below(block);
      ++branches[other];
      for (Index i = 0; i < 4; ++i) {
        const Index row = 2 * block + i / 2, column = 2 * other + i % 2;
        matrix(row, column) = matrix(column, row) = random.uniform(-1.0, 1.0);
      }
    }
    for (Index row = 0; row < size; row += 2) {
      matrix(row, row + 1) = matrix(row + 1, row) = random.uniform(-1.0, 1.0);
    }
    SparseFactors factors;
    const Blocks blocks(factors, std::vector<Index>(count, 2), matrix);
    if (repeat % 2 == 0) {
      EXPECT_EQ(factors.fill(), 4U * (count - 1) + count);  // one block below each
    }
    const Eigen::VectorXd right = random_vector(size, random);
    const Eigen::VectorXd expected = matrix.ldlt().solve(right), found = solved(factors, right);
    EXPECT_LE((found - expected).cwiseAbs().maxCoeff(), 1e-14);  // numbers of order 0.1
    EXPECT_EQ(solved(factors, right), found);
  }
}

TEST(SparseFactors, OfBlocksNameWhatDepends) {
  // One row is the sum of two others, in any blocks: the combination of them vanishes.
  Random random(407);
  for (int repeat = 0; repeat < 100; ++repeat) {
    const Index each = 2 + random.below(2), size = 4 * each;
    Eigen::MatrixXd rows = random_rows(size, size + 10, random);
    rows.row(random.below(size)) = rows.row(0) + rows.row(size - 1);
    const Eigen::MatrixXd matrix = rows * rows.transpose();
    SparseFactors factors;
    const Blocks blocks(factors, std::vector<Index>(4, each), matrix);
    for (Index row = 0; row < size; ++row) {
      if (factors.pivot(row) >= dependent_pivot) continue;
      std::vector<double> vector;
      factors.dependence(row, vector);
      EXPECT_EQ(vector[row], 1.0);
      // Rounding by the condition of the rows that remain.
      EXPECT_LE((matrix * Eigen::Map<const Eigen::VectorXd>(vector.data(), size)).norm(), 1e-7);
    }
  }
}

TEST(SparseFactors, RowsThatDependOnEachOtherAreSolvedWhereThereIsASolution) {
  Random random(403);
  for (int repeat = 0; repeat < 200; ++repeat) {
    const Eigen::Index size = 2 + random.below(20);
    Eigen::MatrixXd rows = random_rows(size, size + 10, random);
    const Eigen::Index doubled = 1 + random.below(3);
    // Some rows are sums of others, one is a row once more.
    for (Eigen::Index k = 0; k < std::min(doubled, size - 1); ++k) {
      rows.row(size - 1 - k) = k == 0 ? Eigen::RowVectorXd(rows.row(0))
                                      : Eigen::RowVectorXd(rows.row(0) - 2.0 * rows.row((size - 1 - k) / 2));
    }
    const Eigen::MatrixXd matrix = rows * rows.transpose();
    const Entries entries = entries_of(matrix, random);
    SparseFactors factors;
    const Places places = analyse(factors, static_cast<Index>(size), entries);
    set_values(factors, places, entries, matrix);
    factors.factor();
    std::size_t left_out = 0;
    std::vector<double> vanishes;
    for (std::size_t row = 0; row < static_cast<std::size_t>(size); ++row) {
      if (factors.pivot(row) > dependent_pivot) continue;
      ++left_out;
      factors.dependence(row, vanishes);
      const Eigen::Map<const Eigen::VectorXd> combination(vanishes.data(), size);
      EXPECT_EQ(vanishes[row], 1.0);
      EXPECT_LE((combination.transpose() * rows).cwiseAbs().maxCoeff(),
                1e-12 * (1.0 + combination.cwiseAbs().maxCoeff()) * rows.cwiseAbs().maxCoeff());
    }
    // All of them at once: the sum of their combinations, by shares.
    std::vector<double> shares(static_cast<std::size_t>(size), 0.0), sum(shares), mixed;
    for (std::size_t row = 0; row < shares.size(); ++row) {
      if (factors.pivot(row) > dependent_pivot) continue;
      shares[row] = random.uniform(1.0, 2.0);
      factors.dependence(row, vanishes);
      for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += shares[row] * vanishes[i];
    }
    factors.dependence(shares, mixed);
    for (std::size_t i = 0; i < sum.size(); ++i)
      EXPECT_NEAR(mixed[i], sum[i], 1e-8 * (1.0 + std::abs(sum[i])));
    // A later row may have been built on one that was replaced.
    EXPECT_EQ(left_out, static_cast<std::size_t>(size - rows.colPivHouseholderQr().rank()));
    const Eigen::VectorXd right = rows * random_vector(rows.cols(), random);
    const Eigen::VectorXd found = solved(factors, right);
    EXPECT_LE((matrix * found - right).cwiseAbs().maxCoeff(), 1e-13 * (1.0 + found.cwiseAbs().maxCoeff()))
        << size;
    // The solution is not large: as large as the best one needs.
    const Eigen::VectorXd least = matrix.completeOrthogonalDecomposition().solve(right);
    EXPECT_LE(found.cwiseAbs().maxCoeff(), 100.0 * (1.0 + least.cwiseAbs().maxCoeff()));
  }
}

// Cranks on one coupler at an angle a from their line, that turn at x_k, the coupler moving by y, turning by
// phi at places c_k: rows a (x_k - x_0) and x_k - y - c_k phi. All but one of the former follow from the
// others; eliminated first, they leave rounding/a^2 where nothing should be left.
TEST(SparseFactors, WeakRowsDoNotPassForIndependent) {
  Random random(17);
  for (int trial = 0; trial < 40; ++trial) {
    const Eigen::Index cranks = 3 + random.below(6);
    const double a = std::pow(10.0, random.uniform(-4.0, -1.0));
    Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(2 * cranks - 1, cranks + 2);
    for (Eigen::Index k = 0; k < cranks; ++k) {
      rows(cranks - 1 + k, k) = 1.0;
      rows(cranks - 1 + k, cranks) = -1.0;
      rows(cranks - 1 + k, cranks + 1) = k == 0 ? 0.0 : -random.uniform(0.5, 3.0);
      if (k == 0) continue;
      rows(k - 1, k) = a;
      rows(k - 1, 0) = -a;
    }
    // Twins, so that no order of elimination is a good one.
    const Eigen::Index count = rows.rows();
    rows.conservativeResize(2 * count, Eigen::NoChange);
    rows.bottomRows(count) = rows.topRows(count);
    const Eigen::MatrixXd matrix = rows * rows.transpose();
    const Entries entries = entries_of(matrix, random);
    SparseFactors factors;
    factors.reveal_rank(true);
    const Places places = analyse(factors, static_cast<Index>(matrix.rows()), entries);
    set_values(factors, places, entries, matrix);
    factors.factor();
    Eigen::Index independent = 0;
    for (std::size_t row = 0; row < factors.size(); ++row) {
      independent += factors.pivot(row) > dependent_pivot ? 1 : 0;
    }
    EXPECT_EQ(independent, cranks + 1) << trial << ", a = " << a;
    // Change that the rows ask of velocities which they allow but for a little.
    const Eigen::VectorXd change = random_vector(rows.cols(), random);
    const Eigen::VectorXd left = rows * (change - rows.transpose() * solved(factors, rows * change));
    EXPECT_LE(left.cwiseAbs().maxCoeff(), 1e-13 / a) << trial << ", a = " << a;
  }
}

TEST(SparseFactors, OfTwinsOneCarriesTheLoad) {
  SparseFactors factors;
  const Entries entries{{0, 0}, {1, 0}, {1, 1}};
  analyse(factors, 2, entries);
  for (const double value : {1.0, 0.3, 7e5}) {
    std::fill(factors.values().begin(), factors.values().end(), value);
    factors.factor();
    const Eigen::VectorXd found = solved(factors, Eigen::Vector2d(6.0 * value, 6.0 * value));
    EXPECT_NEAR(found.maxCoeff(), 6.0, 1e-14);
    EXPECT_EQ(found.minCoeff(), 0.0);
  }
}

TEST(SparseFactors, ARowOfZerosIsHarmless) {
  SparseFactors factors;
  const Entries entries{{0, 0}, {1, 1}};
  const Places places = analyse(factors, 2, entries);
  factors.values()[places[0].first] = 2.0;
  factors.values()[places[1].first] = 0.0;
  factors.factor();
  const Eigen::VectorXd found = solved(factors, Eigen::Vector2d(1.0, 0.0));
  EXPECT_NEAR(found[0], 0.5, 1e-15);
  EXPECT_EQ(found[1], 0.0);
}

TEST(SparseFactors, ALongChainStaysSparseAndExact) {
  // Tridiagonal, 2 and -1, fixed at one end only: the inverse is min(i, j) + 1 from the fixed end.
  constexpr Index size = 1000;
  Entries entries;
  std::vector<double> values;
  for (Index i = 0; i < size; ++i) {
    entries.emplace_back(i, i);
    values.push_back(i + 1 < size ? 2.0 : 1.0);
    if (i > 0) {
      entries.emplace_back(i, i - 1);
      values.push_back(-1.0);
    }
  }
  SparseFactors factors;
  const Places places = analyse(factors, size, entries);
  for (std::size_t i = 0; i < entries.size(); ++i) factors.values()[places[i].first] = values[i];
  factors.factor();
  EXPECT_EQ(factors.fill(), size - 1u);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(size);
  right[size - 1] = 1.0;
  const Eigen::VectorXd found = solved(factors, right);
  // Rounding of 1e-16 by a condition of 4e6.
  for (Index i = 0; i < size; ++i) EXPECT_NEAR(found[i], i + 1.0, 1e-10 * (i + 1.0));
}

TEST(SparseFactors, ATreeHasLittleFill) {
  // Every row joined to the one half its number. In that order the factor is nearly full.
  constexpr Index size = 255;
  Entries entries{{0, 0}};
  for (Index i = 1; i < size; ++i) {
    entries.emplace_back(i, i);
    entries.emplace_back(i, (i - 1) / 2);
  }
  SparseFactors factors;
  analyse(factors, size, entries);
  EXPECT_LE(factors.fill(), 3 * size / 2);
}

}  // namespace
