#include <carom/contact/solvers/solution_list.h>

#include <carom/contact/solvers/residual.h>
#include <carom/contact/solvers/single_contact.h>
#include <carom/contact/solvers/solver_chain.h>

#include "tests/contact/random_problems.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace carom {
namespace {

// Contacts of one planar body of mass and inertia one: points from the centre, normal directions (angle from
// the vertical, counter-clockwise), b = (1 + e) H v.
ContactProblem one_body(const std::vector<std::array<double, 3>>& points, std::array<double, 3> velocity,
                        double friction, double e) {
  ContactProblem problem;
  const auto n = points.size();
  problem.reset(static_cast<int>(2 * n));
  std::vector<std::array<double, 3>> h;
  for (const auto& p : points) {
    const std::array<double, 2> normal{-std::sin(p[2]), std::cos(p[2])}, tangent{normal[1], -normal[0]};
    for (const auto& d : {normal, tangent}) h.push_back({d[0], d[1], p[0] * d[1] - p[1] * d[0]});
  }
  for (std::size_t i = 0; i < 2 * n; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      problem.vector()[i] += (1.0 + e) * h[i][k] * velocity[k];
      for (std::size_t j = 0; j < 2 * n; ++j) {
        problem.w(static_cast<int>(i), static_cast<int>(j)) += h[i][k] * h[j][k];
      }
    }
    if (i % 2 == 1) {
      problem.sets()[i] = {
          .kind = SetKind::bounded_interval, .bound = static_cast<int>(i) - 1, .coefficient = friction};
    }
  }
  problem.group();
  return problem;
}

// docs/method.md section 3: the tangential block of W is singular, only the sum of both friction impulses
// counts.
TEST(SolutionList, BrickOnTwoCornersHasForcesThatAreNotUnique) {
  const ContactProblem brick = one_body({{-1.0, -0.5, 0.0}, {1.0, -0.5, 0.0}}, {0.2, -1.0, 0.0}, 0.6, 0.0);
  SolutionList list;
  EXPECT_EQ(list.enumerate(brick), Outcome::forces_not_unique);
  EXPECT_EQ(list.end_velocities(), 1u);
  EXPECT_FALSE(list.unbounded());
  // It sticks: P_n sum 1, P_t sum -0.2, moments fix each P_n = 0.5 -+ 0.05. The extreme points are those
  // where one friction impulse is exhausted: P_t1 in [-0.3, 0.07] cut with the other's interval.
  ASSERT_EQ(list.size(), 2u);
  for (std::size_t k = 0; k < 2; ++k) {
    const auto p = list.impulse(k);
    EXPECT_NEAR(p[0] + p[2], 1.0, 1e-14);
    EXPECT_NEAR(p[1] + p[3], -0.2, 1e-14);
    EXPECT_NEAR(p[2] - p[0], 0.5 * 0.2, 1e-14);
    const bool exhausted =
        std::abs(std::abs(p[1]) - 0.6 * p[0]) < 1e-14 || std::abs(std::abs(p[3]) - 0.6 * p[2]) < 1e-14;
    EXPECT_TRUE(exhausted);
  }
  EXPECT_GT(std::abs(list.impulse(0)[1] - list.impulse(1)[1]), 0.1);
  // The chain takes one of them, or one between, and its end velocities are the only ones there are.
  SolverChain chain;
  std::vector<double> impulse(4);
  const ContactReport report = chain.solve(brick, impulse);
  EXPECT_TRUE(report.usable());
  EXPECT_LE(report.residual, 1e-15);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(chain.velocities()[i], list.velocity(0)[i], 1e-15);
}

TEST(SolutionList, SlidingBrickIsUnique) {
  const ContactProblem brick = one_body({{-1.0, -0.5, 0.0}, {1.0, -0.5, 0.0}}, {5.0, -1.0, 0.0}, 0.3, 0.5);
  SolutionList list;
  EXPECT_EQ(list.enumerate(brick), Outcome::solved);
  ASSERT_EQ(list.size(), 1u);
  EXPECT_NEAR(list.impulse(0)[1], -0.3 * list.impulse(0)[0], 1e-15);
}

// Squeezed between two walls at rest, friction beyond the jam: impulses along the null vector cost nothing.
TEST(SolutionList, JammedBodyHasUnboundedForces) {
  const double half_pi = std::acos(0.0);
  const ContactProblem jammed =
      one_body({{-1.0, 0.0, -half_pi}, {1.0, 0.0, half_pi}}, {0.0, -0.3, 0.0}, 0.8, 0.0);
  SolutionList list;
  const Outcome outcome = list.enumerate(jammed);
  EXPECT_TRUE(list.unbounded());
  // It can stay free of impulses and slide, or be stopped by any large enough pair of them.
  EXPECT_EQ(outcome, Outcome::several_solutions);
  EXPECT_GE(list.end_velocities(), 2u);
}

