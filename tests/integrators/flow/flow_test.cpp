// Smooth motion step by step: as accurate as asked for, at the ends of steps and within them, undisturbed by
// who looks on, and clear about why it ends.

#include <carom/core/errors.h>
#include <carom/integrators/flow/flow.h>

#include "tests/allocation_counter.h"
#include "tests/integrators/flow_problems.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace flow_problems;
using carom::FlowMethod;
using carom::make_flow;
using carom::ModelError;
using carom::SolverError;

std::string message_of(Flow& flow, double time) {
  try {
    go_to(flow, time);
  } catch (const SolverError& error) {
    EXPECT_EQ(error.failure().time, flow.end());
    return error.what();
  }
  return "no error";
}

class FlowOf : public testing::TestWithParam<FlowMethod> {
protected:
  [[nodiscard]] bool one_step() const {
    return GetParam() == FlowMethod::explicit_runge_kutta || GetParam() == FlowMethod::one_step;
  }
  [[nodiscard]] std::unique_ptr<Flow> make(Problem& problem, double tolerance) const {
    return make_flow(GetParam(), problem, tolerance);
  }
};

std::string name_of(const testing::TestParamInfo<FlowMethod>& method) {
  switch (method.param) {
    case FlowMethod::explicit_runge_kutta:
      return "RungeKutta";
    case FlowMethod::adams:
      return "Adams";
    case FlowMethod::bdf:
      return "Bdf";
    case FlowMethod::one_step:
      return "OneStep";
  }
  return {};
}

INSTANTIATE_TEST_SUITE_P(Methods, FlowOf,
                         testing::Values(FlowMethod::explicit_runge_kutta, FlowMethod::adams, FlowMethod::bdf,
                                         FlowMethod::one_step),
                         name_of);

TEST_P(FlowOf, ErrorFollowsTheTolerance) {
  const std::array<double, 2> start{1.0, 0.0};
  for (const double tolerance : {1e-4, 1e-6, 1e-8, 1e-10}) {
    Problem problem = oscillator(tolerance);
    const auto flow = make(problem, tolerance);
    flow->start(0.0, start, 0.0);
    go_to(*flow, 20.0);
    const double error = distance(flow->state(), turned(start, 20.0));
    // Local errors of 40 to 900 steps, at most the tolerance each for methods with memory (which err on one
    // side) and far less for Runge-Kutta, which goes on with the better of its two answers.
    EXPECT_LE(error, (one_step() ? 10.0 : 500.0) * tolerance) << tolerance;
    EXPECT_GE(error, 0.1 * tolerance) << tolerance << ": more work than asked for";
    EXPECT_EQ(flow->counts().evaluations, problem.evaluations);
  }
}

TEST_P(FlowOf, PendulumReturnsAfterItsPeriod) {
  // T = 2 pi / agm(1, cos(amplitude / 2)), L/g = 1.
  const double amplitude = 2.0;
  double a = 1.0, b = std::cos(0.5 * amplitude);
  for (int i = 0; i < 8; ++i) {
    const double mean = 0.5 * (a + b);
    b = std::sqrt(a * b);
    a = mean;
  }
  const double period = 2.0 * std::numbers::pi / a;
  const std::array<double, 2> start{amplitude, 0.0};
  Problem problem = pendulum(1e-9);
  const auto flow = make(problem, 1e-9);
  flow->start(1.5, start, 0.0);
  go_to(*flow, 1.5 + period);
  EXPECT_LE(distance(flow->state(), start), one_step() ? 2e-8 : 1e-6);  // as above, 2 for the size of y
}

TEST_P(FlowOf, WithinAStepAsAccurateAsAtItsEnd) {
  for (const double tolerance : {1e-5, 1e-9}) {
    Problem problem = oscillator(tolerance);
    const auto flow = make(problem, tolerance);
    flow->start(0.0, std::array{1.0, 0.0}, 0.0);
    std::array<double, 2> y{};
    double sampled = 0.0, landed = 0.0;
    while (flow->end() < 10.0) {
      const std::vector<double> before(flow->state().begin(), flow->state().end());
      flow->advance(1.0);
      const double length = flow->end() - flow->begin();
      for (const double part : {0.02, 0.2, 0.45, 0.5, 0.7, 0.99}) {
        const double time = flow->begin() + part * length;
        const auto exact = turned(before, time - flow->begin());
        flow->sample(time, y);
        sampled = std::max(sampled, distance(y, exact));
        flow->land(time, y);
        landed = std::max(landed, distance(y, exact));
      }
      // The ends exactly.
      flow->sample(flow->begin(), y);
      EXPECT_EQ(distance(y, before), 0.0);
      flow->land(flow->end(), y);
      EXPECT_EQ(distance(y, flow->state()), 0.0);
    }
    // Error of one step; BDF's estimate is that of its predictor and short by a few.
    EXPECT_LE(sampled, (one_step() ? 1.0 : 5.0) * tolerance) << tolerance;
    EXPECT_LE(landed, (one_step() ? 1.0 : 5.0) * tolerance) << tolerance;
    EXPECT_GT(sampled, 0.0);
  }
}

