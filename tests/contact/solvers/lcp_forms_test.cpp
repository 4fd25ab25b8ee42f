#include <carom/contact/solvers/lcp_forms.h>

#include <carom/contact/solvers/pivoting_solvers.h>
#include <carom/contact/solvers/residual.h>
#include <carom/core/numerics/lemke.h>

#include "tests/contact/random_problems.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace carom {
namespace {

using contact_test::Impact;

constexpr double infinity = std::numeric_limits<double>::infinity();

double judge(const ContactProblem& problem, const std::vector<double>& impulse) {
  std::vector<double> xi(impulse.size());
  problem.velocities(impulse, xi);
  return residual(problem, impulse, xi).value;
}

// The matrix and vector the paper prints (Johansson 1999, equation 13), brought from the
// mean velocities to xi = (1 + e) (mean) and from the paper's order (P_n, chi1, chi2) to the scaled
// variables.
TEST(PaperForm, IsThePapersForOneContact) {
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    const Impact impact = contact_test::random_impact(seed);
    ContactProblem problem;
    contact_test::make_problem(impact, problem);
    if (std::abs(impact.w_nt()) < 1e-3 * impact.w_nn())
      continue;  // 1 / Ibar = 0: nothing to compare in row 1
    PaperForm form;
    Lcp lcp;
    ASSERT_TRUE(form.build(problem, lcp));
    ASSERT_EQ(lcp.size, 3);

    const double r1 = -impact.r_y, r2 = impact.r_x;
    const double m1 = 1.0 / (1.0 / impact.mass + r1 * r1 / impact.inertia);
    const double coupling = r1 * r2 / impact.inertia;  // 1 / Ibar
    const double a = 1.0 + impact.e_n, c = m1 * (1.0 + impact.e_t), k = m1 * coupling;
    // First entry without cancellation, as the masses give it.
    const double a11 = m1 / impact.mass * (1.0 / impact.mass + (r1 * r1 + r2 * r2) / impact.inertia) / a;
    const double paper[3][3] = {{a11, -c * coupling / a, c * coupling / a},
                                {impact.friction + k, c, -c},
                                {impact.friction - k, -c, c}};
    const double q2 =
        c * impact.x_minus + m1 * (impact.load_x / impact.mass + r1 * impact.load_m / impact.inertia);
    const double q1 = impact.y_minus +
                      (impact.load_y / impact.mass + r2 * impact.load_m / impact.inertia - coupling * q2) / a;
    const double paper_q[3] = {q1, q2, -q2};
    std::vector<double> scale;
    group_scales(problem, scale);
    const double s = scale[0];
    // w: xi_n = a phi / s', psi = s psi';  z: P_n = s P_n', chi' = s (1 + e_t) chi.
    const double row[3] = {a * s, 1.0 / s, 1.0 / s};
    const double column[3] = {s, 1.0 / (s * (1.0 + impact.e_t)), 1.0 / (s * (1.0 + impact.e_t))};
    const double q_size = std::abs(paper_q[0]) + std::abs(coupling * q2) + std::abs(paper_q[1]) / m1;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        const double expected = row[i] * paper[i][j] * column[j];
        // mu -+ k cancels; the first entry is a Schur complement of W, whose entries are rounded already (it
        // adds no cancellation of its own: next test); everything else is products of a few factors.
        double size = std::abs(paper[i][j]);
        if (i > 0 && j == 0) size = impact.friction + std::abs(k);
        if (i == 0 && j == 0) size = impact.w_nn() / a;
        size *= row[i] * column[j];
        EXPECT_NEAR(lcp.at(i, j), expected, 2e-15 * size) << "seed " << seed << " entry " << i << j;
      }
      EXPECT_NEAR(lcp.q[static_cast<std::size_t>(i)], row[i] * paper_q[i],
                  1e-14 * row[i] * (i == 0 ? q_size : q_size * m1))
          << "seed " << seed;
    }
  }
}

