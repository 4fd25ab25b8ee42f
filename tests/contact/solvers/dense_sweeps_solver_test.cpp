#include <carom/contact/solvers/dense_sweeps_solver.h>
#include <carom/contact/solvers/newton_polish.h>
#include <carom/contact/solvers/residual.h>
#include <carom/contact/solvers/single_contact.h>

#include "tests/contact/random_problems.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>
#include <vector>

namespace carom {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

double judge(const ContactProblem& problem, const std::vector<double>& impulse) {
  std::vector<double> xi(impulse.size());
  problem.velocities(impulse, xi);
  return residual(problem, impulse, xi).value;
}

// Contacts of rigid bodies in space with the floor: normal row and disc, W = H M^-1 H^T.
ContactProblem spatial_problem(std::uint64_t seed) {
  contact_test::Random random(seed);
  const int contacts = random.integer(1, 4), rows = 3 * contacts;
  ContactProblem problem;
  problem.reset(rows);
  std::vector<double> h(static_cast<std::size_t>(6 * rows));
  const double mass = random.log_uniform(0.1, 10.0);
  double inverse[6] = {1.0 / mass, 1.0 / mass, 1.0 / mass, 0, 0, 0};
  for (int k = 3; k < 6; ++k) inverse[k] = 1.0 / (mass * random.uniform(0.1, 1.0));
  double velocity[6];
  for (double& v : velocity) v = random.uniform(-2.0, 2.0);
  velocity[2] = random.uniform(-4.0, -0.5);
  for (int c = 0; c < contacts; ++c) {
    const double r[3] = {random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-1.0, -0.1)};
    const double d[3][3] = {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}};
    for (int k = 0; k < 3; ++k) {
      double* out = h.data() + 6 * (3 * c + k);
      for (int i = 0; i < 3; ++i) out[i] = d[k][i];
      out[3] = r[1] * d[k][2] - r[2] * d[k][1];
      out[4] = r[2] * d[k][0] - r[0] * d[k][2];
      out[5] = r[0] * d[k][1] - r[1] * d[k][0];
    }
    const double mu = random.uniform(0.0, 1.0);
    for (int k = 1; k < 3; ++k) {
      problem.sets()[static_cast<std::size_t>(3 * c + k)] = {
          .kind = SetKind::bounded_disc, .bound = 3 * c, .coefficient = mu};
    }
  }
  const double e = random.uniform(0.0, 1.0);
  for (int i = 0; i < rows; ++i) {
    for (int k = 0; k < 6; ++k) {
      problem.vector()[static_cast<std::size_t>(i)] +=
          (1.0 + e) * h[static_cast<std::size_t>(6 * i + k)] * velocity[k];
      for (int j = 0; j < rows; ++j) {
        problem.w(i, j) +=
            h[static_cast<std::size_t>(6 * i + k)] * inverse[k] * h[static_cast<std::size_t>(6 * j + k)];
      }
    }
  }
  problem.group();
  return problem;
}

TEST(DenseSweepsSolver, DiscsInSpace) {
  int solved = 0;
  constexpr int problems = 1000;
  for (std::uint64_t seed = 0; seed < problems; ++seed) {
    const ContactProblem problem = spatial_problem(seed);
    std::vector<double> impulse(static_cast<std::size_t>(problem.rows()));
    DenseSweepsSolver solver;
    const SolverAnswer answer = solver.solve(problem, impulse);
    if (answer.outcome != Outcome::solved) {
      EXPECT_EQ(answer.reason, "sweep bound");
      continue;
    }
    ++solved;
    EXPECT_LE(judge(problem, impulse), 1e-12) << "seed " << seed;
  }
  std::printf("[   data   ] %d of %d spatial problems solved\n", solved, problems);
  EXPECT_GE(solved, problems * 99 / 100);
}

// Sweeps find the modes of nearly all, Newton's method the answer; of a jam they say so at their bound.
TEST(DenseSweepsSolver, ManyContactsOfThePlane) {
  int solved = 0, tried = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    const ContactProblem problem = contact_test::random_problem(seed, 20).problem;
    if (problem.rows() < swept_rows) continue;
    ++tried;
    std::vector<double> impulse(static_cast<std::size_t>(problem.rows()));
    DenseSweepsSolver solver;
    const SolverAnswer answer = solver.solve(problem, impulse);
    EXPECT_LE(answer.iterations, most_planar_sweeps);
    if (answer.outcome != Outcome::solved) continue;
    EXPECT_LE(judge(problem, impulse), 1e-12) << seed;
    ++solved;
  }
  EXPECT_GT(tried, 100);
  EXPECT_GE(solved, tried * 9 / 10);
}