TEST_P(FlowOf, LookingOnChangesNoBit) {
  Problem alone_problem = pendulum(1e-8), watched_problem = pendulum(1e-8);
  const auto alone = make(alone_problem, 1e-8), watched = make(watched_problem, 1e-8);
  const std::array<double, 2> start{1.0, 0.5};
  alone->start(0.0, start, 0.0);
  watched->start(0.0, start, 0.0);
  std::array<double, 2> y{};
  for (int i = 0; i < 300; ++i) {
    const double longest = i % 7 == 0 ? 0.003 : 0.1;  // cut some
    alone->advance(longest);
    watched->advance(longest);
    for (const double part : {0.3, 0.9}) {
      const double time = watched->begin() + part * (watched->end() - watched->begin());
      watched->land(time, y);
      watched->sample(time, y);
    }
    ASSERT_EQ(alone->end(), watched->end()) << i;
    ASSERT_EQ(alone->state()[0], watched->state()[0]) << i;
    ASSERT_EQ(alone->state()[1], watched->state()[1]) << i;
    ASSERT_EQ(alone->next_step(), watched->next_step()) << i;
  }
}

TEST_P(FlowOf, StepsAreNoLongerThanAllowedAndStopExactly) {
  Problem problem = oscillator(1e-5);
  const auto flow = make(problem, 1e-5);
  for (const double first_step : {0.0, 1e-3, 5.0}) {
    flow->start(0.1, std::array{1.0, 0.0}, first_step);
    int steps = 0;
    while (flow->end() < 1.7) {
      const double longest = std::min(0.01, 1.7 - flow->end());
      flow->advance(longest);
      EXPECT_LE(flow->end(), flow->begin() + longest);
      ++steps;
    }
    EXPECT_EQ(flow->end(), 1.7);
    EXPECT_LE(steps, 160 + 20);  // little more than the bound itself asks for
  }
}

TEST_P(FlowOf, CorrectionKeepsTheStep) {
  constexpr double tolerance = 1e-8;
  const auto run = [&](bool correcting) {
    Problem problem = oscillator(tolerance);
    const auto flow = make(problem, tolerance);
    flow->start(0.0, std::array{1.0, 0.0}, 0.0);
    while (flow->end() < 50.0) {
      flow->advance(50.0 - flow->end());
      if (!correcting) continue;
      const double radius = std::hypot(flow->state()[0], flow->state()[1]);
      const std::array<double, 2> y{flow->state()[0] / radius, flow->state()[1] / radius};
      const double next = flow->next_step();
      flow->correct(y);
      EXPECT_EQ(flow->begin(), flow->end());
      EXPECT_EQ(flow->next_step(), next);
      EXPECT_EQ(distance(flow->state(), y), 0.0);
    }
    const double error = distance(flow->state(), turned(std::array{1.0, 0.0}, 50.0));
    return std::pair{flow->counts(), error};
  };
  const auto [with, corrected] = run(true);
  const auto [without, free] = run(false);
  // Methods that begin at order 1 after each correction would make some thousand times as many.
  EXPECT_LE(with.steps, without.steps + without.steps / 20);
  EXPECT_LE(with.evaluations, without.evaluations + without.evaluations / 5);  // one of 6 for Runge-Kutta
  EXPECT_LT(corrected, free);
}

TEST_P(FlowOf, CorrectedMotionGoesOnFromThere) {
  Problem problem = oscillator(1e-9);
  const auto flow = make(problem, 1e-9);
  flow->start(0.0, std::array{1.0, 0.0}, 0.0);
  for (int i = 0; i < 40; ++i) flow->advance(0.1);
  const std::array<double, 2> y{flow->state()[0] + 1e-6, flow->state()[1] - 2e-6};
  flow->correct(y);
  const double from = flow->end();
  go_to(*flow, from + 2.0);
  // A thousand tolerances are noticed by the error test, not kept: what is left is the error of steps.
  EXPECT_LE(distance(flow->state(), turned(y, 2.0)), 3e-7);
  EXPECT_GE(distance(flow->state(), turned(std::array{1.0, 0.0}, from + 2.0)), 1e-6);
}