// det W / W_tt from entries of W that agree in all but the last digits.
TEST(PaperForm, FirstEntryDoesNotCancel) {
  ContactProblem problem;
  const double tiny = std::exp2(-40);
  contact_test::make_problem(1.0, 1.0, 1.0 + tiny, -1.0, 0.1, 0.5, problem);
  PaperForm form;
  Lcp lcp;
  ASSERT_TRUE(form.build(problem, lcp));
  std::vector<double> scale;
  group_scales(problem, scale);
  EXPECT_EQ(lcp.at(0, 0), scale[0] * scale[0] * (tiny / (1.0 + tiny)));
}

TEST(PaperForm, DoesNotExistForTwoCornersOfABrick) {
  // Both corners have the same height under the centre: their tangential velocities are one.
  ContactProblem problem;
  problem.reset(4);
  const double h[4][3] = {{0, 1, -1}, {1, 0, 0.5}, {0, 1, 1}, {1, 0, 0.5}};
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      for (int k = 0; k < 3; ++k) problem.w(i, j) += h[i][k] * h[j][k];
    }
  }
  problem.sets()[1] = {.kind = SetKind::bounded_interval, .bound = 0, .coefficient = 0.5};
  problem.sets()[3] = {.kind = SetKind::bounded_interval, .bound = 2, .coefficient = 0.5};
  problem.vector()[0] = problem.vector()[2] = -1.0;
  problem.group();
  Lcp lcp;
  PaperForm paper;
  EXPECT_FALSE(paper.build(problem, lcp));
  PrincipalPivotingSolver pivoting;
  std::vector<double> impulse(4);
  const SolverAnswer answer = pivoting.solve(problem, impulse);
  EXPECT_EQ(answer.outcome, Outcome::not_solved);
  EXPECT_EQ(answer.reason, "not applicable");
  LemkeSolver lemke;
  EXPECT_EQ(lemke.solve(problem, impulse).outcome, Outcome::solved);
  EXPECT_LE(judge(problem, impulse), 1e-15);
}

TEST(LcpForms, DiscsAreNotApplicable) {
  ContactProblem problem;
  problem.reset(3);
  for (int i = 0; i < 3; ++i) problem.w(i, i) = 1.0;
  problem.sets()[1] = problem.sets()[2] = {.kind = SetKind::bounded_disc, .bound = 0, .coefficient = 0.5};
  problem.group();
  Lcp lcp;
  PaperForm paper;
  CopositiveForm copositive;
  EXPECT_FALSE(paper.build(problem, lcp));
  EXPECT_FALSE(copositive.build(problem, lcp));
}

// z^T M z = P^T W P + sigma (mu P_n) - ... >= 0 for z >= 0: tried on random z.
TEST(CopositiveForm, IsCopositive) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const auto random = contact_test::random_problem(seed, 6);
    CopositiveForm form;
    Lcp lcp;
    ASSERT_TRUE(form.build(random.problem, lcp));
    contact_test::Random numbers(seed);
    std::vector<double> z(lcp.q.size());
    for (int trial = 0; trial < 20; ++trial) {
      for (double& value : z) value = numbers.chance(0.5) ? 0.0 : numbers.uniform(0.0, 1.0);
      double sum = 0.0, size = 0.0;
      for (int i = 0; i < lcp.size; ++i) {
        for (int j = 0; j < lcp.size; ++j) {
          const double term = z[static_cast<std::size_t>(i)] * lcp.at(i, j) * z[static_cast<std::size_t>(j)];
          sum += term;
          size += std::abs(term);
        }
      }
      EXPECT_GE(sum, -1e-15 * size) << "seed " << seed;
    }
  }
}