TEST(SolutionList, ThreeSolutionsOfOneContact) {
  ContactProblem problem;
  contact_test::make_problem(1.6, 1.2, 3.4, 0.1, 1.0, 2.0, problem);
  SolutionList list;
  EXPECT_EQ(list.enumerate(problem), Outcome::several_solutions);
  EXPECT_EQ(list.size(), 3u);
  EXPECT_EQ(list.end_velocities(), 3u);
  EXPECT_EQ(list.impulse(0)[0], 0.0);  // ordered by size
}

// Two ways to the same answer: closed form and enumeration.
TEST(SolutionList, CountsLikeTheClosedForm) {
  int several = 0;
  for (std::uint64_t seed = 0; seed < 3000; ++seed) {
    const auto impact = contact_test::random_impact(seed);
    ContactProblem problem;
    contact_test::make_problem(impact, problem);
    const PlanarSolutions exact = solve_planar_contact(
        {impact.w_nn(), impact.w_nt(), impact.w_tt(), impact.b_n(), impact.b_t(), impact.friction});
    // det W / (W_nn W_tt) below 1e-6 is left out: the enumeration counts solutions to nine digits.
    const double determinant = impact.w_nn() * impact.w_tt() - impact.w_nt() * impact.w_nt();
    if (exact.degenerate || determinant < 1e-6 * impact.w_nn() * impact.w_tt()) continue;
    SolutionList list;
    EXPECT_EQ(list.enumerate(problem), exact.outcome) << "seed " << seed;
    EXPECT_EQ(list.size(), static_cast<std::size_t>(exact.count)) << "seed " << seed;
    several += exact.count > 1 ? 1 : 0;
  }
  EXPECT_GT(several, 20);
}

TEST(SolutionList, ProvesThatThereIsNone) {
  // One body between two walls that close on it.
  ContactProblem problem;
  problem.reset(2);
  problem.w(0, 0) = problem.w(1, 1) = 1.0;
  problem.w(0, 1) = problem.w(1, 0) = -1.0;
  problem.vector()[0] = problem.vector()[1] = -1.0;
  problem.group();
  SolutionList list;
  EXPECT_EQ(list.enumerate(problem), Outcome::no_solution);
  EXPECT_EQ(list.size(), 0u);
}

TEST(SolutionList, LoneRowsWithIntervals) {
  ContactProblem problem;
  problem.reset(2);
  problem.w(0, 0) = problem.w(1, 1) = 1.0;
  problem.vector()[0] = -5.0;
  problem.vector()[1] = 0.5;
  problem.sets()[0] = {.kind = SetKind::interval, .lower = -1.0, .upper = 2.0};
  problem.sets()[1] = {.kind = SetKind::interval, .lower = -1.0, .upper = 2.0};
  problem.group();
  SolutionList list;
  EXPECT_EQ(list.enumerate(problem), Outcome::solved);
  EXPECT_EQ(list.impulse(0)[0], 2.0);
  EXPECT_EQ(list.impulse(0)[1], -0.5);
}

TEST(SolutionList, RefusesWhatItCannotEnumerate) {
  ContactProblem problem;
  problem.reset(4);
  problem.group();
  SolutionList list;
  EXPECT_EQ(list.enumerate(problem), Outcome::not_solved);  // four groups
  problem.reset(3);
  problem.sets()[1] = problem.sets()[2] = {.kind = SetKind::bounded_disc, .bound = 0, .coefficient = 0.5};
  problem.group();
  EXPECT_EQ(list.enumerate(problem), Outcome::not_solved);  // a disc
}

// Whatever the chain finds for two or three contacts is in the list.
TEST(SolutionList, HoldsWhatTheChainFinds) {
  int compared = 0, several = 0, not_unique = 0;
  for (std::uint64_t seed = 0; seed < 600; ++seed) {
    const auto random = contact_test::random_problem(seed, 3, 2.0);
    SolverChain chain;
    std::vector<double> impulse(static_cast<std::size_t>(random.problem.rows()));
    ASSERT_TRUE(chain.solve(random.problem, impulse).usable());
    SolutionList list;
    const Outcome outcome = list.enumerate(random.problem);
    ASSERT_GT(list.size(), 0u) << "seed " << seed;
    several += outcome == Outcome::several_solutions ? 1 : 0;
    not_unique += outcome == Outcome::forces_not_unique ? 1 : 0;
    if (outcome == Outcome::several_solutions && list.unbounded()) continue;  // rays are not listed
    bool known = false;
    for (std::size_t k = 0; k < list.size() && !known; ++k) {
      double difference = 0.0, size = 0.0;
      for (std::size_t i = 0; i < impulse.size(); ++i) {
        difference = std::max(difference, std::abs(chain.velocities()[i] - list.velocity(k)[i]));
        size = std::max(size, std::abs(random.problem.vector()[i]));
      }
      known = difference <= 1e-8 * size;
    }
    EXPECT_TRUE(known) << "seed " << seed;
    ++compared;
  }
  EXPECT_GT(compared, 500);
  EXPECT_GT(not_unique, 10);
  EXPECT_GT(several, 0);
}

}  // namespace
}  // namespace carom
