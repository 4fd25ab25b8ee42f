#include <carom/integrators/flow/sundials_errors.h>

#include <carom/core/errors.h>

#include <gtest/gtest.h>

#include <cmath>
#include <exception>
#include <stdexcept>
#include <string>

namespace {

using carom::SolverError;
using carom::SundialsErrors;

TEST(SundialsErrors, AnExceptionOfTheProblemComesFirst) {
  SundialsErrors errors;
  EXPECT_FALSE(errors.thrown());
  errors.keep_not_finite(1.0);
  errors.keep(std::make_exception_ptr(std::out_of_range("law")));
  EXPECT_TRUE(errors.thrown());
  EXPECT_THROW(errors.fail(-1, 0.0, 1.0), std::out_of_range);
}

TEST(SundialsErrors, TheTimeOfRatesThatAreNotFiniteOutlivesClear) {
  SundialsErrors errors;
  EXPECT_TRUE(std::isinf(errors.not_finite_at()));
  errors.keep_not_finite(2.5);
  EXPECT_TRUE(errors.not_finite());
  errors.clear();
  EXPECT_FALSE(errors.not_finite());
  EXPECT_EQ(errors.not_finite_at(), 2.5);
  EXPECT_THROW(errors.fail_not_finite(2.0, 1.0), SolverError);
}

TEST(SundialsErrors, MessagesAreToldWarningsAreNot) {
  SundialsErrors errors;
  errors.keep_message(-99, "out of memory");
  errors.keep_message(99, "a warning");  // CV_WARNING
  try {
    errors.demand(false, "CVodeCreate");
    FAIL() << "nothing is thrown";
  } catch (const SolverError& error) {
    EXPECT_NE(std::string(error.what()).find("CVodeCreate fails: out of memory"), std::string::npos)
        << error.what();
  }
  EXPECT_NO_THROW(errors.demand(true, "CVodeCreate"));
}

}  // namespace