// Lone rows with every kind of interval, coupled with contacts: both forms give answers the residual accepts.
TEST(LcpForms, IntervalsOfEveryKind) {
  int paper_solved = 0, lemke_solved = 0;
  constexpr int problems = 400;
  for (std::uint64_t seed = 0; seed < problems; ++seed) {
    contact_test::Random random(seed);
    ContactProblem problem;
    const int intervals = random.integer(1, 4), rows = intervals + 2;
    problem.reset(rows);
    std::vector<double> h(static_cast<std::size_t>(rows * rows));
    for (double& value : h) value = random.uniform(-1.0, 1.0);
    for (int i = 0; i < rows; ++i) {
      for (int j = 0; j < rows; ++j) {
        for (int k = 0; k < rows; ++k) {
          problem.w(i, j) +=
              h[static_cast<std::size_t>(i * rows + k)] * h[static_cast<std::size_t>(j * rows + k)];
        }
      }
      problem.w(i, i) += 0.1;
      problem.vector()[static_cast<std::size_t>(i)] = random.uniform(-2.0, 2.0);
    }
    problem.sets()[1] = {
        .kind = SetKind::bounded_interval, .bound = 0, .coefficient = random.uniform(0.0, 0.5)};
    for (int i = 2; i < rows; ++i) {
      const double low = random.uniform(-1.0, 0.5), high = low + random.uniform(0.0, 1.0);
      RowSet& set = problem.sets()[static_cast<std::size_t>(i)];
      switch (random.integer(0, 4)) {
        case 0:
          set = {.kind = SetKind::interval, .lower = low, .upper = high};
          break;
        case 1:
          set = {.kind = SetKind::interval, .lower = low, .upper = infinity};
          break;
        case 2:
          set = {.kind = SetKind::interval, .lower = -infinity, .upper = high};
          break;
        case 3:
          set = {.kind = SetKind::interval, .lower = -infinity, .upper = infinity};
          break;
        default:
          set = {.kind = SetKind::interval, .lower = low, .upper = low};
          break;
      }
    }
    problem.group();
    std::vector<double> impulse(static_cast<std::size_t>(rows));
    PrincipalPivotingSolver pivoting;
    if (pivoting.solve(problem, impulse).outcome == Outcome::solved) {
      ++paper_solved;
      EXPECT_LE(judge(problem, impulse), 1e-12) << "paper's form, seed " << seed;
    }
    LemkeSolver lemke;
    if (lemke.solve(problem, impulse).outcome == Outcome::solved) {
      ++lemke_solved;
      EXPECT_LE(judge(problem, impulse), 1e-13) << "copositive form, seed " << seed;
    }
  }
  EXPECT_EQ(lemke_solved, problems);
  EXPECT_GE(paper_solved, problems * 9 / 10);
}

TEST(PivotingSolvers, AgreeOnOneContact) {
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    Impact impact = contact_test::random_impact(seed);
    // Where the solution is unique (docs/method.md section 3), both have to find it.
    if (impact.friction * std::abs(impact.w_nt()) > 0.99 * impact.w_nn()) continue;
    ContactProblem problem;
    contact_test::make_problem(impact, problem);
    std::vector<double> by_pivoting(2), by_lemke(2);
    PrincipalPivotingSolver pivoting;
    LemkeSolver lemke;
    ASSERT_EQ(lemke.solve(problem, by_lemke).outcome, Outcome::solved) << "seed " << seed;
    EXPECT_LE(judge(problem, by_lemke), 1e-14) << "seed " << seed;
    if (pivoting.solve(problem, by_pivoting).outcome != Outcome::solved) continue;
    EXPECT_LE(judge(problem, by_pivoting), 1e-14) << "seed " << seed;
  }
}

TEST(PivotingSolvers, ARayWithoutFrictionProvesThatThereIsNoSolution) {
  // One body between two walls that close on it: P_1 = P_2 cancel, nothing stops the walls.
  ContactProblem problem;
  problem.reset(2);
  problem.w(0, 0) = problem.w(1, 1) = 1.0;
  problem.w(0, 1) = problem.w(1, 0) = -1.0;
  problem.vector()[0] = problem.vector()[1] = -1.0;
  problem.group();
  std::vector<double> impulse(2);
  LemkeSolver lemke;
  EXPECT_EQ(lemke.solve(problem, impulse).outcome, Outcome::no_solution);
}

}  // namespace
}  // namespace carom
