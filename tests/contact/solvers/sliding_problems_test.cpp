// Several contacts, of which some slip in a known direction and others may stick.

#include <carom/contact/solvers/lcp_forms.h>
#include <carom/contact/solvers/residual.h>
#include <carom/contact/solvers/solution_list.h>
#include <carom/contact/solvers/solver_chain.h>
#include <carom/core/numerics/lemke.h>

#include "tests/contact/brute_force.h"
#include "tests/contact/random_problems.h"
#include "tests/shares.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

namespace carom {
namespace {

double judge(const ContactProblem& problem, const std::vector<double>& impulse) {
  std::vector<double> xi(impulse.size());
  problem.velocities(impulse, xi);
  return residual(problem, impulse, xi).value;
}

// Whether the list has this solution: 1e-9 is to what solutions are told apart.
bool listed(const SolutionList& list, const std::vector<contact_test::Quad>& impulse) {
  for (std::size_t k = 0; k < list.size(); ++k) {
    double size = 1.0, off = 0.0;
    for (std::size_t i = 0; i < impulse.size(); ++i) {
      size = std::max(size, std::abs(list.impulse(k)[i]));
      off = std::max(off, std::abs(list.impulse(k)[i] - static_cast<double>(impulse[i])));
    }
    if (off <= 1e-9 * size) return true;
  }
  return false;
}

TEST(SlidingProblems, ChainAndListAgreeWithBruteForce) {
  SolverChain chain;
  int firm = 0, none = 0, several = 0;
  constexpr int problems = carom_test::count_of_samples(6000);
  for (std::uint64_t seed = 0; seed < problems; ++seed) {
    SCOPED_TRACE(seed);
    const int groups = 1 + static_cast<int>(seed % 3);
    // Friction up to 3 makes p < 0 frequent: none, one, several solutions.
    const ContactProblem problem = contact_test::random_sliding_problem(seed, groups, 0.6, 3.0);
    std::vector<double> impulse(static_cast<std::size_t>(problem.rows()));
    const ContactReport report = chain.solve(problem, impulse);
    if (report.usable()) {
      EXPECT_LE(judge(problem, impulse), tolerated_residual);
    }
    // Where a condition is nearer than this to failing, double precision may decide otherwise.
    const contact_test::QuadList exact = contact_test::quad_solutions(problem, 1e-7);
    if (!exact.firm) continue;
    ++firm;
    none += exact.impulses.empty() ? 1 : 0;
    several += exact.impulses.size() > 1 ? 1 : 0;
    EXPECT_EQ(report.usable(), !exact.impulses.empty()) << to_string(report.outcome);
    if (exact.impulses.empty()) {
      EXPECT_EQ(report.outcome, Outcome::no_solution);
    }
    SolutionList list;
    const Outcome outcome = list.enumerate(problem);
    EXPECT_EQ(outcome, exact.impulses.empty()       ? Outcome::no_solution
                       : exact.impulses.size() == 1 ? Outcome::solved
                                                    : Outcome::several_solutions);
    EXPECT_EQ(list.size(), exact.impulses.size());
    for (const auto& one : exact.impulses) EXPECT_TRUE(listed(list, one));
    for (std::size_t k = 1; k < list.size(); ++k) {
      const auto sum = [&](std::size_t at) {
        double total = 0.0;
        for (const double value : list.impulse(at)) total += std::abs(value);
        return total;
      };
      EXPECT_LE(sum(k - 1), sum(k));
    }
  }
  std::printf("[   data   ] %d of %d problems firm, %d without, %d with several solutions\n", firm, problems,
              none, several);
  EXPECT_GT(firm, problems * 95 / 100);
  EXPECT_GT(none, problems / 100);
  EXPECT_GT(several, problems / 100);
}

// Bodies as they are: W may be singular, b consistent with it; the list decides where the chain does not.
TEST(SlidingProblems, RigidBodiesAreSolvedOrRefuted) {
  SolverChain chain;
  int none = 0, compared = 0;
  for (std::uint64_t seed = 0; seed < 1500; ++seed) {
    SCOPED_TRACE(seed);
    ContactProblem problem = contact_test::random_problem(seed, 3, 2.0).problem;
    contact_test::Random random(seed);
    for (RowSet& set : problem.sets()) {
      if (set.kind != SetKind::bounded_interval || random.chance(0.4)) continue;
      set.kind = SetKind::proportional;
      if (random.chance(0.5)) set.coefficient = -set.coefficient;
    }
    problem.group();
    std::vector<double> impulse(static_cast<std::size_t>(problem.rows()));
    const ContactReport report = chain.solve(problem, impulse);
    SolutionList list;
    const Outcome outcome = list.enumerate(problem);
    ASSERT_TRUE(list.applicable());
    if (report.usable()) {
      EXPECT_LE(judge(problem, impulse), tolerated_residual);
    }
    if (outcome == Outcome::not_solved) continue;  // a near miss
    ++compared;
    none += outcome == Outcome::no_solution ? 1 : 0;
    EXPECT_EQ(report.usable(), outcome != Outcome::no_solution) << to_string(report.outcome);
  }
  EXPECT_GT(compared, 1490);
  EXPECT_GT(none, 10);
}

// mu up to 0.1 for W of condition below 10: the symmetric part of the reduced matrix is positive definite.
TEST(SlidingProblems, LargerOnesWithLittleFrictionAreSolvedByEverySolver) {
  SolverChain chain;
  constexpr int problems = 1000;
  int solved[5] = {};
  for (std::uint64_t seed = 0; seed < problems; ++seed) {
    SCOPED_TRACE(seed);
    const int groups = 4 + static_cast<int>(seed % 5);
    const ContactProblem problem = contact_test::random_sliding_problem(seed, groups, 0.5, 0.1);
    const auto n = static_cast<std::size_t>(problem.rows());
    std::vector<double> impulse(n), other(n);
    const ContactReport report = chain.solve(problem, impulse);
    ASSERT_TRUE(report.usable()) << report.reason;
    // W is well conditioned and at most 16 x 16.
    EXPECT_LE(judge(problem, impulse), 1e-14);
    for (std::size_t i = 0; i < n; ++i) {
      const RowSet& set = problem.sets()[i];
      if (set.kind != SetKind::proportional) continue;
      EXPECT_EQ(impulse[i], set.coefficient * impulse[i - 1]);
      const ContactMode mode = chain.modes()[i / 2];
      EXPECT_TRUE(mode == ContactMode::open || mode == sliding_mode(set.coefficient));
    }
    for (const SolverId solver : {SolverId::principal_pivoting, SolverId::lemke}) {
      if (!chain.solve_with(solver, problem, other).usable()) continue;
      ++solved[static_cast<std::size_t>(solver)];
      // The solution is unique; cond(W) = 10 times some roundings.
      for (std::size_t i = 0; i < n; ++i) EXPECT_NEAR(other[i], impulse[i], 1e-12) << to_string(solver);
    }
  }
  for (const SolverId solver : {SolverId::principal_pivoting, SolverId::lemke}) {
    EXPECT_EQ(solved[static_cast<std::size_t>(solver)], problems) << to_string(solver);
  }
}

// Lemke's ray proves that there is none only without friction of either sign.
TEST(SlidingProblems, ARayProvesNothingWhereContactsSlide) {
  SolverChain chain;
  int rays = 0, solvable_rays = 0;
  for (std::uint64_t seed = 0; seed < 3000; ++seed) {
    ContactProblem problem = contact_test::random_sliding_problem(seed, 3, 1.0, 4.0);
    for (std::size_t i = 1; i < 6; i += 2)
      problem.sets()[i].coefficient = -std::abs(problem.sets()[i].coefficient);
    std::vector<double> impulse(6);
    const ContactReport report = chain.solve_with(SolverId::lemke, problem, impulse);
    EXPECT_NE(report.outcome, Outcome::no_solution) << "seed " << seed;
    if (report.usable()) continue;
    ++rays;
    SolutionList list;
    list.enumerate(problem);
    solvable_rays += list.size() > 0 ? 1 : 0;
    EXPECT_EQ(chain.solve(problem, impulse).usable(), list.size() > 0) << "seed " << seed;
  }
  EXPECT_GT(rays, 100);
  EXPECT_GT(solvable_rays, 0);
}

// A contact in space that slips in a known direction, beside one that may stick: two proportional rows.
TEST(SlidingProblems, TwoTangentialRows) {
  ContactProblem problem;
  problem.reset(5);
  for (int i = 0; i < 5; ++i) {
    for (int j = 0; j < 5; ++j) problem.w(i, j) = i == j ? 2.0 : 0.3 / (1.0 + std::abs(i - j));
  }
  const double b[5] = {-2.0, 1.0, -1.5, -1.0, 0.7};
  for (std::size_t i = 0; i < 5; ++i) problem.vector()[i] = b[i];
  problem.sets()[1] = {.kind = SetKind::proportional, .bound = 0, .coefficient = 0.3};
  problem.sets()[2] = {.kind = SetKind::proportional, .bound = 0, .coefficient = -0.4};
  problem.sets()[4] = {.kind = SetKind::bounded_interval, .bound = 3, .coefficient = 0.5};
  problem.group();
  SolverChain chain;
  std::vector<double> first(5), impulse(5);
  ASSERT_TRUE(chain.solve(problem, first).usable());
  for (const SolverId solver : {SolverId::principal_pivoting, SolverId::lemke}) {
    ASSERT_TRUE(chain.solve_with(solver, problem, impulse).usable()) << to_string(solver);
    EXPECT_LE(judge(problem, impulse), 1e-15) << to_string(solver);
    EXPECT_EQ(impulse[1], 0.3 * impulse[0]);
    EXPECT_EQ(impulse[2], -0.4 * impulse[0]);
    for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(impulse[i], first[i], 1e-15) << to_string(solver);
  }
  EXPECT_GT(first[0], 0.5);
}

// A row that follows one with a lower bound of its own: offsets go through the coupled columns.
TEST(SlidingProblems, FollowsAnInterval) {
  ContactProblem problem;
  problem.reset(3);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) problem.w(i, j) = i == j ? 2.0 : 0.5;
  }
  for (std::size_t i = 0; i < 3; ++i) problem.vector()[i] = -1.0;
  problem.sets()[1] = {.kind = SetKind::interval, .lower = 0.25};
  problem.sets()[2] = {.kind = SetKind::proportional, .bound = 1, .coefficient = 0.5};
  problem.group();
  SolverChain chain;
  // At the bound: P = (0.8125 / 2, 0.25, 0.125) with xi_1 > 0; off it for b_1 = -1.
  for (const double b : {-1.0, 1.0}) {
    problem.vector()[1] = b;
    for (const SolverId solver : {SolverId::principal_pivoting, SolverId::lemke}) {
      std::vector<double> impulse(3);
      ASSERT_TRUE(chain.solve_with(solver, problem, impulse).usable()) << to_string(solver);
      EXPECT_LE(judge(problem, impulse), 1e-15) << to_string(solver);
      EXPECT_EQ(impulse[2], 0.5 * impulse[1]);
      EXPECT_EQ(impulse[1] > 0.25, b < 0.0) << to_string(solver);
      if (b > 0.0) {
        EXPECT_NEAR(impulse[0], 0.40625, 1e-15) << to_string(solver);
      }
    }
  }
}

}  // namespace
}  // namespace carom
