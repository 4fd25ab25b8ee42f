// Smooth motion step by step: as accurate as asked for, at the ends of steps and within them, undisturbed by
// who looks on, and clear about why it ends.

#include <carom/core/errors.h>
#include <carom/integrators/flow.h>
#include <carom/integrators/sundials_loops.h>

#include "tests/allocation_counter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <numbers>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace {

using carom::Flow;
using carom::FlowMethod;
using carom::make_flow;
using carom::ModelError;
using carom::SolverError;
using Function = std::function<void(double, const double*, double*)>;

// dy/dt = f(t, y) from a lambda.
class Problem : public carom::FlowProblem {
public:
  Problem(std::size_t size, double tolerance, Function rates)
      : tolerances_(size, tolerance), rates_(std::move(rates)) {}
  Problem(std::size_t size, double tolerance, Function rates, Function jacobian)
      : tolerances_(size, tolerance), rates_(std::move(rates)), jacobian_(std::move(jacobian)) {}

  [[nodiscard]] std::size_t size() const override { return tolerances_.size(); }
  void rates(double time, const double* y, double* rates) override {
    ++evaluations;
    rates_(time, y, rates);
  }
  [[nodiscard]] std::span<const double> absolute_tolerances() const override { return tolerances_; }
  [[nodiscard]] bool has_jacobian() const override { return static_cast<bool>(jacobian_); }
  void jacobian(double time, const double* y, double* jacobian) override {
    ++jacobians;
    jacobian_(time, y, jacobian);
  }

  int evaluations = 0;
  int jacobians = 0;

private:
  std::vector<double> tolerances_;
  Function rates_, jacobian_;
};

Problem oscillator(double tolerance) {
  return {2, tolerance, [](double, const double* y, double* rates) {
            rates[0] = y[1];
            rates[1] = -y[0];
          }};
}

// Where the oscillator is, a time t after y.
std::array<double, 2> turned(std::span<const double> y, double t) {
  return {std::cos(t) * y[0] + std::sin(t) * y[1], -std::sin(t) * y[0] + std::cos(t) * y[1]};
}

Problem pendulum(double tolerance) {
  return {2, tolerance, [](double, const double* y, double* rates) {
            rates[0] = y[1];
            rates[1] = -std::sin(y[0]);
          }};
}

