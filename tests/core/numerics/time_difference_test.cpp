// Derivatives of functions of time by differences: their stated accuracy, and that they keep to one side of a
// break.

#include <carom/core/numerics/time_difference.h>
#include <carom/core/space.h>

#include "tests/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace {

using namespace carom;

/// Errors that the header states, away from breaks and beside one.
double first_error(double w) { return std::pow(w / 4096, 6) / 140 * w + 2e-12; }
double second_error(double w) { return std::pow(w / 1024, 6) / 560 * w * w + 2e-9; }
double first_beside(double w, double size) { return std::pow(w / 4096, 6) * w + size * 4e-11; }
double second_beside(double w, double size) { return 3 * std::pow(w / 1024, 5) * w * w + size * 1.6e-7; }

TEST(TimeDifference, IsAsAccurateAsStated) {
  carom_test::Random random(71);
  for (const double w : {0.1, 1.0, 10.0, 50.0, 300.0, 1000.0}) {
    for (int repeat = 0; repeat < 50; ++repeat) {
      const double t = random.uniform(-3.0, 3.0), phase = random.uniform(0.0, 6.0);
      const auto f = [&](double time) { return std::sin(w * time + phase); };
      // Times of 3 s round the phase at 3 w eps, which adds to the rounding of f.
      const double rounding = 1.0 + w;
      EXPECT_NEAR(TimeDifference(t, 1, {})(f), w * std::cos(w * t + phase), rounding * first_error(w));
      EXPECT_NEAR(TimeDifference(t, 2, {})(f), -w * w * std::sin(w * t + phase), rounding * second_error(w));
    }
  }
}

TEST(TimeDifference, ConstantsHaveNone) {
  EXPECT_EQ(TimeDifference(0.37, 1, {})([](double) { return 1e10 / 3; }), 0.0);
  EXPECT_EQ(TimeDifference(0.37, 2, {})([](double) { return Vec<2>(0.1, 3.7); }), Vec<2>(0.0, 0.0));
}

TEST(TimeDifference, KeepsToOneSideOfABreak) {
  // sin(20 t) + 5 (t - 1) from t = 1 on, minus it before; the function itself jumps at t = 2.
  const std::vector<double> breaks{1.0, 2.0};
  const auto slope_after = [](double t) { return t < 1.0 ? -5.0 : 5.0; };
  const auto f = [&](double t) {
    return std::sin(20.0 * t) + slope_after(t) * (t - 1.0) + (t < 2.0 ? 0.0 : 100.0);
  };
  for (const double t : {0.9, 1.0 - 1e-4, std::nextafter(1.0, 0.0), 1.0, 1.0 + 1e-5, 1.0 + 3e-4, 1.5,
                         2.0 - 5e-4, std::nextafter(2.0, 0.0), 2.0, 2.0 + 1e-4}) {
    // Where f reaches 100, so does its rounding.
    const double size = t < 2.0 ? 1.0 : 100.0;
    EXPECT_NEAR(TimeDifference(t, 1, breaks)(f), 20.0 * std::cos(20.0 * t) + slope_after(t),
                first_beside(20.0, size))
        << t;
    EXPECT_NEAR(TimeDifference(t, 2, breaks)(f), -400.0 * std::sin(20.0 * t), second_beside(20.0, size)) << t;
  }
}

TEST(TimeDifference, FitsBetweenBreaksThatAreClose) {
  // 1e-4 s apart, less than six steps: the function is t^2 between them and nonsense elsewhere.
  const std::vector<double> breaks{0.5, 0.5001};
  const auto f = [](double t) { return t >= 0.5 && t < 0.5001 ? t * t : 1e6; };
  for (const double t : {0.5, 0.50003, 0.50009999}) {
    // Steps of 1.5e-5 s: rounding of f, 0.25 eps, over the step, magnified by one-sided weights (about 20);
    // the second derivative divides by the step twice.
    EXPECT_NEAR(TimeDifference(t, 1, breaks)(f), 2.0 * t, 1e-9);
    EXPECT_NEAR(TimeDifference(t, 2, breaks)(f), 2.0, 1e-3);
  }
}

}  // namespace
