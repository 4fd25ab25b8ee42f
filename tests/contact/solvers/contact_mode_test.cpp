#include <carom/contact/solvers/contact_mode.h>
#include <carom/contact/solvers/single_contact.h>

#include "tests/contact/random_problems.h"

#include <gtest/gtest.h>

#include <vector>

namespace carom {
namespace {

ContactMode mode(const ContactProblem& problem, const std::vector<double>& impulse) {
  std::vector<double> xi(impulse.size());
  problem.velocities(impulse, xi);
  return contact_mode(problem, problem.groups()[0], impulse, xi);
}

bool boundary(const ContactProblem& problem, const std::vector<double>& impulse) {
  std::vector<double> xi(impulse.size());
  problem.velocities(impulse, xi);
  return at_mode_boundary(problem, impulse, xi);
}

TEST(ContactMode, PlanarContact) {
  ContactProblem problem;
  contact_test::make_problem(1.0, 0.0, 1.0, 1.0, 2.0, 0.5, problem);
  EXPECT_EQ(mode(problem, {0.0, 0.0}), ContactMode::open);
  contact_test::make_problem(1.0, 0.0, 1.0, -1.0, 2.0, 0.5, problem);
  EXPECT_EQ(mode(problem, {1.0, -0.5}), ContactMode::slip_positive);
  contact_test::make_problem(1.0, 0.0, 1.0, -1.0, -2.0, 0.5, problem);
  EXPECT_EQ(mode(problem, {1.0, 0.5}), ContactMode::slip_negative);
  contact_test::make_problem(1.0, 0.0, 1.0, -1.0, 0.25, 0.5, problem);
  EXPECT_EQ(mode(problem, {1.0, -0.25}), ContactMode::stick);
  // Friction exhausted and nothing slips.
  contact_test::make_problem(1.0, 0.0, 1.0, -1.0, 0.5, 0.5, problem);
  EXPECT_EQ(mode(problem, {1.0, -0.5}), ContactMode::stick);
}

TEST(ContactMode, RoundingDoesNotChangeIt) {
  ContactProblem problem;
  contact_test::make_problem(1.0, 0.0, 1.0, 1.0, 2.0, 0.5, problem);
  EXPECT_EQ(mode(problem, {1e-16, 0.0}), ContactMode::open);
  contact_test::make_problem(1.0, 0.0, 1.0, -1.0, 0.25, 0.5, problem);
  EXPECT_EQ(mode(problem, {1.0, -0.25 + 1e-15}), ContactMode::stick);
}

TEST(ContactMode, LoneRows) {
  ContactProblem problem;
  problem.reset(1);
  problem.w(0, 0) = 1.0;
  problem.vector()[0] = -3.0;
  problem.group();
  EXPECT_EQ(mode(problem, {3.0}), ContactMode::stick);
  problem.sets()[0] = {.kind = SetKind::interval, .lower = -1.0, .upper = 1.0};
  EXPECT_EQ(mode(problem, {1.0}), ContactMode::slip_negative);  // the limit is reached, the row still closes
  problem.vector()[0] = 3.0;
  EXPECT_EQ(mode(problem, {-1.0}), ContactMode::slip_positive);
  problem.vector()[0] = 0.5;
  EXPECT_EQ(mode(problem, {-0.5}), ContactMode::stick);
}

TEST(ContactMode, Disc) {
  ContactProblem problem;
  problem.reset(3);
  for (int i = 0; i < 3; ++i) problem.w(i, i) = 1.0;
  problem.sets()[1] = problem.sets()[2] = {.kind = SetKind::bounded_disc, .bound = 0, .coefficient = 0.5};
  problem.vector()[0] = -1.0;
  problem.vector()[1] = 3.0;
  problem.vector()[2] = 4.0;
  problem.group();
  EXPECT_EQ(mode(problem, {1.0, -0.3, -0.4}), ContactMode::slip);
  problem.vector()[1] = problem.vector()[2] = 0.1;
  EXPECT_EQ(mode(problem, {1.0, -0.1, -0.1}), ContactMode::stick);
}

TEST(ContactMode, BoundariesAreSeen) {
  ContactProblem problem;
  contact_test::make_problem(1.0, 0.0, 1.0, -1.0, 0.25, 0.5, problem);
  EXPECT_FALSE(boundary(problem, {1.0, -0.25}));
  contact_test::make_problem(1.0, 0.0, 1.0, -1.0, 0.5, 0.5, problem);  // stick and slip meet
  EXPECT_TRUE(boundary(problem, {1.0, -0.5}));
  contact_test::make_problem(1.0, 0.0, 1.0, 0.0, 0.5, 0.5, problem);  // touches without impulse
  EXPECT_TRUE(boundary(problem, {0.0, 0.0}));
  contact_test::make_problem(1.0, 0.0, 1.0, 1.0, 0.5, 0.5, problem);
  EXPECT_FALSE(boundary(problem, {0.0, 0.0}));
}

}  // namespace
}  // namespace carom
