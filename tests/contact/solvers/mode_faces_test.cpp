#include <carom/contact/solvers/mode_faces.h>

#include "tests/contact/brute_force.h"
#include "tests/contact/random_problems.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace carom {
namespace {

ContactProblem impact(double mu) {
  ContactProblem problem;
  contact_test::make_problem(2.0, 0.5, 1.0, -1.0, -0.25, mu, problem);
  return problem;
}

TEST(ModeFaces, AContactWithFrictionHasFourModes) {
  ModeFaces faces;
  const ContactProblem problem = impact(0.3);
  ASSERT_TRUE(faces.build(problem));
  ASSERT_EQ(faces.groups(), 1U);
  int modes = 0;
  for (std::size_t face = 0; face < faces.count(0); ++face)
    modes += faces.size(std::array{face}).pure ? 1 : 0;
  EXPECT_EQ(modes, 4);  // open, stick, slip either way
}

TEST(ModeFaces, WithoutFrictionItHasTwo) {
  ModeFaces faces;
  ASSERT_TRUE(faces.build(impact(0.0)));
  EXPECT_TRUE(faces.size(std::array<std::size_t, 1>{0}).pure);
  EXPECT_EQ(faces.size(std::array<std::size_t, 1>{0}).unknowns, 0U);
  EXPECT_TRUE(faces.size(std::array<std::size_t, 1>{1}).pure);
  EXPECT_EQ(faces.size(std::array<std::size_t, 1>{1}).unknowns, 1U);
}

TEST(ModeFaces, EquationsOfStickingAreThoseOfTheProblem) {
  ModeFaces faces;
  const ContactProblem problem = impact(0.3);
  ASSERT_TRUE(faces.build(problem));
  const std::array<std::size_t, 1> stick{1};
  ASSERT_EQ(faces.size(stick).unknowns, 2U);
  std::vector<double> system, rhs;
  faces.write_equations(problem, stick, std::vector<double>{4.0, 4.0}, system, rhs);
  EXPECT_EQ(system, (std::vector<double>{4.0, 1.0, 1.0, 2.0}));  // times sqrt(rho)
  EXPECT_EQ(rhs, (std::vector<double>{2.0, 0.5}));
  std::vector<double> impulses(2);
  faces.place(stick, std::vector<double>{1.5, -0.5}, impulses);
  EXPECT_EQ(impulses, (std::vector<double>{1.5, -0.5}));
}

TEST(ModeFaces, FourContactsAreTooMany) {
  ContactProblem problem;
  problem.reset(4);
  for (int i = 0; i < 4; ++i) {
    problem.w(i, i) = 1.0;
    problem.sets()[static_cast<std::size_t>(i)] = {.kind = SetKind::half_line};
  }
  problem.group();
  ModeFaces faces;
  EXPECT_FALSE(faces.build(problem));
}

}  // namespace
}  // namespace carom
