// Contact problems that are their own image in a mirror have answers that are so too.

#include "tests/random.h"

#include <carom/contact/solvers/mirror_fold.h>
#include <carom/contact/solvers/residual.h>
#include <carom/contact/solvers/solver_chain.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

namespace {

using namespace carom;
using carom_test::Random;

/// A problem, and the image of each of its groups.
struct Mirrored {
  ContactProblem problem;
  std::vector<int> image;

  [[nodiscard]] double image_of(const std::vector<double>& values, int row) const {
    const double sign = row % 2 == 0 ? 1.0 : -1.0;
    return sign * values[static_cast<std::size_t>(2 * image[static_cast<std::size_t>(row / 2)] + row % 2)];
  }
};

/// Contacts in random order: some pairs, some that are their own image. W = A A^T with its image.
/// \param rank columns of A
Mirrored random_problem(Random& random, int pairs, int own, int rank, double friction) {
  const int count = 2 * pairs + own, rows = 2 * count;
  Mirrored out;
  std::vector<int> order(static_cast<std::size_t>(count));
  std::iota(order.begin(), order.end(), 0);
  for (std::size_t i = order.size(); i > 1; --i)
    std::swap(order[i - 1], order[random.below(static_cast<unsigned>(i))]);
  out.image = order;
  for (std::size_t i = 0; i < order.size(); ++i) out.image[static_cast<std::size_t>(order[i])] = order[i];
  for (std::size_t i = 0; i + 1 < 2 * static_cast<std::size_t>(pairs); i += 2) {
    out.image[static_cast<std::size_t>(order[i])] = order[i + 1];
    out.image[static_cast<std::size_t>(order[i + 1])] = order[i];
  }
  const auto n = static_cast<std::size_t>(rows);
  std::vector<std::vector<double>> columns;
  for (int k = 0; k < rank; ++k) {
    std::vector<double> column(n), mirrored(n);
    for (double& value : column) value = random.uniform(-1.0, 1.0);
    for (int i = 0; i < rows; ++i) mirrored[static_cast<std::size_t>(i)] = out.image_of(column, i);
    columns.push_back(column);
    columns.push_back(mirrored);
  }
  std::vector<double> b(n);
  for (double& value : b) value = random.uniform(-1.0, 0.3);
  out.problem.reset(rows);
  for (int i = 0; i < rows; ++i) {
    const auto row = static_cast<std::size_t>(i);
    out.problem.vector()[row] = 0.5 * (b[row] + out.image_of(b, i));
    if (i % 2 == 1) {
      out.problem.sets()[row] = {.kind = SetKind::bounded_interval, .bound = i - 1, .coefficient = friction};
    }
    for (int j = 0; j < rows; ++j) {
      for (const std::vector<double>& column : columns)
        out.problem.w(i, j) += column[row] * column[static_cast<std::size_t>(j)];
    }
  }
  out.problem.group();
  return out;
}

// The answer is found in one half, whatever the order of the contacts.
TEST(MirrorFold, AnswersAreTheirOwnImages) {
  Random random(1);
  int usable = 0;
  constexpr int trials = 400;
  for (int trial = 0; trial < trials; ++trial) {
    SCOPED_TRACE(trial);
    const int pairs = 1 + static_cast<int>(random.below(4)), own = static_cast<int>(random.below(3));
    const int rank = 2 + static_cast<int>(random.below(6));
    const Mirrored made = random_problem(random, pairs, own, rank, 0.3 * random.below(6));
    MirrorFold fold;
    ASSERT_TRUE(fold.find(made.problem));
    EXPECT_EQ(fold.half().rows(), 2 * pairs + own);
    SolverChain chain;
    std::vector<double> impulse(static_cast<std::size_t>(made.problem.rows()));
    const bool solved = chain.solve(made.problem, impulse).usable();
    double largest = 0.0;
    for (const double value : impulse) largest = std::max(largest, std::abs(value));
    constexpr double jammed = 100.0;  // impulses to which nothing answers any more, for b and W near 1
    if (!solved || largest > jammed) continue;
    ++usable;
    for (int i = 0; i < made.problem.rows(); ++i)
      EXPECT_NEAR(impulse[static_cast<std::size_t>(i)], made.image_of(impulse, i), 1e-9 * largest);
  }
  EXPECT_GT(usable, trials * 3 / 4);
}

// A particle on a symmetric ridge with much friction: it may stick to either side alone, or slip down both,
// and what is symmetric is the last.
TEST(MirrorFold, OfSeveralAnswersTheSymmetricOneIsTaken) {
  ContactProblem problem;
  problem.reset(4);
  const double c = 0.8, s = 0.6;
  const std::vector<std::vector<double>> rows{{s, c}, {c, -s}, {-s, c}, {c, s}};
  for (int i = 0; i < 4; ++i) {
    const auto& row = rows[static_cast<std::size_t>(i)];
    problem.vector()[static_cast<std::size_t>(i)] = -row[1];
    for (int j = 0; j < 4; ++j) {
      const auto& other = rows[static_cast<std::size_t>(j)];
      problem.w(i, j) = row[0] * other[0] + row[1] * other[1];
    }
  }
  for (const int i : {1, 3})
    problem.sets()[static_cast<std::size_t>(i)] = {
        .kind = SetKind::bounded_interval, .bound = i - 1, .coefficient = 0.9};
  problem.group();
  SolverChain chain;
  std::vector<double> impulse(4);
  ASSERT_TRUE(chain.solve(problem, impulse).usable());
  EXPECT_NEAR(impulse[0], impulse[2], 1e-14);
  EXPECT_NEAR(impulse[1], -impulse[3], 1e-14);
  EXPECT_GT(impulse[0], 0.1);
}

// What is no image of itself is left alone.
TEST(MirrorFold, OtherProblemsHaveNoMirror) {
  Random random(2);
  for (int trial = 0; trial < 100; ++trial) {
    Mirrored made = random_problem(random, 2, 1, 4, 0.5);
    const unsigned changed = random.below(3);
    const auto row = static_cast<int>(random.below(8));
    if (changed == 0) made.problem.vector()[static_cast<std::size_t>(row)] += 0.01;
    if (changed == 1) made.problem.w(row, row) *= 1.01;
    if (changed == 2) made.problem.sets()[static_cast<std::size_t>(row | 1)].coefficient = 0.51;
    const bool of_own = made.image[static_cast<std::size_t>(row / 2)] == row / 2;
    // Of a contact that is its own image the mirror says no more than that nothing rubs there.
    if (of_own && !(changed == 0 && row % 2 == 1)) continue;
    EXPECT_FALSE(MirrorFold().find(made.problem)) << trial;
  }
}

TEST(MirrorFold, LeavesBoundsThatAreNumbersAlone) {
  Random random(3);
  Mirrored made = random_problem(random, 1, 1, 4, 0.5);
  ASSERT_TRUE(MirrorFold().find(made.problem));
  const auto own = static_cast<std::size_t>(
      std::ranges::find_if(made.image, [&, i = 0](int image) mutable { return image == i++; }) -
      made.image.begin());
  made.problem.sets()[2 * own] = {.kind = SetKind::interval, .lower = 0.0, .upper = 1.0};
  EXPECT_FALSE(MirrorFold().find(made.problem));
}

}  // namespace
