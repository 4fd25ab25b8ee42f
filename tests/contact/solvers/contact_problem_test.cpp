#include <carom/contact/solvers/contact_problem.h>
#include <carom/contact/solvers/contact_solver.h>

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>
#include <vector>

namespace carom {
namespace {

RowSet friction(int bound, double mu) {
  return {.kind = SetKind::bounded_interval, .bound = bound, .coefficient = mu};
}

RowSet disc(int bound, double mu) {
  return {.kind = SetKind::bounded_disc, .bound = bound, .coefficient = mu};
}

RowSet proportional(int bound, double coefficient) {
  return {.kind = SetKind::proportional, .bound = bound, .coefficient = coefficient};
}

TEST(ContactProblem, GroupsContactsAndLoneRows) {
  ContactProblem problem;
  problem.reset(11);
  problem.sets()[1] = friction(0, 0.3);
  problem.sets()[2] = {.kind = SetKind::interval, .lower = -1.0, .upper = 2.0};
  problem.sets()[4] = disc(3, 0.5);
  problem.sets()[5] = disc(3, 0.5);
  problem.sets()[6] = friction(3, 0.1);  // rolling moment of the same contact
  problem.sets()[8] = friction(7, 0.0);
  problem.sets()[10] = proportional(9, -0.3);
  problem.group();
  ASSERT_EQ(problem.groups().size(), 5u);
  const int first[] = {0, 2, 3, 7, 9}, size[] = {2, 1, 4, 2, 2};
  for (std::size_t g = 0; g < 5; ++g) {
    EXPECT_EQ(problem.groups()[g].first, first[g]);
    EXPECT_EQ(problem.groups()[g].size, size[g]);
  }
}

// Solvers take a short way for it: nothing else may look like it, nor may it before it is grouped.
TEST(ContactProblem, KnowsOneContactInThePlane) {
  ContactProblem problem;
  problem.reset(2);
  problem.sets()[1] = friction(0, 0.3);
  EXPECT_FALSE(problem.is_one_planar_contact());
  problem.group();
  EXPECT_TRUE(problem.is_one_planar_contact());
  EXPECT_TRUE(problem.dense().is_one_planar_contact());
  problem.sets()[1] = proportional(0, 0.3);
  problem.group();
  EXPECT_FALSE(problem.is_one_planar_contact());
  problem.reset(3);
  problem.sets()[1] = friction(0, 0.3);
  problem.group();
  EXPECT_FALSE(problem.is_one_planar_contact());
  problem.reset(2);
  problem.group();  // two limits
  EXPECT_FALSE(problem.is_one_planar_contact());
  problem.reset_factors(2, 1);
  problem.sets()[1] = friction(0, 0.3);
  problem.group();
  EXPECT_FALSE(problem.is_one_planar_contact());
  EXPECT_TRUE(problem.dense().is_one_planar_contact());
}

TEST(ContactProblem, RefusesSetsThatCannotBe) {
  const auto refused = [](int rows, auto fill) {
    ContactProblem problem;
    problem.reset(rows);
    fill(problem);
    EXPECT_THROW(problem.group(), std::invalid_argument);
  };
  refused(1, [](auto& p) { p.sets()[0] = friction(-1, 0.1); });
  refused(1, [](auto& p) { p.sets()[0] = friction(0, 0.1); });
  refused(3, [](auto& p) { p.sets()[2] = friction(0, 0.1); });  // another row between
  refused(2, [](auto& p) { p.sets()[1] = friction(0, -0.1); });
  refused(2, [](auto& p) { p.sets()[1] = friction(0, std::numeric_limits<double>::quiet_NaN()); });
  refused(2, [](auto& p) { p.sets()[1] = proportional(0, std::numeric_limits<double>::infinity()); });
  refused(2, [](auto& p) { p.sets()[1] = proportional(1, 0.1); });
  refused(1, [](auto& p) { p.sets()[0] = proportional(-1, 0.1); });
  refused(3, [](auto& p) { p.sets()[2] = proportional(0, 0.1); });
  refused(3, [](auto& p) {  // may be negative: gives nothing that could bound
    p.sets()[1] = proportional(0, 0.1);
    p.sets()[2] = friction(1, 0.1);
  });
  refused(2, [](auto& p) { p.sets()[1] = disc(0, 0.1); });  // second row missing
  refused(3, [](auto& p) {
    p.sets()[1] = disc(0, 0.1);
    p.sets()[2] = disc(0, 0.2);
  });
  refused(1, [](auto& p) { p.sets()[0] = {.kind = SetKind::interval, .lower = 1.0, .upper = 0.0}; });
  refused(2, [](auto& p) {
    p.sets()[0] = {
        .kind = SetKind::interval, .lower = -1.0, .upper = 1.0};  // may be negative: bounds nothing
    p.sets()[1] = friction(0, 0.1);
  });
  ContactProblem problem;
  EXPECT_THROW(problem.reset(-1), std::invalid_argument);
}

TEST(ContactProblem, VelocitiesAreWPPlusB) {
  ContactProblem problem;
  problem.reset(2);
  problem.w(0, 0) = 2.0;
  problem.w(0, 1) = problem.w(1, 0) = -1.0;
  problem.w(1, 1) = 4.0;
  problem.vector()[0] = 0.5;
  problem.vector()[1] = -3.0;
  std::vector<double> xi(2);
  problem.velocities(std::vector{3.0, 1.0}, xi);
  EXPECT_EQ(xi[0], 5.5);
  EXPECT_EQ(xi[1], -2.0);
}

TEST(ContactProblem, ResetForgetsEverything) {
  ContactProblem problem;
  problem.reset(2);
  problem.w(0, 1) = 1.0;
  problem.sets()[1] = friction(0, 0.3);
  problem.group();
  problem.reset(2);
  EXPECT_EQ(problem.w(0, 1), 0.0);
  EXPECT_EQ(problem.sets()[1].kind, SetKind::half_line);
  EXPECT_TRUE(problem.groups().empty());
}

TEST(ContactSolver, NamesOfOutcomesAndModes) {
  EXPECT_EQ(to_string(Outcome::solved), "solved");
  EXPECT_EQ(to_string(Outcome::several_solutions), "several solutions");
  EXPECT_EQ(to_string(Outcome::forces_not_unique), "forces not unique");
  EXPECT_EQ(to_string(Outcome::no_solution), "no solution");
  EXPECT_EQ(to_string(Outcome::not_solved), "not solved");
  EXPECT_EQ(to_string(ContactMode::open), "open");
  EXPECT_EQ(to_string(ContactMode::stick), "stick");
  EXPECT_EQ(to_string(ContactMode::slip_positive), "slip+");
  EXPECT_EQ(to_string(ContactMode::slip_negative), "slip-");
  EXPECT_EQ(to_string(ContactMode::slip), "slip");
}

}  // namespace
}  // namespace carom
