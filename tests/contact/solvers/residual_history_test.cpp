// Residuals of solvers over their sweeps.

#include <carom/contact/solvers/residual_history.h>

#include <carom/contact/solvers/residual.h>
#include <carom/contact/solvers/solver_chain.h>
#include <carom/core/errors.h>

#include "tests/contact/random_factors.h"
#include "tests/contact/random_problems.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace carom {
namespace {

// So many contacts that nothing polishes what sweeps have found.
ContactProblem large_problem() { return contact_test::random_factors(1, {.contacts = 250, .bodies = 300}); }

void expect_history(const ResidualHistory& history, std::size_t least) {
  ASSERT_GE(history.sweeps.size(), least);
  double before = 0.0;
  for (std::size_t i = 0; i < history.sweeps.size(); ++i) {
    EXPECT_EQ(history.sweeps[i].iterations, static_cast<int>(i) + 1);
    EXPECT_GE(history.sweeps[i].seconds, before);
    before = history.sweeps[i].seconds;
  }
}

TEST(ResidualHistory, OfSweepsEndsWithTheResidualOfTheAnswer) {
  const ContactProblem problem = large_problem();
  const SweepBudget budget{.residual = 1e-9, .sweeps = 3000};
  const ResidualHistory history = residual_history(problem, SolverId::nonlinear_cg, budget);
  expect_history(history, 10);
  EXPECT_EQ(history.solver, "nonlinear CG");
  EXPECT_EQ(history.outcome, Outcome::solved);
  EXPECT_EQ(history.answer.iterations, history.sweeps.back().iterations);
  EXPECT_EQ(history.answer.residual, history.sweeps.back().residual);
  EXPECT_LE(history.answer.residual, budget.residual);
  EXPECT_GT(history.sweeps.front().residual, 1e3 * budget.residual);
}

TEST(ResidualHistory, EndsWithTheBudget) {
  const ResidualHistory history = residual_history(large_problem(), SolverId::nonlinear_cg,
                                                   {.residual = 1e-9, .sweeps = 7, .accepted = 1.0});
  expect_history(history, 7);
  EXPECT_EQ(history.sweeps.size(), 7U);
  EXPECT_EQ(history.outcome, Outcome::accepted_at_cap);
  // The answer is the best of those that were looked at, the last among them.
  EXPECT_LE(history.answer.residual, history.sweeps.back().residual);
}

// Masses that differ by 1e6 get some thirty times the sweeps of the budget: the history has all of them.
TEST(ResidualHistory, IsThatOfTheAnswer) {
  const ContactProblem problem =
      contact_test::random_factors(1, {.contacts = 250, .bodies = 300, .mass_ratio = 1e6});
  const ResidualHistory history =
      residual_history(problem, SolverId::nonlinear_cg, {.residual = 1e-13, .sweeps = 7, .accepted = 1.0});
  EXPECT_GT(history.answer.iterations, 7);
  EXPECT_EQ(history.sweeps.size(), static_cast<std::size_t>(history.answer.iterations));
}

// Contacts in space, each of which meets the next one.
TEST(ResidualHistory, OfDenseSweepsFallsToRounding) {
  constexpr int contacts = 8, rows = 3 * contacts;
  ContactProblem problem;
  problem.reset(rows);
  for (int i = 0; i < rows; ++i) {
    problem.vector()[static_cast<std::size_t>(i)] = i % 3 == 0 ? -1.0 : 0.3 * std::sin(i);
    for (int j = 0; j < rows; ++j) {
      if (std::abs(i / 3 - j / 3) <= 1) problem.w(i, j) = i == j ? 2.0 : 0.2 / (1.0 + std::abs(i - j));
    }
    if (i % 3 == 0) continue;
    problem.sets()[static_cast<std::size_t>(i)] = {
        .kind = SetKind::bounded_disc, .bound = i - i % 3, .coefficient = 0.3};
  }
  problem.group();
  const ResidualHistory history = residual_history(problem, SolverId::dense_sweeps);
  expect_history(history, 1);
  EXPECT_EQ(history.outcome, Outcome::solved);
  EXPECT_GT(history.sweeps.front().residual, 1e-3);
  // The first attempt to finish by Newton's method is after ten sweeps, which have come to rounding by then.
  EXPECT_EQ(history.sweeps.size(), 10U);
  EXPECT_LE(history.sweeps.back().residual, 1e-15);
  EXPECT_LE(history.answer.residual, 1e-15);
}

TEST(ResidualHistory, OfOtherSolversIsTheirAnswer) {
  const ContactProblem problem = contact_test::random_problem(4, 4).problem;
  for (const SolverId solver : {SolverId::principal_pivoting, SolverId::lemke}) {
    const ResidualHistory history = residual_history(problem, solver);
    EXPECT_TRUE(history.sweeps.empty());
    EXPECT_EQ(history.outcome, Outcome::solved);
    EXPECT_GT(history.answer.iterations, 0);
    EXPECT_LE(history.answer.residual, 1e-12);
  }
  const ResidualHistory none = residual_history(problem, SolverId::nonlinear_cg);
  EXPECT_TRUE(none.sweeps.empty());
  EXPECT_EQ(none.outcome, Outcome::not_solved);
}

TEST(ResidualHistory, IsATable) {
  const std::string path =
      (std::filesystem::path(testing::TempDir()) / "carom_residual_history.csv").string();
  const std::vector<ResidualHistory> histories{
      residual_history(large_problem(), SolverId::nonlinear_cg, {.sweeps = 3, .accepted = 1.0}),
      {.solver = "by hand", .outcome = Outcome::solved, .answer = {12, 0.25, 1e-13}}};
  write_histories(path, histories);
  std::ifstream in(path);
  std::string line;
  ASSERT_TRUE(std::getline(in, line));
  EXPECT_EQ(line, "solver,kind,outcome,iterations,seconds,residual");
  for (int sweep = 1; sweep <= 3; ++sweep) {
    ASSERT_TRUE(std::getline(in, line));
    EXPECT_TRUE(line.starts_with("nonlinear CG,sweep,," + std::to_string(sweep) + ",")) << line;
    const double residual = std::stod(line.substr(line.rfind(',') + 1));
    EXPECT_EQ(residual, histories[0].sweeps[static_cast<std::size_t>(sweep) - 1].residual);
  }
  ASSERT_TRUE(std::getline(in, line));
  EXPECT_TRUE(line.starts_with("nonlinear CG,answer,accepted at cap,3,")) << line;
  ASSERT_TRUE(std::getline(in, line));
  EXPECT_EQ(line, "by hand,answer,solved,12,0.25,1e-13");
  EXPECT_FALSE(std::getline(in, line));
  std::filesystem::remove(path);
  EXPECT_THROW(write_histories((std::filesystem::path(path) / "none" / "x.csv").string(), histories),
               FileError);
}

}  // namespace
}  // namespace carom
