// Sweeps over problems in factors against the exact chain on the same problems with W as a matrix.

#include <carom/contact/solvers/nonlinear_cg_solver.h>

#include <carom/contact/solvers/residual.h>
#include <carom/contact/solvers/solver_chain.h>

#include "tests/contact/disc_pile.h"
#include "tests/contact/random_factors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace carom {
namespace {

using contact_test::FactorOptions;
using contact_test::random_factors;

/// Residual on the dense form of a problem: another W, other sums.
double judge(const ContactProblem& problem, const std::vector<double>& impulse) {
  const ContactProblem dense = problem.dense();
  std::vector<double> xi(impulse.size());
  dense.velocities(impulse, xi);
  return residual(dense, impulse, xi).value;
}

/// Largest difference of the velocities of two answers, against the largest velocity.
double velocity_difference(const ContactProblem& problem, const std::vector<double>& a,
                           const std::vector<double>& b) {
  std::vector<double> xi_a(a.size()), xi_b(b.size());
  problem.velocities(a, xi_a);
  problem.velocities(b, xi_b);
  double most = 0.0, size = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    most = std::max(most, std::abs(xi_a[i] - xi_b[i]));
    size = std::max({size, std::abs(xi_a[i]), std::abs(problem.vector()[i])});
  }
  return most / size;
}

struct Compared {
  int solved = 0, same = 0;
  double worst_residual = 0.0, worst_difference = 0.0;
};

Compared compare(const FactorOptions& options, int problems) {
  Compared result;
  SolverChain exact, sweeps;
  sweeps.set_budget({.residual = 1e-13, .sweeps = 20000});
  for (int seed = 0; seed < problems; ++seed) {
    const ContactProblem problem = random_factors(static_cast<std::uint64_t>(seed), options);
    std::vector<double> swept(static_cast<std::size_t>(problem.rows())), pivoted(swept.size());
    const ContactReport report = sweeps.solve(problem, swept);
    if (report.outcome == Outcome::solved) ++result.solved;
    result.worst_residual = std::max(result.worst_residual, judge(problem, swept));
    if (!exact.solve(problem.dense(), pivoted).usable()) continue;
    const double difference = velocity_difference(problem, swept, pivoted);
    if (difference < 1e-9) ++result.same;
    result.worst_difference = std::max(result.worst_difference, difference);
  }
  return result;
}

// Levers as long as the bodies, so that W is regular, and little friction: velocities after are unique. The
// residual is that of the sweeps' aim, 1e-13; velocities differ by the condition of W times that.
TEST(NonlinearCgSolver, AgreesWithTheExactChain) {
  for (const double friction : {0.0, 0.1}) {
    for (const double mass_ratio : {10.0, 1000.0}) {
      const Compared result =
          compare({.contacts = 20, .bodies = 15, .friction = friction, .mass_ratio = mass_ratio}, 60);
      EXPECT_EQ(result.solved, 60) << friction << " " << mass_ratio;
      EXPECT_EQ(result.same, 60) << friction << " " << mass_ratio;
      EXPECT_LE(result.worst_residual, 1e-13);
    }
  }
}

TEST(NonlinearCgSolver, IsForProblemsInFactorsOnly) {
  const ContactProblem problem = random_factors(1, {});
  std::vector<double> impulse(static_cast<std::size_t>(problem.rows()), 1.0);
  SolverChain chain;
  EXPECT_EQ(chain.solve_with(SolverId::nonlinear_cg, problem.dense(), impulse).reason, "not applicable");
  for (const SolverId other : all_solvers) {
    const ContactReport report = chain.solve_with(other, problem, impulse);
    EXPECT_EQ(report.usable(), other == SolverId::nonlinear_cg) << to_string(other);
  }
}

