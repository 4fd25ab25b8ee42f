// A problem in factors is the same problem as the one with its W as a matrix.

#include <carom/contact/solvers/contact_mode.h>
#include <carom/contact/solvers/contact_problem.h>
#include <carom/contact/solvers/problem_file.h>
#include <carom/contact/solvers/residual.h>
#include <carom/core/errors.h>

#include "tests/contact/random_factors.h"
#include "tests/temporary_folder.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace carom {
namespace {

using contact_test::Random;
using contact_test::random_factors;

TEST(FactoredProblem, MultipliesJudgesAndNamesLikeItsMatrix) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    const ContactProblem factored = random_factors(seed, {.contacts = 10, .bodies = 6, .friction = 2.0});
    const ContactProblem dense = factored.dense();
    ASSERT_TRUE(factored.is_factored());
    ASSERT_FALSE(dense.is_factored());
    const auto n = static_cast<std::size_t>(factored.rows());
    std::vector<double> p(n), xi_factored(n), xi_dense(n);
    Random random(seed);
    for (double& impulse : p) impulse = random.uniform(0.0, 1.0);
    factored.velocities(p, xi_factored);
    dense.velocities(p, xi_dense);
    for (std::size_t i = 0; i < n; ++i) {
      EXPECT_NEAR(xi_factored[i], xi_dense[i], 1e-14);
      EXPECT_EQ(factored.diagonal(static_cast<int>(i)), dense.diagonal(static_cast<int>(i)));
      for (std::size_t j = 0; j < i; ++j) {
        EXPECT_EQ(dense.matrix()[i * n + j], dense.matrix()[j * n + i]);
      }
    }
    EXPECT_EQ(residual(factored, p, xi_dense).value, residual(dense, p, xi_dense).value);
    EXPECT_EQ(residual(factored, p, xi_dense).group, residual(dense, p, xi_dense).group);
    ASSERT_EQ(factored.groups().size(), dense.groups().size());
    for (const RowGroup& group : factored.groups()) {
      EXPECT_EQ(contact_mode(factored, group, p, xi_dense), contact_mode(dense, group, p, xi_dense));
    }
  }
}

TEST(FactoredProblem, RefusesWhatItCannotHold) {
  ContactProblem problem = random_factors(1, {});
  problem.factors().rows[1].slot[1] = 5 - problem.factors().rows[0].slot[1];
  EXPECT_THROW(problem.group(), std::invalid_argument);  // rows of one contact, other slots
  problem = random_factors(1, {});
  problem.factors().rows[0].slot[0] = problem.factors().rows[1].slot[0] = 6;
  EXPECT_THROW(problem.group(), std::invalid_argument);  // no such slot
  problem.reset_factors(3, 1);
  problem.sets()[1] = problem.sets()[2] = {.kind = SetKind::bounded_disc, .bound = 0, .coefficient = 0.3};
  EXPECT_THROW(problem.group(), std::invalid_argument);
  EXPECT_THROW(problem.reset_factors(-1, 1), std::invalid_argument);
  EXPECT_THROW(problem.reset_factors(1, -1), std::invalid_argument);
}

TEST(FactoredProblem, BecomesADenseOneAgain) {
  ContactProblem problem = random_factors(1, {});
  problem.reset(2);
  EXPECT_FALSE(problem.is_factored());
  EXPECT_EQ(problem.matrix().size(), 4u);
  problem.w(0, 0) = 3.0;
  EXPECT_EQ(problem.diagonal(0), 3.0);
}

TEST(FactoredProblem, IsSavedAndLoadedExactly) {
  if (!problem_files_available()) GTEST_SKIP() << "built without JSON";
  const carom_test::TemporaryFolder folder;
  const std::string path = folder / "problem.json";
  const ContactProblem saved = random_factors(9, {.contacts = 12, .bodies = 7});
  saved.save(path);
  const ContactProblem loaded = ContactProblem::load(path);
  ASSERT_TRUE(loaded.is_factored());
  EXPECT_EQ(loaded.factors().inverse_mass, saved.factors().inverse_mass);
  ASSERT_EQ(loaded.rows(), saved.rows());
  for (std::size_t i = 0; i < static_cast<std::size_t>(saved.rows()); ++i) {
    EXPECT_EQ(loaded.factors().rows[i].slot, saved.factors().rows[i].slot);
    EXPECT_EQ(loaded.factors().rows[i].h, saved.factors().rows[i].h);
    EXPECT_EQ(loaded.vector()[i], saved.vector()[i]);
    EXPECT_EQ(loaded.sets()[i].coefficient, saved.sets()[i].coefficient);
  }
}

TEST(FactoredProblem, WrongFilesAreRefusedByName) {
  if (!problem_files_available()) GTEST_SKIP() << "built without JSON";
  const std::string good = R"({"format": "carom contact problem", "version": 1, "rows": 1,
    "inverse_masses": [[1, 1, 2]], "H": [[[0, 1, 0, 0.5]]], "b": [-1], "sets": [{"kind": "half_line"}]})";
  const carom_test::TemporaryFolder folder;
  const std::string path = folder / "problem.json";
  const auto message = [&](const std::string& replace, const std::string& by) -> std::string {
    std::string text = good;
    text.replace(text.find(replace), replace.size(), by);
    std::ofstream(path) << text;
    try {
      static_cast<void>(ContactProblem::load(path));
    } catch (const FileError& error) {
      return error.what();
    }
    return "taken";
  };
  EXPECT_EQ(message("-1", "-2"), "taken");
  const auto expect = [&](const std::string& replace, const std::string& by, const std::string& says) {
    const std::string said = message(replace, by);
    EXPECT_NE(said.find(says), std::string::npos) << said;
  };
  expect("[1, 1, 2]", "[1, 1]", "inverse_masses[0] is a list of 2; allowed: a list of 3 numbers");
  expect("[1, 1, 2]", "[1, -1, 2]", "inverse_masses[0][1] is -1; allowed: >= 0");
  expect("[[1, 1, 2]]", "7", "inverse_masses is 7; allowed: a list");
  expect("\"inverse_masses\": [[1, 1, 2]],", "", "inverse_masses is not given");
  expect("[[[0, 1, 0, 0.5]]]", "[]", "H is a list of 0; allowed: a list of 1 rows");
  expect("[[[0, 1, 0, 0.5]]]", "[3]", "H[0] is 3; allowed: a list of up to 3 blocks");
  expect("[0, 1, 0, 0.5]", "[0, 1, 0]", "H[0][0] is a list of 3; allowed: a list of 4 numbers");
  expect("[0, 1, 0, 0.5]", "[1, 1, 0, 0.5]", "H[0][0][0] is 1; allowed: a slot, 0 to 0");
  expect("[0, 1, 0, 0.5]", "[0, 1, true, 0.5]", "H[0][0][2] is true; allowed: a number");
  expect("\"H\"", "\"W\": [[1]], \"H\"", "W is given beside H");
}

}  // namespace
}  // namespace carom
