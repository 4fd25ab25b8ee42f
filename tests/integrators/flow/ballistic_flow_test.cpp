// A flight at constant acceleration is its parabola to rounding, however long the steps, whatever the method
// of the run, and for one evaluation.

#include <carom/core/errors.h>
#include <carom/integrators/flow/ballistic_flow.h>

#include "tests/allocation_counter.h"
#include "tests/integrators/event_runs.h"
#include "tests/integrators/flow_problems.h"

#include <carom/carom.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using flow_problems::Function;
using flow_problems::go_to;
using flow_problems::Problem;

constexpr double epsilon = std::numeric_limits<double>::epsilon();

// q, v and the work of a constant power.
struct Flight final : Problem {
  explicit Flight(double a = -9.81)
      : Problem(3, 1e-8, [a](double, const double* y, double* rates) {
          rates[0] = y[1];
          rates[1] = a;
          rates[2] = 2.0;
        }) {}
  [[nodiscard]] std::size_t integrals() const override { return 1; }
  [[nodiscard]] bool is_ballistic() const override { return true; }
};

std::array<double, 3> thrown(double t) { return {1.0 + t * (3.0 - 0.5 * 9.81 * t), 3.0 - 9.81 * t, 2.0 * t}; }

void expect_thrown(std::span<const double> y, double t) {
  // Terms of 50 at t = 3, each rounded in each of a few steps.
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(y[i], thrown(t)[i], 500.0 * epsilon) << i << " at " << t;
}

constexpr std::array<double, 3> start{1.0, 3.0, 0.0};

TEST(BallisticFlow, IsTheParabolaForOneEvaluation) {
  Flight flight;
  const std::unique_ptr<Flow> flow = make_flow(FlowMethod::bdf, flight, 1e-3);
  flow->start(0.0, start, 0.0);
  std::array<double, 3> y{};
  for (const double until : {1e-9, 0.5, 3.0}) {
    const double begin = flow->end();
    flow->advance(until - begin);
    EXPECT_EQ(flow->begin(), begin);
    EXPECT_EQ(flow->end(), until);
    expect_thrown(flow->state(), until);
    for (const double part : {0.0, 0.3, 1.0}) {
      const double time = part == 1.0 ? until : begin + part * (until - begin);
      flow->sample(time, y);
      expect_thrown(y, time);
      flow->land(time, y);
      expect_thrown(y, time);
    }
  }
  EXPECT_EQ(flight.evaluations, 1);
  EXPECT_EQ(flow->counts().evaluations, 1);
  EXPECT_EQ(flow->counts().steps, 3);
  EXPECT_EQ(flow->counts().restarts, 1);
}

TEST(BallisticFlow, GoesOnFromACorrection) {
  Flight flight;
  BallisticFlow flow(flight, 1e-3);
  flow.start(0.0, start, 0.0);
  flow.advance(1.0);
  flow.correct(std::array{2.0, 1.0, 0.0});
  EXPECT_EQ(flow.begin(), 1.0);
  EXPECT_EQ(flow.end(), 1.0);
  flow.advance(0.5);
  EXPECT_NEAR(flow.state()[0], 2.0 + 0.5 - 0.125 * 9.81, 4.0 * epsilon);
  EXPECT_NEAR(flow.state()[1], 1.0 - 0.5 * 9.81, 4.0 * epsilon);
}

TEST(BallisticFlow, LeftStepsAreTakenUpBitForBit) {
  Flight flight;
  BallisticFlow one(flight, 1e-3), other(flight, 1e-3);
  FlowStep left;
  EXPECT_FALSE(one.leave(left));
  one.start(0.0, start, 0.0);
  one.advance(0.7);
  ASSERT_TRUE(one.leave(left));
  other.resume(left);
  std::array<double, 3> a{}, b{};
  one.land(0.31, a);
  other.land(0.31, b);
  EXPECT_EQ(a, b);
  one.advance(0.9);
  other.advance(0.9);
  EXPECT_EQ(std::vector(one.state().begin(), one.state().end()),
            std::vector(other.state().begin(), other.state().end()));
  left.numbers.pop_back();
  EXPECT_THROW(other.resume(left), ModelError);
}

TEST(BallisticFlow, NamesWhatIsWrongAndKeepsTheLastState) {
  Flight undefined(std::nan(""));
  BallisticFlow flow(undefined, 1e-3);
  EXPECT_THROW(flow.advance(1.0), ModelError);
  flow.start(0.0, start, 0.0);
  EXPECT_THROW(flow.advance(0.0), ModelError);
  try {
    flow.advance(1.0);
    FAIL() << "the rates are not finite";
  } catch (const SolverError& error) {
    EXPECT_NE(std::string(error.what()).find("the rates are not finite at t = 0 s"), std::string::npos);
  }
  EXPECT_EQ(std::vector(flow.state().begin(), flow.state().end()), std::vector(start.begin(), start.end()));
  EXPECT_THROW(flow.advance(1.0), ModelError);  // needs a start

  Flight flight;
  flow.bind(flight);
  flow.start(1e16, start, 0.0);
  EXPECT_THROW(flow.advance(0.1), SolverError);  // below the rounding of time
  Problem larger(4, 1e-8, Function{});
  EXPECT_THROW(flow.bind(larger), ModelError);
  EXPECT_THROW(BallisticFlow(flight, 0.0), ModelError);
}

TEST(BallisticFlow, TakesNoMemory) {
  Flight flight;
  BallisticFlow flow(flight, 1e-3);
  FlowStep left;
  flow.start(0.0, start, 0.0);
  ASSERT_TRUE(flow.leave(left));
  const auto before = carom_test::allocations();
  for (int i = 0; i < 100; ++i) {
    flow.start(0.0, start, 0.0);
    go_to(flow, 1.0);
    ASSERT_TRUE(flow.leave(left));
    flow.resume(left);
  }
  EXPECT_EQ(carom_test::allocations(), before);
}

System ball_over_floor(bool in_air) {
  System system;
  system.add(Gravity{{0.0, -9.81}});
  system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = 0.0, .normal_restitution = 1.0});
  const BodyId ball = system.add(
      RigidBody{.mass = disc(1.0, 0.1), .position = {0.0, 1.1}, .velocity = {0.5, 0.0}, .spin = 2.0});
  system.add(Disc{.body = ball, .radius = 0.1});
  if (in_air) system.add(Drag{.on = ball, .linear = 1e-300});
  return system;
}

TEST(BallisticFlow, ServesARunOfEveryMethod) {
  // Falls from 1 m: the fourth impact is after seven times that of the first.
  const double fall = std::sqrt(2.0 / 9.81);
  for (const FlowMethod method : carom_test::flow_methods) {
    Simulation free(ball_over_floor(false), EventDriven{.method = method});
    free.run_until(3.5);
    ASSERT_EQ(free.statistics().impacts, 4);
    // Each impact is located to rounding: errors of an elastic ball add up once per impact.
    EXPECT_NEAR(free.events().back().time, 7.0 * fall, 64.0 * epsilon);
    EXPECT_LE(free.statistics().flow_evaluations, 5);
    EXPECT_NEAR(free.energy().residual(), 0.0, 64.0 * epsilon * free.energy().scale());
  }
}

TEST(BallisticFlow, IsLeftToMethodsWhereAnElementActs) {
  Simulation slowed(ball_over_floor(true), EventDriven{});
  slowed.run_until(3.5);
  EXPECT_EQ(slowed.statistics().impacts, 4);
  EXPECT_GT(slowed.statistics().flow_evaluations, 40);
}

}  // namespace