// Small problems are polished, or left to exact solvers.
TEST(NonlinearCgSolver, EndsAtItsBudget) {
  const ContactProblem problem = random_factors(3, {.contacts = 300, .bodies = 200});
  std::vector<double> impulse(static_cast<std::size_t>(problem.rows()));
  SolverChain chain;
  chain.set_budget({.residual = 1e-15, .sweeps = 5, .accepted = 1.0});
  const ContactReport rough = chain.solve(problem, impulse);
  EXPECT_EQ(rough.outcome, Outcome::accepted_at_cap);
  EXPECT_TRUE(rough.usable());
  EXPECT_EQ(rough.iterations, 5);
  EXPECT_EQ(rough.reason, "budget of sweeps");
  EXPECT_GE(rough.worst_group, 0);
  EXPECT_NEAR(rough.residual, judge(problem, impulse), 1e-14);
  chain.set_budget({.residual = 1e-15, .sweeps = 5, .accepted = 0.0});
  const ContactReport refused = chain.solve(problem, impulse);
  EXPECT_EQ(refused.outcome, Outcome::not_solved);
  EXPECT_FALSE(refused.usable());
  EXPECT_EQ(chain.statistics().accepted_at_cap, 1);
  EXPECT_EQ(chain.statistics().not_solved, 1);
  EXPECT_EQ(chain.statistics().certified[3], 1);
  EXPECT_THROW(chain.set_budget({.sweeps = -1}), std::invalid_argument);
  EXPECT_THROW(chain.set_budget({.residual = 0.0}), std::invalid_argument);
  EXPECT_THROW(chain.set_budget({.accepted = -1.0}), std::invalid_argument);
}

TEST(NonlinearCgSolver, StartsFromAnAnswer) {
  const ContactProblem problem = random_factors(5, {.contacts = 20, .bodies = 15});
  SolverChain chain;
  ContactSolution solution;
  solution.impulse.assign(static_cast<std::size_t>(problem.rows()), 0.0);
  chain.solve(problem, solution);
  EXPECT_EQ(solution.report.outcome, Outcome::solved);
  EXPECT_GT(solution.report.iterations, 0);
  const std::vector<double> impulse = solution.impulse;
  chain.solve(problem, solution);
  EXPECT_EQ(solution.report.iterations, 0);
  EXPECT_EQ(solution.impulse, impulse);
  EXPECT_FALSE(solution.changed_modes);
}

// Places of contacts are kept as long as the contacts are the same: a solver that has seen the steps before,
// and other problems between them, against a new one for each.
TEST(NonlinearCgSolver, WhatIsKeptOfTheProblemBeforeChangesNoBits) {
  contact_test::DiscPile pile({.discs = 80, .width = 0.4});
  const ContactProblem other = random_factors(7, {.contacts = 40, .bodies = 30});
  std::vector<double> of_other(static_cast<std::size_t>(other.rows()));
  SolverChain chain;
  NonlinearCgSolver kept;
  int same = 0, compared = 0;
  std::size_t rows = 0;
  for (int step = 0; step < 1200; ++step) {
    const ContactProblem& problem = pile.state();
    if (step % 3 == 0) {
      std::vector<double> first = pile.solution().impulse, second = first;
      if (step % 60 == 0) static_cast<void>(kept.solve(other, of_other));
      NonlinearCgSolver fresh;
      const SolverAnswer of_kept = kept.improve(problem, first), of_fresh = fresh.improve(problem, second);
      ASSERT_EQ(of_kept.iterations, of_fresh.iterations) << "step " << step;
      ASSERT_EQ(first, second) << "step " << step;
      ++compared;
      if (first.size() == rows) ++same;
      rows = first.size();
    }
    static_cast<void>(pile.advance(chain));
  }
  // Of both: contacts that come and go in the fall, and that stay at rest.
  EXPECT_GT(same, 100);
  EXPECT_GT(compared - same, 50);
}

TEST(SolverChain, HandsBackTheVelocitiesOfSweptImpulses) {
  contact_test::DiscPile pile({.discs = 80, .width = 0.4});
  SolverChain chain;
  std::vector<double> response;
  int handed_back = 0;
  for (int step = 0; step < 300; ++step) {
    const ContactProblem& problem = pile.state();
    chain.solve(problem, pile.solution());
    const ContactSolution& solution = pile.solution();
    problem.factors().respond(solution.impulse, response);
    if (!solution.response.empty()) {  // else one contact, or few that were left to exact solvers
      ASSERT_EQ(solution.response, response) << "step " << step;
      ++handed_back;
    }
    pile.move();
  }
  EXPECT_GT(handed_back, 150);
  // W in full has no slots.
  const ContactProblem dense = random_factors(1, {}).dense();
  pile.solution().impulse.assign(static_cast<std::size_t>(dense.rows()), 0.0);
  chain.solve(dense, pile.solution());
  EXPECT_TRUE(pile.solution().response.empty());
}

}  // namespace
}  // namespace carom
