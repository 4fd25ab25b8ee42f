#include <carom/contact/solvers/residual.h>

#include "tests/contact/random_problems.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace carom {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

ContactProblem lone_row(RowSet set, double w, double b) {
  ContactProblem problem;
  problem.reset(1);
  problem.w(0, 0) = w;
  problem.vector()[0] = b;
  problem.sets()[0] = set;
  problem.group();
  return problem;
}

double judge(const ContactProblem& problem, std::vector<double> impulse) {
  std::vector<double> xi(impulse.size());
  problem.velocities(impulse, xi);
  return residual(problem, impulse, xi).value;
}

TEST(Residual, HalfLine) {
  const ContactProblem closing = lone_row({}, 2.0, -3.0);
  EXPECT_EQ(judge(closing, {1.5}), 0.0);
  EXPECT_EQ(judge(closing, {0.0}), 1.0);  // nothing done: off by the whole impulse
  // P* = |P| where that is larger than |b| / w; 1.503 and its residual are rounded.
  EXPECT_NEAR(judge(closing, {1.5 + 3e-3}), 3e-3 / 1.503, 3e-16);
  EXPECT_EQ(judge(lone_row({}, 2.0, 3.0), {0.0}), 0.0);
  EXPECT_EQ(judge(lone_row({}, 2.0, 3.0), {-1.5}), 1.0);  // pulls at the contact
}

// Impulses of 1000 N s that cancel each other hide an error of 5e-4 m/s from the residual, not from that of
// velocities.
TEST(Residual, OfVelocities) {
  ContactProblem problem;
  problem.reset(2);
  for (const int row : {0, 1}) {
    problem.w(row, row) = 1.0;
    problem.w(row, 1 - row) = -1.0;
    problem.vector()[static_cast<std::size_t>(row)] = row == 0 ? 2e-3 : -1e-3;  // none for which both are 0
  }
  problem.group();
  const std::vector<double> impulse{1e3, 1e3 + 1.5e-3};
  std::vector<double> xi(2);
  problem.velocities(impulse, xi);
  constexpr double rounding = 2e-13;  // of 1000 N s
  EXPECT_NEAR(xi[0], 5e-4, rounding);
  EXPECT_NEAR(xi[1], 5e-4, rounding);
  EXPECT_NEAR(residual(problem, impulse, xi).value, 5e-7, 1e-12);
  EXPECT_NEAR(residual_of_velocities(problem, impulse, xi), 5e-4 / 2e-3, rounding / 2e-3);
  EXPECT_EQ(residual_of_velocities(lone_row({}, 2.0, -3.0), std::vector{1.5}, std::vector{0.0}), 0.0);
  EXPECT_EQ(residual_of_velocities(lone_row({}, 2.0, 0.0), std::vector{1.0}, std::vector{2.0}), infinity);
}

TEST(Residual, FixedInterval) {
  const RowSet set{.kind = SetKind::interval, .lower = -1.0, .upper = 2.0};
  EXPECT_EQ(judge(lone_row(set, 1.0, 5.0), {-1.0}), 0.0);
  EXPECT_EQ(judge(lone_row(set, 1.0, -5.0), {2.0}), 0.0);
  EXPECT_EQ(judge(lone_row(set, 1.0, -1.5), {1.5}), 0.0);
  EXPECT_EQ(judge(lone_row(set, 1.0, -5.0), {1.0}), 0.2);  // P - P' = 1, P* = 5
  const RowSet free{.kind = SetKind::interval, .lower = -infinity, .upper = infinity};
  EXPECT_EQ(judge(lone_row(free, 2.0, 6.0), {-3.0}), 0.0);
  EXPECT_GT(judge(lone_row(free, 2.0, 6.0), {-2.0}), 0.3);
}

TEST(Residual, FrictionInThePlane) {
  ContactProblem problem;
  contact_test::make_problem(1.0, 0.0, 1.0, -1.0, 0.2, 0.5, problem);
  EXPECT_EQ(judge(problem, {1.0, -0.2}), 0.0);            // sticks
  EXPECT_NEAR(judge(problem, {1.0, -0.3}), 0.05, 1e-16);  // rho = 1/2, xi_t = -0.1, P* = 1
  contact_test::make_problem(1.0, 0.0, 1.0, -1.0, 2.0, 0.5, problem);
  EXPECT_EQ(judge(problem, {1.0, -0.5}), 0.0);  // slips
  EXPECT_EQ(judge(problem, {1.0, 0.5}), 1.0);   // friction drives
}

TEST(Residual, DiscInSpace) {
  ContactProblem problem;
  problem.reset(3);
  for (int i = 0; i < 3; ++i) problem.w(i, i) = 1.0;
  problem.sets()[1] = problem.sets()[2] = {.kind = SetKind::bounded_disc, .bound = 0, .coefficient = 0.5};
  problem.vector()[0] = -1.0;
  problem.vector()[1] = 3.0;
  problem.vector()[2] = 4.0;
  problem.group();
  EXPECT_LE(judge(problem, {1.0, -0.3, -0.4}), 1e-16);  // slips against (3, 4)
  EXPECT_GT(judge(problem, {1.0, -0.4, -0.3}), 0.02);   // of the right size, in the wrong direction
  problem.vector()[1] = 0.3;
  problem.vector()[2] = 0.3;
  EXPECT_LE(judge(problem, {1.0, -0.3, -0.3}), 1e-16);  // sticks
}