TEST_P(FlowOf, FirstStepFarTooLongIsSurvived) {
  Problem problem(1, 1e-9, [](double, const double* y, double* rates) { rates[0] = 1e6 * (1.0 - y[0]); });
  const auto flow = make(problem, 1e-9);
  flow->start(0.0, std::array{0.0}, 1.0);
  go_to(*flow, 1e-6);
  EXPECT_NEAR(flow->state()[0], -std::expm1(-1.0), 1e-7);  // a hundred tolerances
}

TEST_P(FlowOf, RatesThatAreNotFiniteAreNamed) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  testing::internal::CaptureStderr();
  Problem nowhere(1, 1e-9, [](double, const double*, double* rates) { rates[0] = nan; });
  const auto flow = make(nowhere, 1e-9);
  flow->start(0.25, std::array{1.0}, 0.0);
  EXPECT_NE(message_of(*flow, 1.0).find("at t = 0.25 s"), std::string::npos);
  flow->start(0.25, std::array{1.0}, 0.1);
  EXPECT_NE(message_of(*flow, 1.0).find("the rates are not finite"), std::string::npos);
  EXPECT_LE(nowhere.evaluations, 6);

  // Defined until t = 1.
  Problem half(1, 1e-9, [](double t, const double*, double* rates) { rates[0] = std::sqrt(1.0 - t); });
  const auto until = make(half, 1e-9);
  until->start(0.0, std::array{1.0}, 5.0);
  EXPECT_NE(message_of(*until, 2.0).find("the rates are not finite"), std::string::npos);
  EXPECT_NEAR(until->end(), 1.0, 1e-12);
  EXPECT_NEAR(until->state()[0], 1.0 + 2.0 / 3.0, one_step() ? 1e-8 : 1e-6);
  EXPECT_EQ(until->begin(), until->end());

  // Defined wherever the solution goes, but not everywhere a long step looks.
  Problem rim(1, 1e-9, [](double, const double* y, double* rates) { rates[0] = -std::sqrt(y[0]); });
  const auto along = make(rim, 1e-9);
  along->start(0.0, std::array{1.0}, 5.0);
  go_to(*along, 1.9);
  EXPECT_NEAR(along->state()[0], 0.05 * 0.05, 1e-7);  // (1 - t/2)^2
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST_P(FlowOf, BlowUpIsNamed) {
  testing::internal::CaptureStderr();
  Problem problem(1, 1e-9, [](double, const double* y, double* rates) { rates[0] = y[0] * y[0]; });
  const auto flow = make(problem, 1e-9);
  flow->start(0.0, std::array{1.0}, 0.0);
  const std::string message = message_of(*flow, 2.0);
  EXPECT_NE(message.find("steps have shrunk to the rounding of time"), std::string::npos) << message;
  EXPECT_NEAR(flow->end(), 1.0, 1e-6);  // y = 1 / (1 - t)
  EXPECT_THROW(flow->advance(1.0), ModelError);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST_P(FlowOf, WhatRatesThrowArrivesAndTheFlowCanStartAgain) {
  Problem problem(1, 1e-9, [](double t, const double*, double* rates) {
    if (t > 0.5) throw std::out_of_range("no data after 0.5 s");
    rates[0] = 1.0;
  });
  const auto flow = make(problem, 1e-9);
  flow->start(0.0, std::array{0.0}, 0.0);
  EXPECT_THROW(go_to(*flow, 1.0), std::out_of_range);
  EXPECT_LE(flow->end(), 0.5);
  EXPECT_NEAR(flow->state()[0], flow->end(), 1e-12);
  flow->start(0.0, std::array{0.0}, 0.0);
  go_to(*flow, 0.25);
  EXPECT_NEAR(flow->state()[0], 0.25, 1e-12);
  EXPECT_EQ(flow->counts().restarts, 2);
}

TEST_P(FlowOf, RefusesWhatCannotBe) {
  Problem problem = oscillator(1e-8);
  Problem empty(0, 1e-8, {}), intolerant(2, 0.0, {});
  EXPECT_THROW((void)make(problem, 0.0), ModelError);
  EXPECT_THROW((void)make(empty, 1e-8), ModelError);
  EXPECT_THROW((void)make(intolerant, 1e-8), ModelError);
  const auto flow = make(problem, 1e-8);
  std::array<double, 2> y{1.0, 0.0};
  EXPECT_THROW(flow->advance(1.0), ModelError);
  EXPECT_THROW(flow->start(0.0, std::array{1.0}, 0.0), ModelError);
  EXPECT_THROW(flow->start(0.0, y, -1.0), ModelError);
  flow->start(0.0, y, 0.0);
  EXPECT_EQ(flow->begin(), flow->end());
  EXPECT_THROW(flow->advance(0.0), ModelError);
  flow->advance(0.1);
  EXPECT_THROW(flow->sample(-0.1, y), ModelError);
  EXPECT_THROW(flow->land(flow->end() + 1e-9, y), ModelError);
}

TEST_P(FlowOf, SteadyStateTakesNoMemory) {
  Problem problem = pendulum(1e-8);
  const auto flow = make(problem, 1e-8);
  std::array<double, 2> y{1.0, 0.0};
  const auto use = [&] {
    flow->start(0.0, y, 0.0);
    for (int i = 0; i < 20; ++i) {
      flow->advance(0.1);
      const double middle = 0.5 * (flow->begin() + flow->end());
      flow->sample(middle, y);
      flow->land(middle, y);
      std::copy(flow->state().begin(), flow->state().end(), y.begin());
      flow->correct(y);
    }
  };
  use();
  const std::int64_t before = carom_test::allocations();
  use();
  EXPECT_EQ(carom_test::allocations() - before, 0);
}

TEST(RungeKuttaFlow, RestartsAreCheap) {
  Problem problem = pendulum(1e-8);
  const auto flow = make_flow(FlowMethod::explicit_runge_kutta, problem, 1e-8);
  const auto cost = [&](double first_step) {
    const int before = problem.evaluations;
    flow->start(0.0, std::array{1.0, 0.0}, first_step);
    flow->advance(1.0);
    return problem.evaluations - before;
  };
  (void)cost(0.0);
  EXPECT_EQ(cost(0.02), 7);  // 6 for the step and one at its beginning
  EXPECT_EQ(flow->end(), 0.02);
  EXPECT_EQ(cost(0.0), 9);  // two for the guess
  EXPECT_GT(flow->end(), 0.005);
}

TEST(RungeKuttaFlow, ACutDoesNotShortenTheStepsAfterIt) {
  Problem problem = pendulum(1e-8);
  const auto flow = make_flow(FlowMethod::explicit_runge_kutta, problem, 1e-8);
  flow->start(0.0, std::array{1.0, 0.0}, 0.0);
  for (int i = 0; i < 10; ++i) flow->advance(1.0);
  const double wanted = flow->next_step();
  ASSERT_GT(wanted, 0.01);
  flow->advance(1e-6);
  EXPECT_EQ(flow->next_step(), wanted);
  flow->advance(1.0);
  EXPECT_NEAR(flow->end() - flow->begin(), wanted, 1e-12);
}

TEST(RungeKuttaFlow, SamplingCostsThreeEvaluationsForAStepAndLandingSix) {
  Problem problem = pendulum(1e-8);
  const auto flow = make_flow(FlowMethod::explicit_runge_kutta, problem, 1e-8);
  flow->start(0.0, std::array{1.0, 0.0}, 0.1);
  flow->advance(1.0);
  std::array<double, 2> y{};
  int before = problem.evaluations;
  for (int i = 1; i < 10; ++i) flow->sample(0.1 * i * flow->end(), y);
  EXPECT_EQ(problem.evaluations - before, 3);
  before = problem.evaluations;
  flow->land(0.5 * flow->end(), y);
  EXPECT_EQ(problem.evaluations - before, 6);
}

/// The landing is made apart from the integrator whose steps it is like.
TEST(RungeKuttaFlow, ALandingHasTheBitsOfAStep) {
  Problem problem = pendulum(1e-8);
  const auto flow = make_flow(FlowMethod::explicit_runge_kutta, problem, 1e-8);
  for (const double angle : {0.3, 1.0, 2.0}) {
    flow->start(0.0, std::array{angle, 0.5}, 0.1);
    flow->advance(1.0);
    const double end = flow->end();
    for (const double part : {0.1, 0.5, 0.9}) {
      std::array<double, 2> landed{};
      flow->land(part * end, landed);
      const auto shorter = make_flow(FlowMethod::explicit_runge_kutta, problem, 1e-8);
      shorter->start(0.0, std::array{angle, 0.5}, part * end);
      shorter->advance(part * end);
      ASSERT_EQ(shorter->end(), part * end);
      EXPECT_EQ(landed[0], shorter->state()[0]) << angle << ' ' << part;
      EXPECT_EQ(landed[1], shorter->state()[1]) << angle << ' ' << part;
    }
  }
}

}  // namespace
