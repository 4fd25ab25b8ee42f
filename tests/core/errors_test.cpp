#include <carom/contact/solvers/contact_problem.h>
#include <carom/core/errors.h>

#include <gtest/gtest.h>

#include <memory>
#include <stdexcept>

namespace {

using namespace carom;

TEST(Errors, AreOneTree) {
  EXPECT_THROW(throw ModelError("model"), Error);
  EXPECT_THROW(throw FileError("file"), Error);
  EXPECT_THROW(throw SolverError("solver", {}), Error);
  EXPECT_THROW(throw ModelError("model"), std::runtime_error);
}

TEST(Errors, SolverErrorCarriesWhatIsKnown) {
  const SolverError error("does not contract", {.time = 1.5,
                                                .step = 0.1,
                                                .suggested_step = 0.01,
                                                .residual = 3.0,
                                                .parts = {"spring-damper 'stiff'", "particle #1"},
                                                .problem = nullptr});
  EXPECT_STREQ(error.what(), "does not contract");
  EXPECT_EQ(error.failure().time, 1.5);
  EXPECT_EQ(error.failure().step, 0.1);
  EXPECT_EQ(error.failure().suggested_step, 0.01);
  EXPECT_EQ(error.failure().residual, 3.0);
  ASSERT_EQ(error.failure().parts.size(), 2U);
  EXPECT_EQ(error.failure().parts[0], "spring-damper 'stiff'");
}

TEST(Errors, AProblemThatIsNotThereIsNotHandedOut) {
  const SolverError error("gave up", {});
  EXPECT_FALSE(error.has_problem());
  EXPECT_THROW((void)error.problem(), std::logic_error);
}

TEST(Errors, TheProblemOutlivesItsMaker) {
  auto problem = std::make_shared<ContactProblem>();
  const ContactProblem* const address = problem.get();
  const SolverError error("gave up", {.problem = std::move(problem)});
  ASSERT_TRUE(error.has_problem());
  EXPECT_EQ(&error.problem(), address);
}

}  // namespace
