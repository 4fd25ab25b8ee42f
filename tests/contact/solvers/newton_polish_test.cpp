// Answers of problems that are a little different: the equations of one solve the next, as long as modes
// stay.

#include <carom/contact/solvers/newton_polish.h>
#include <carom/contact/solvers/solver_chain.h>

#include "tests/contact/random_problems.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace carom {
namespace {

using contact_test::Random;
using contact_test::random_problem;

/// A problem with an answer to rounding, and the equations of its modes.
struct Solved {
  ContactProblem problem;
  std::vector<double> impulse;
  ModeEquations equations;
};

/// Solves a random problem, and brings the answer back from nearby. False where that makes no step.
bool solve(std::uint64_t seed, Solved& out) {
  out.problem = random_problem(seed, 8, 1.0).problem;
  out.impulse.assign(static_cast<std::size_t>(out.problem.rows()), 0.0);
  SolverChain chain;
  if (!(chain.solve(out.problem, out.impulse).residual <= 1e-14)) return false;
  Random random(seed);
  for (double& impulse : out.impulse) impulse *= 1.0 + 1e-9 * random.uniform(-1.0, 1.0);
  NewtonPolish polish;
  const Residual found = polish.improve(out.problem, out.impulse, 4);
  polish.swap_equations(out.equations);
  return found.value <= 1e-14 && out.equations.are_of(out.problem);
}

/// The problem with W = (I + d) W (I + d)^T and b = (I + d) b for a small diagonal d: rows that have grown.
ContactProblem grown(const ContactProblem& problem, double by, std::uint64_t seed) {
  Random random(seed);
  ContactProblem out = problem;
  std::vector<double> factor(static_cast<std::size_t>(problem.rows()));
  for (double& value : factor) value = 1.0 + by * random.uniform(-1.0, 1.0);
  for (int i = 0; i < problem.rows(); ++i) {
    const auto row = static_cast<std::size_t>(i);
    for (int j = 0; j < problem.rows(); ++j) out.w(i, j) *= factor[row] * factor[static_cast<std::size_t>(j)];
    out.vector()[row] *= factor[row];
  }
  return out;
}

TEST(NewtonPolish, EquationsOfAProblemSolveOneNearby) {
  int solved = 0, refined = 0;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    Solved known;
    if (!solve(seed, known)) continue;
    // Forces that are not unique may need another of their answers.
    if (known.equations.factors.rank() < known.equations.rows.size()) continue;
    ++solved;
    const ContactProblem next = grown(known.problem, 1e-4, seed);
    std::vector<double> impulse = known.impulse;
    NewtonPolish polish;
    Residual found;
    if (!polish.refine(next, known.equations, impulse, found)) {
      EXPECT_EQ(impulse, known.impulse) << "seed " << seed;  // as they were
      continue;
    }
    ++refined;
    // Rounding of the products with W.
    EXPECT_LE(found.value, 1e-14) << "seed " << seed;
    std::vector<double> xi(impulse.size());
    next.velocities(impulse, xi);
    EXPECT_EQ(residual(next, impulse, xi).value, found.value) << "seed " << seed;
  }
  EXPECT_GT(solved, 100);
  // Few of the others are at the boundary of a mode, or as near to it as the rows have grown.
  EXPECT_GT(refined, 0.9 * solved);
}

TEST(NewtonPolish, EquationsOfOtherModesAreNoneOfTheProblem) {
  // b turned round: what was pressed together parts.
  int tried = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Solved known;
    if (!solve(seed, known)) continue;
    ContactProblem next = known.problem;
    for (double& velocity : next.vector()) velocity = -velocity;
    const std::vector<double> before = known.impulse;
    std::vector<double> impulse = before;
    NewtonPolish polish;
    Residual found;
    ++tried;
    if (polish.refine(next, known.equations, impulse, found)) {
      EXPECT_LE(found.value, 1e-14) << "seed " << seed;  // then it is an answer
    } else {
      EXPECT_EQ(impulse, before) << "seed " << seed;
    }
  }
  EXPECT_GT(tried, 50);
}

TEST(NewtonPolish, ContactsThatPartHaveNoImpulses) {
  int parting = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Solved known;
    if (!solve(seed, known)) continue;
    std::vector<double> xi(known.impulse.size());
    known.problem.velocities(known.impulse, xi);
    for (const RowGroup& rows : known.problem.groups()) {
      const auto normal = static_cast<std::size_t>(rows.first);
      if (!(xi[normal] > 1e-9)) continue;  // far above rounding
      ++parting;
      for (int i = rows.first; i < rows.first + rows.size; ++i)
        EXPECT_EQ(known.impulse[static_cast<std::size_t>(i)], 0.0) << "seed " << seed;
    }
  }
  EXPECT_GT(parting, 100);
}

TEST(NewtonPolish, NoStepLeavesNoEquations) {
  Solved known;
  ASSERT_TRUE(solve(1, known) || solve(2, known) || solve(3, known));
  NewtonPolish polish;
  std::vector<double> nothing(known.impulse.size(), 0.0);
  ContactProblem rest = known.problem;
  for (double& velocity : rest.vector()) velocity = 0.0;
  EXPECT_EQ(polish.improve(rest, nothing, 3).value, 0.0);
  ModeEquations equations;
  polish.swap_equations(equations);
  EXPECT_FALSE(equations.are_of(rest));
}

}  // namespace
}  // namespace carom
