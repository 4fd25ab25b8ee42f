// Flows that serve one problem after the other: what they leave and take up is the motion to the last bit.

#include <carom/core/errors.h>
#include <carom/integrators/flow/flow.h>

#include "tests/integrators/flow_problems.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <memory>

namespace {

using namespace flow_problems;
using carom::FlowMethod;
using carom::FlowStep;
using carom::make_flow;
using carom::ModelError;
using carom::SolverError;

class SharedFlow : public testing::TestWithParam<FlowMethod> {
protected:
  [[nodiscard]] bool one_step() const {
    return GetParam() == FlowMethod::explicit_runge_kutta || GetParam() == FlowMethod::one_step;
  }
  [[nodiscard]] std::unique_ptr<Flow> make(Problem& problem, double tolerance) const {
    return make_flow(GetParam(), problem, tolerance);
  }
};

INSTANTIATE_TEST_SUITE_P(Methods, SharedFlow,
                         testing::Values(FlowMethod::explicit_runge_kutta, FlowMethod::adams, FlowMethod::bdf,
                                         FlowMethod::one_step));

// A flow in use makes the same of a start as a new one, whatever problem it served.
TEST_P(SharedFlow, AStartForgetsAllBefore) {
  for (const double first_step : {0.0, 1e-6, 0.05}) {
    Problem before = oscillator(1e-6), problem = pendulum(1e-8);
    const auto used = make(before, 1e-8), fresh = make(problem, 1e-8);
    used->start(3.0, std::array{0.0, 2.0}, 0.01);
    for (int i = 0; i < 50; ++i) used->advance(0.1);
    used->bind(problem);
    EXPECT_THROW(used->advance(0.1), ModelError);
    for (Flow* const flow : {used.get(), fresh.get()}) flow->start(0.5, std::array{1.0, 0.5}, first_step);
    for (int i = 0; i < 100; ++i) {
      used->advance(0.1);
      fresh->advance(0.1);
      ASSERT_EQ(used->end(), fresh->end()) << i;
      ASSERT_EQ(used->next_step(), fresh->next_step()) << i;
      ASSERT_EQ(distance(used->state(), fresh->state()), 0.0) << i;
    }
  }
}

// Two motions by turns on one flow, beside each on its own: cuts, corrections, landings, moves in the first
// step and in a row.
TEST_P(SharedFlow, LeftStepsAreTakenUpBitForBit) {
  std::array<Problem, 2> problems{pendulum(1e-8), oscillator(1e-6)}, alike{pendulum(1e-8), oscillator(1e-6)};
  std::array<std::unique_ptr<Flow>, 2> alone{make(alike[0], 1e-8), make(alike[1], 1e-8)};
  const auto shared = make(problems[0], 1e-8);
  std::array<FlowStep, 2> left;
  const std::array<double, 2> y{1.0, 0.5};
  for (std::size_t k = 0; k < 2; ++k) {
    const double first_step = k == 0 ? 0.0 : 1e-3;
    alone[k]->start(0.0, y, first_step);
    shared->bind(problems[k]);
    shared->start(0.0, y, first_step);
    ASSERT_TRUE(shared->leave(left[k]));
  }
  std::array<double, 2> landed{}, landed_alone{};
  for (int i = 0; i < 400; ++i) {
    const std::size_t k = i % 3 == 0 ? 0 : 1;
    Flow& own = *alone[k];
    shared->bind(problems[k]);
    shared->resume(left[k]);
    ASSERT_EQ(shared->begin(), own.begin());
    if (i % 11 == 5 && own.end() > own.begin()) {
      const double time = 0.3 * own.begin() + 0.7 * own.end();
      shared->land(time, landed);
      own.land(time, landed_alone);
      ASSERT_EQ(distance(landed, landed_alone), 0.0) << i;
    }
    if (i % 17 == 3) {
      const std::array<double, 2> corrected{own.state()[0] + 1e-9, own.state()[1]};
      shared->correct(corrected);
      own.correct(corrected);
    }
    const double longest = i % 7 == 2 ? 0.003 : 0.2;
    own.advance(longest);
    shared->advance(longest);
    ASSERT_EQ(shared->end(), own.end()) << i;
    ASSERT_EQ(shared->next_step(), own.next_step()) << i;
    ASSERT_EQ(distance(shared->state(), own.state()), 0.0) << i;
    if (!one_step()) {
      EXPECT_FALSE(shared->leave(left[k]));  // there is more to know
      return;
    }
    ASSERT_TRUE(shared->leave(left[k]));
  }
  for (std::size_t k = 0; k < 2; ++k) EXPECT_EQ(problems[k].evaluations, alike[k].evaluations);
  EXPECT_EQ(shared->counts().steps, alone[0]->counts().steps + alone[1]->counts().steps);
  EXPECT_EQ(shared->counts().restarts, 2);
}

TEST_P(SharedFlow, ATakenUpStepIsKnownWithin) {
  if (!one_step()) return;
  Problem problem = oscillator(1e-8);
  const auto flow = make(problem, 1e-8), other = make(problem, 1e-8);
  flow->start(0.0, std::array{1.0, 0.0}, 0.0);
  for (int i = 0; i < 5; ++i) flow->advance(0.1);
  FlowStep step;
  ASSERT_TRUE(flow->leave(step));
  std::array<double, 2> y{}, expected{};
  other->start(0.0, std::array{0.3, 0.2}, 0.02);  // another step, looked into, is behind it
  other->advance(0.1);
  other->sample(0.01, y);
  other->resume(step);
  for (const double part : {0.0, 0.3, 1.0}) {
    const double time = flow->begin() + part * (flow->end() - flow->begin());
    flow->land(time, expected);
    other->sample(time, y);
    EXPECT_EQ(distance(y, expected), 0.0);
  }
  FlowStep again;
  ASSERT_TRUE(other->leave(again));
  EXPECT_EQ(again.numbers, step.numbers);
}

TEST_P(SharedFlow, RefusesToServeWhatItDoesNotFit) {
  Problem two = oscillator(1e-8), one(1, 1e-8, [](double, const double*, double*rates) { rates[0] = 1.0; });
  Problem intolerant(2, 0.0, {});
  const auto flow = make(two, 1e-8), of_one = make(one, 1e-8);
  EXPECT_THROW(flow->bind(one), ModelError);
  EXPECT_THROW(flow->bind(intolerant), ModelError);
  FlowStep step;
  EXPECT_FALSE(of_one->leave(step));  // before a start
  of_one->start(0.0, std::array{1.0}, 0.0);
  ASSERT_TRUE(of_one->leave(step));
  EXPECT_THROW(flow->resume(step), ModelError);
}

// A step left before an error can be resumed; the flow that failed leaves nothing.
TEST_P(SharedFlow, AnErrorLeavesNothing) {
  Problem half(1, 1e-9, [](double t, const double*, double* rates) { rates[0] = std::sqrt(1.0 - t); });
  const auto flow = make(half, 1e-9);
  flow->start(0.0, std::array{1.0}, 0.0);
  EXPECT_THROW(go_to(*flow, 2.0), SolverError);
  FlowStep step;
  EXPECT_FALSE(flow->leave(step));
  EXPECT_TRUE(step.numbers.empty());
  Problem whole(1, 1e-9, [](double, const double*, double* rates) { rates[0] = 1.0; });
  flow->bind(whole);
  flow->start(0.0, std::array{1.0}, 0.0);
  go_to(*flow, 2.0);
  EXPECT_NEAR(flow->state()[0], 3.0, 1e-12);
}

}  // namespace
