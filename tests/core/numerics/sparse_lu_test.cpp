// L U of sparse matrices that are not symmetric, beside dense ones.

#include <carom/core/numerics/sparse_lu.h>

#include "tests/allocation_counter.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <utility>
#include <vector>

namespace {

using carom::Index;
using carom::SparseLu;

/// Numbers of a matrix by places, and who is late.
struct Model {
  std::vector<std::pair<Index, Index>> entries;
  std::vector<double> numbers;
  std::vector<char> late;

  void add(Index row, Index column, double number) {
    entries.emplace_back(row, column);
    numbers.push_back(number);
  }
  [[nodiscard]] Eigen::MatrixXd dense() const {
    const auto n = static_cast<Eigen::Index>(late.size());
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n, n);
    for (std::size_t i = 0; i < entries.size(); ++i)
      matrix(entries[i].first, entries[i].second) += numbers[i];
    return matrix;
  }
};

/// A chain of pairs of numbers with some ties across, and constraints between neighbours without a diagonal.
Model chain(Index links, Index constraints, std::mt19937& random) {
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  Model model;
  model.late.assign(2 * links, 0);
  for (Index i = 0; i < 2 * links; ++i) {
    model.add(i, i, 6.0 + number(random));
    for (Index j = i + 1; j < std::min(2 * links, i + 4); ++j) {
      model.add(i, j, number(random));
      if (j % 3 != 0) model.add(j, i, number(random));
    }
    model.add(i, i, number(random));  // twice at a place
  }
  for (Index c = 0; c < constraints; ++c) {
    const auto row = static_cast<Index>(model.late.size());
    model.late.push_back(1);
    const Index at = (c * 7) % (2 * links - 3);
    for (Index k = 0; k < 4; ++k) {
      const double along = number(random);
      model.add(row, at + k, along);
      model.add(at + k, row, -along + 0.1 * number(random));
    }
  }
  return model;
}

void fill(SparseLu& factors, const Model& model, const std::vector<Index>& places) {
  std::fill(factors.values().begin(), factors.values().end(), 0.0);
  for (std::size_t i = 0; i < places.size(); ++i) factors.values()[places[i]] += model.numbers[i];
}

TEST(SparseLu, SolvesAsADenseOneDoes) {
  std::mt19937 random(7);
  for (const auto& [links, constraints] : {std::pair<Index, Index>{2, 0}, {2, 1}, {9, 4}, {60, 20}}) {
    const Model model = chain(links, constraints, random);
    SparseLu factors;
    const std::vector<Index> places = factors.analyse(model.entries, model.late);
    ASSERT_EQ(factors.size(), model.late.size());
    fill(factors, model, places);
    ASSERT_TRUE(factors.factor());
    Eigen::VectorXd x = Eigen::VectorXd::Random(static_cast<Eigen::Index>(model.late.size()));
    const Eigen::VectorXd right = x;
    factors.solve(x.data());
    // Rounding of some hundred sums, magnified by a condition of some hundred.
    EXPECT_LE((model.dense() * x - right).cwiseAbs().maxCoeff(), 1e-11) << links;
  }
}

TEST(SparseLu, ChainsFillLittle) {
  std::mt19937 random(7);
  const auto fill_of = [&](Index links) {
    const Model model = chain(links, links / 3, random);
    SparseLu factors;
    (void)factors.analyse(model.entries, model.late);
    return static_cast<double>(factors.fill());
  };
  // Linear in the length: dense factors would grow by a hundred.
  EXPECT_LE(fill_of(1000), 12.0 * fill_of(100));
}

TEST(SparseLu, TellsWhatIsSingular) {
  SparseLu factors;
  const std::vector<std::pair<Index, Index>> entries{{0, 0}, {0, 1}, {1, 0}, {1, 1}};
  const std::vector<char> late{0, 0};
  const std::vector<Index> places = factors.analyse(entries, late);
  const auto regular = [&](double a, double b, double c, double d) {
    const std::vector<double> numbers{a, b, c, d};
    for (std::size_t i = 0; i < 4; ++i) factors.values()[places[i]] = numbers[i];
    return factors.factor();
  };
  EXPECT_TRUE(regular(2.0, 1.0, 1.0, 2.0));
  EXPECT_FALSE(regular(1.0, 2.0, 2.0, 4.0));
  EXPECT_FALSE(regular(3.0, 0.3, 0.1, 0.01));  // but for rounding
  EXPECT_FALSE(regular(std::nan(""), 1.0, 1.0, 2.0));
  EXPECT_TRUE(regular(2.0, 1.0, 1.0, 2.0)) << "nothing is left of those before";
  std::vector<double> x{3.0, 3.0};
  factors.solve(x.data());
  EXPECT_DOUBLE_EQ(x[0], 1.0);
  EXPECT_DOUBLE_EQ(x[1], 1.0);
}

TEST(SparseLu, FactorsAgainWithoutMemory) {
  std::mt19937 random(7);
  const Model model = chain(30, 10, random);
  SparseLu factors;
  const std::vector<Index> places = factors.analyse(model.entries, model.late);
  std::vector<double> x(model.late.size(), 1.0);
  const std::int64_t before = carom_test::allocations();
  for (int i = 0; i < 3; ++i) {
    fill(factors, model, places);
    EXPECT_TRUE(factors.factor());
    factors.solve(x.data());
  }
  EXPECT_EQ(carom_test::allocations() - before, 0);
}

}  // namespace