TEST(Residual, NamesTheWorstGroup) {
  ContactProblem problem;
  problem.reset(3);
  for (int i = 0; i < 3; ++i) {
    problem.w(i, i) = 1.0;
    problem.vector()[static_cast<std::size_t>(i)] = -1.0;
  }
  problem.group();
  const std::vector<double> impulse{1.0, 0.5, 0.9};
  std::vector<double> xi(3);
  problem.velocities(impulse, xi);
  EXPECT_EQ(residual(problem, impulse, xi).group, 1);
  EXPECT_EQ(residual(problem, impulse, xi).value, 0.5);
}

TEST(Residual, NothingToDoIsNoError) {
  EXPECT_EQ(judge(lone_row({}, 1.0, 0.0), {0.0}), 0.0);
  ContactProblem empty;
  empty.reset(0);
  empty.group();
  EXPECT_EQ(judge(empty, {}), 0.0);
}

TEST(Residual, NumbersWithoutDigitsAreNoPartOfThemselves) {
  constexpr double few_digits = 1e-316;
  EXPECT_LE(judge(lone_row({}, 2.0, -3.0 * few_digits), {0.0}), 1e-20);
  EXPECT_EQ(judge(lone_row({}, 2.0, -3e-280), {0.0}), 1.0);
}

TEST(Residual, NumbersThatAreNoneAreInfinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(judge(lone_row({}, 1.0, -1.0), {nan}), infinity);
  EXPECT_EQ(judge(lone_row({}, 1.0, nan), {0.0}), infinity);
  EXPECT_EQ(judge(lone_row({}, 1.0, -1.0), {infinity}), infinity);
  ContactProblem problem;
  for (const double bad : {nan, infinity, -infinity}) {
    contact_test::make_problem(1.0, 0.0, 1.0, -1.0, bad, 0.5, problem);
    EXPECT_EQ(judge(problem, {1.0, 0.0}), infinity);
    contact_test::make_problem(1.0, 0.0, 1.0, -1.0, 0.0, 0.5, problem);
    EXPECT_EQ(judge(problem, {1.0, bad}), infinity);
    EXPECT_EQ(judge(problem, {bad, 0.0}), infinity);
  }
}

TEST(Residual, ImmovableGroupsAreJudgedByTheMobilityOfTheOthers) {
  ContactProblem problem;
  problem.reset(2);
  problem.w(0, 0) = 2.0;
  problem.w(1, 1) = 1e-17;  // rounding of a zero
  problem.vector()[0] = -2.0;
  problem.group();
  EXPECT_EQ(judge(problem, {1.0, 0.0}), 0.0);
  problem.vector()[1] = 1.0;  // separates by itself
  EXPECT_EQ(judge(problem, {1.0, 0.0}), 0.0);
  problem.vector()[1] = -1.0;  // is driven in: no impulse helps
  EXPECT_EQ(judge(problem, {1.0, 0.0}), 0.5);
  EXPECT_EQ(judge(lone_row({}, 0.0, -1.0), {0.0}), 1.0);
  EXPECT_EQ(judge(lone_row({}, 0.0, 1.0), {0.0}), 0.0);
}

// A contact whose body can go along one line only, h, and is pressed across it: no impulse changes that. What
// rounding leaves of W there is no answer.
TEST(Residual, AnswersOfOneContactThatRoundingMakesAreNone) {
  const auto pressed = [](double across, double trifle) {
    ContactProblem problem;
    problem.reset(2);
    problem.w(0, 0) = trifle;
    problem.w(1, 1) = 1.0;
    problem.vector()[0] = -across;
    problem.sets()[1] = {.kind = SetKind::bounded_interval, .bound = 0, .coefficient = 0.5};
    problem.group();
    return problem;
  };
  EXPECT_EQ(judge(pressed(0.3, 1e-16), {0.3 / 1e-16, 0.0}), infinity);
  EXPECT_LE(judge(pressed(0.3, 1e-6), {0.3 / 1e-6, 0.0}), 1e-15);  // a light contact answers
  EXPECT_EQ(judge(pressed(0.0, 1e-16), {0.0, 0.0}), 0.0);
}

// The unrolled certificate of one planar contact says what the general one says: the same contact once alone,
// once beside a row that contributes nothing.
TEST(Residual, OnePlanarContactIsJudgedLikeAnyOther) {
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    contact_test::Random random(seed);
    ContactProblem alone, beside;
    contact_test::make_problem(contact_test::random_impact(seed), alone);
    beside.reset(3);
    for (int i = 0; i < 2; ++i) {
      for (int j = 0; j < 2; ++j) beside.w(i, j) = alone.w(i, j);
      beside.vector()[static_cast<std::size_t>(i)] = alone.vector()[static_cast<std::size_t>(i)];
    }
    beside.sets()[1] = alone.sets()[1];
    beside.w(2, 2) = 1.0;
    beside.group();
    const double size = std::abs(alone.vector()[0]) / alone.w(0, 0);
    const double p_n = random.uniform(-0.2, 1.0) * size, p_t = random.uniform(-1.0, 1.0) * size;
    // The general path rounds |b| rho row by row, the unrolled one once: equal to two roundings.
    const double expected = judge(beside, {p_n, p_t, 0.0});
    EXPECT_NEAR(judge(alone, {p_n, p_t}), expected, 5e-16 * expected) << "seed " << seed;
  }
}

}  // namespace
}  // namespace carom