TEST(DenseSweepsSolver, LeavesFewContactsOfThePlaneAlone) {
  const auto random = contact_test::random_problem(1, 6);
  std::vector<double> impulse(static_cast<std::size_t>(random.problem.rows()));
  DenseSweepsSolver solver;
  const SolverAnswer answer = solver.solve(random.problem, impulse);
  EXPECT_EQ(answer.outcome, Outcome::not_solved);
  EXPECT_EQ(answer.reason, "not applicable");
  EXPECT_EQ(answer.iterations, 0);
}

TEST(DenseSweepsSolver, EverySetAtOnce) {
  // A contact in space with a drilling and a rolling limit, a stop, a limited motor, a free reaction.
  ContactProblem problem;
  problem.reset(7);
  for (int i = 0; i < 7; ++i) {
    for (int j = 0; j < 7; ++j) problem.w(i, j) = i == j ? 2.0 : 0.2 / (1.0 + std::abs(i - j));
  }
  const double b[7] = {-2.0, 1.0, -1.5, 0.7, -1.0, 3.0, -0.4};
  for (std::size_t i = 0; i < 7; ++i) problem.vector()[i] = b[i];
  problem.sets()[1] = problem.sets()[2] = {.kind = SetKind::bounded_disc, .bound = 0, .coefficient = 0.4};
  problem.sets()[3] = {.kind = SetKind::bounded_interval, .bound = 0, .coefficient = 0.05};
  problem.sets()[5] = {.kind = SetKind::interval, .lower = -0.3, .upper = 0.3};
  problem.sets()[6] = {.kind = SetKind::interval, .lower = -infinity, .upper = infinity};
  problem.group();
  std::vector<double> impulse(7);
  DenseSweepsSolver solver;
  ASSERT_EQ(solver.solve(problem, impulse).outcome, Outcome::solved);
  EXPECT_LE(judge(problem, impulse), 1e-15);
  EXPECT_EQ(impulse[5], -0.3);
  EXPECT_NEAR(std::hypot(impulse[1], impulse[2]), 0.4 * impulse[0], 1e-15);
}

TEST(DenseSweepsSolver, SaysWhenItFails) {
  ContactProblem problem;  // two walls close on one body, one of them with friction in space
  problem.reset(4);
  for (int i = 0; i < 4; ++i) problem.w(i, i) = 1.0;
  problem.w(0, 1) = problem.w(1, 0) = -1.0;
  problem.vector()[0] = problem.vector()[1] = -1.0;
  problem.sets()[2] = problem.sets()[3] = {.kind = SetKind::bounded_disc, .bound = 1, .coefficient = 0.4};
  problem.group();
  std::vector<double> impulse(4);
  DenseSweepsSolver solver;
  const SolverAnswer answer = solver.solve(problem, impulse);
  EXPECT_EQ(answer.outcome, Outcome::not_solved);
  EXPECT_EQ(answer.iterations, most_dense_sweeps);
}

TEST(NewtonPolish, BringsADisturbedSolutionToRounding) {
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    contact_test::Random random(seed);
    ContactProblem problem;
    const auto impact = contact_test::random_impact(seed);
    contact_test::make_problem(impact, problem);
    const PlanarSolutions exact = solve_planar_contact(
        {impact.w_nn(), impact.w_nt(), impact.w_tt(), impact.b_n(), impact.b_t(), impact.friction});
    if (exact.degenerate) continue;
    std::vector<double> impulse{exact.list[0].normal * (1.0 + 1e-7 * random.uniform(-1.0, 1.0)),
                                exact.list[0].tangential * (1.0 + 1e-7 * random.uniform(-1.0, 1.0))};
    const double before = judge(problem, impulse);
    NewtonPolish polish;
    const double after = polish.improve(problem, impulse, 4).value;
    EXPECT_LE(after, before);
    EXPECT_EQ(after, judge(problem, impulse));
    EXPECT_LE(after, 1e-15) << "seed " << seed;
  }
}

TEST(NewtonPolish, NeverMakesAnAnswerWorse) {
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    contact_test::Random random(seed);
    const auto sample = contact_test::random_problem(seed, 5);
    std::vector<double> impulse(static_cast<std::size_t>(sample.problem.rows()));
    for (double& p : impulse) p = random.uniform(-1.0, 1.0);
    const double before = judge(sample.problem, impulse);
    NewtonPolish polish;
    const double after = polish.improve(sample.problem, impulse, 10).value;
    EXPECT_LE(after, before);
    EXPECT_EQ(after, judge(sample.problem, impulse));
  }
}

}  // namespace
}  // namespace carom