double distance(std::span<const double> a, std::span<const double> b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

void go_to(Flow& flow, double time) {
  while (flow.end() < time) flow.advance(time - flow.end());
}

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

TEST(RungeKuttaFlow, SamplingCostsThreeEvaluationsForAStepAndLandingSeven) {
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
  EXPECT_EQ(problem.evaluations - before, 7);
}

TEST(BdfFlow, StiffOscillatorOfVanDerPol) {
  // y'' = 1000 (1 - y^2) y' - y, y(0) = 2, y'(0) = 0; at t = 2000 from E. Hairer, G. Wanner, Test Set for IVP
  // Solvers (problem VDPOL, in time scaled by 1000).
  const Function rates = [](double, const double* y, double* out) {
    out[0] = y[1];
    out[1] = 1e3 * (1.0 - y[0] * y[0]) * y[1] - y[0];
  };
  const Function jacobian = [](double, const double* y, double* out) {
    out[0] = 0.0;
    out[1] = -2e3 * y[0] * y[1] - 1.0;
    out[2] = 1.0;
    out[3] = 1e3 * (1.0 - y[0] * y[0]);
  };
  Problem with(2, 1e-11, rates, jacobian), without(2, 1e-11, rates);
  for (Problem* problem : {&with, &without}) {
    const auto flow = make_flow(FlowMethod::bdf, *problem, 1e-8);
    flow->start(0.0, std::array{2.0, 0.0}, 0.0);
    go_to(*flow, 2000.0);
    EXPECT_NEAR(flow->state()[0], 1.706167732170483, 3e-6);  // errors of the jumps between add up: 4e-7
    EXPECT_LE(flow->counts().steps, 5000);                   // an explicit method makes a million
  }
  EXPECT_GT(with.jacobians, 10);
}

// The loops beside the plainest ones, for lengths around those that they are cut into.
TEST(SundialsLoops, DoWhatTheySay) {
  namespace loops = carom::sundials_loops;
  for (const std::size_t n : {1U, 2U, 3U, 4U, 5U, 7U, 8U, 9U, 130U}) {
    std::vector<double> x(n), y(n), z(n), w(n);
    for (std::size_t i = 0; i < n; ++i) {
      x[i] = std::sin(1.0 + static_cast<double>(i));
      y[i] = 1.5 + std::cos(3.0 * static_cast<double>(i));
    }
    double sum = 0.0, largest = 0.0, weighted = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      sum += x[i] * y[i];
      largest = std::max(largest, std::abs(x[i]));
      weighted = std::max(weighted, std::abs(x[i] * y[i]));
    }
    EXPECT_NEAR(loops::dot(n, x.data(), y.data()), sum, 1e-13 * static_cast<double>(n));  // another order
    EXPECT_EQ(loops::maximum(n, x.data()), largest);
    EXPECT_EQ(loops::weighted_maximum(n, x.data(), y.data()), weighted);
    EXPECT_EQ(loops::minimum(n, y.data()), *std::min_element(y.begin(), y.end()));

    const std::array<double, 3> c{0.5, -2.0, 3.0};
    const std::array<const double*, 3> vectors{x.data(), y.data(), z.data()};
    z = x;
    loops::combine(
        n, 3, c.data(), [&](std::size_t j) { return vectors[j]; }, z.data());  // over an operand
    for (std::size_t i = 0; i < n; ++i) ASSERT_EQ(z[i], (0.5 * x[i] - 2.0 * y[i]) + 3.0 * x[i]) << n;

    const auto check = [&](auto&& expected) {
      for (std::size_t i = 0; i < n; ++i) ASSERT_DOUBLE_EQ(w[i], expected(i)) << n << ' ' << i;
    };
    loops::linear_sum(n, 2.0, x.data(), -3.0, y.data(), w.data());
    check([&](std::size_t i) { return 2.0 * x[i] - 3.0 * y[i]; });
    loops::multiply(n, x.data(), y.data(), w.data());
    check([&](std::size_t i) { return x[i] * y[i]; });
    loops::divide(n, x.data(), y.data(), w.data());
    check([&](std::size_t i) { return x[i] / y[i]; });
    loops::scale(n, 1.0, x.data(), w.data());
    check([&](std::size_t i) { return x[i]; });
    loops::scale(n, -4.0, w.data(), w.data());
    check([&](std::size_t i) { return -4.0 * x[i]; });
    loops::absolute(n, x.data(), w.data());
    check([&](std::size_t i) { return std::abs(x[i]); });
    loops::invert(n, y.data(), w.data());
    check([&](std::size_t i) { return 1.0 / y[i]; });
    loops::add_constant(n, x.data(), 7.0, w.data());
    check([&](std::size_t i) { return x[i] + 7.0; });
    loops::tolerance_weights(n, 0.1, x.data(), y.data(), w.data());
    check([&](std::size_t i) { return 1.0 / (0.1 * std::abs(x[i]) + y[i]); });
    loops::fill(n, 2.5, w.data());
    check([](std::size_t) { return 2.5; });

    // Not a number in any place is never overlooked.
    EXPECT_TRUE(loops::all_finite(n, x.data()));
    for (const double bad :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
      for (const std::size_t place : {std::size_t{0}, n / 2, n - 1}) {
        z = x;
        z[place] = bad;
        EXPECT_FALSE(loops::all_finite(n, z.data()));
        EXPECT_TRUE(std::isnan(loops::maximum(n, z.data())));
        EXPECT_TRUE(std::isnan(loops::weighted_maximum(n, z.data(), y.data())));
      }
    }
  }
}

}  // namespace
