// The least x within half-spaces, against all sets of lines that may hold it.

#include "tests/random.h"

#include <carom/core/numerics/least_distance.h>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace {

using carom_test::Random;

constexpr int size = 3;
using Vector = Eigen::Matrix<double, size, 1>;

struct Lines {
  std::vector<double> at, slopes;
  [[nodiscard]] Vector slope(std::size_t i) const {
    return Eigen::Map<const Vector>(slopes.data() + static_cast<std::ptrdiff_t>(i) * size);
  }
  [[nodiscard]] double value(std::size_t i, const Vector& x) const { return at[i] + slope(i).dot(x); }
};

/// The least x by trying every set of lines; infinite where no point satisfies all.
Vector by_enumeration(const Lines& lines) {
  const std::size_t count = lines.at.size();
  Vector best = Vector::Constant(std::numeric_limits<double>::infinity());
  for (unsigned set = 0; set < (1U << count); ++set) {
    std::vector<std::size_t> held;
    for (std::size_t i = 0; i < count; ++i) {
      if ((set >> i & 1U) != 0U) held.push_back(i);
    }
    if (held.size() > size) continue;
    Eigen::MatrixXd rows(static_cast<Eigen::Index>(held.size()), size);
    Eigen::VectorXd right(static_cast<Eigen::Index>(held.size()));
    for (std::size_t k = 0; k < held.size(); ++k) {
      rows.row(static_cast<Eigen::Index>(k)) = lines.slope(held[k]).transpose();
      right[static_cast<Eigen::Index>(k)] = -lines.at[held[k]];
    }
    const Vector x =
        held.empty() ? Vector(Vector::Zero()) : Vector(rows.completeOrthogonalDecomposition().solve(right));
    bool all = true;
    for (std::size_t i = 0; i < count; ++i) all = all && lines.value(i, x) >= -1e-10;
    if (all && x.norm() < best.norm()) best = x;
  }
  return best;
}

TEST(LeastDistance, IsThatOfAllSetsOfLines) {
  Random random(3);
  carom::LeastDistance solver;
  int held = 0, without = 0;
  for (int repeat = 0; repeat < 500; ++repeat) {
    Lines lines;
    const unsigned count = 1 + random.below(7);
    for (unsigned i = 0; i < count; ++i) {
      lines.at.push_back(random.uniform(-1.0, 0.5));
      Vector slope(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0));
      // Some lines are parallel, or follow from others.
      if (i > 0 && random.below(3) == 0) slope = random.uniform(-2.0, 2.0) * lines.slope(i - 1);
      lines.slopes.insert(lines.slopes.end(), slope.begin(), slope.end());
    }
    const Vector wanted = by_enumeration(lines);
    Vector x;
    const bool found = solver.solve(lines.at, lines.slopes, 1e-13, {x.data(), size});
    ASSERT_EQ(found, std::isfinite(wanted.norm())) << repeat;
    if (!found) {
      ++without;
      continue;
    }
    EXPECT_LT((x - wanted).norm(), 1e-9 * (1.0 + wanted.norm())) << repeat;
    if (wanted.norm() > 0.0) ++held;
  }
  EXPECT_GT(held, 200);
  EXPECT_GT(without, 20);
}

TEST(LeastDistance, NothingViolatedIsZero) {
  carom::LeastDistance solver;
  const std::vector<double> at{0.0, 1.0}, slopes{1.0, 0.0, 0.0, 1.0};
  std::vector<double> x{3.0, 4.0};
  EXPECT_TRUE(solver.solve(at, slopes, 0.0, x));
  EXPECT_EQ(x, (std::vector<double>{0.0, 0.0}));
}

}  // namespace
