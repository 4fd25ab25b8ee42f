#include <carom/carom.h>

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "tests/model_error.h"

namespace {

using namespace carom;
using namespace carom::planar;

System bouncing_bar() {
  System system;
  system.add(Gravity{{0.0, -9.81}});
  system.add(HalfPlane{.normal = incline(0.1)},
             Surface{.friction = 0.1, .normal_restitution = 0.7, .tangential_restitution = 0.7});
  const BodyId bar = system.add(
      RigidBody{.mass = rod(2.0, 2.0), .position = {0.0, 2.0}, .angle = 0.3, .velocity = {1.0, 0.0}});
  system.add(Segment{.body = bar, .from = {0.0, -1.0}, .to = {0.0, 1.0}});
  return system;
}

TEST(CrossCheck, SmoothMotionHasOrderTwo) {
  System system;
  const BodyId mass = system.add(Particle{.mass = 1.0, .position = {1.0, 0.5}, .velocity = {-2.0, 4.0}});
  system.add(SpringDamper{.from = {ground, {0.0, 0.0}}, .to = mass, .stiffness = 100.0, .free_length = 0.5});
  CrossCheckOptions options;
  options.end = 1.0;
  options.steps = {8e-3, 4e-3, 2e-3, 1e-3, 5e-4};
  options.event_driven.relative_tolerance = 1e-11;
  const CrossCheck check = cross_check(system, options);
  ASSERT_EQ(check.levels.size(), 5U);
  // The next term of the error is (h omega)^2, at most 0.006 of the first, and shrinks along the line.
  EXPECT_NEAR(check.position_order, 2.0, 0.01);
  EXPECT_NEAR(check.velocity_order, 2.0, 0.01);
}

TEST(CrossCheck, AcrossImpactsOrderOneInTheMean) {
  CrossCheckOptions options;
  options.end = 1.5;
  options.steps = spread_steps(8e-3, 2.5e-4, 20);
  const CrossCheck check = cross_check(bouncing_bar(), options);
  // Twenty delays of impacts that are as good as random between nothing and a step: the scatter of the slope
  // is about the scatter of a logarithm (1) over the spread of the steps (a standard deviation of 1) and
  // sqrt(20).
  EXPECT_NEAR(check.position_order, 1.0, 0.5);
  EXPECT_NEAR(check.velocity_order, 1.0, 0.5);
  EXPECT_LT(check.levels.back().position_error, 0.2 * check.levels.front().position_error);
  std::ostringstream text;
  text << check;
  EXPECT_NE(text.str().find("order observed"), std::string::npos);
}

TEST(CrossCheck, SpreadStepsFallFromTheLargest) {
  const std::vector<double> steps = spread_steps(1e-2, 1e-4, 12);
  ASSERT_EQ(steps.size(), 12U);
  EXPECT_DOUBLE_EQ(steps.front(), 1e-2);
  for (const double step : steps) {
    EXPECT_LE(step, 1e-2);
    EXPECT_GE(step, 1e-4);
  }
}

TEST(CrossCheck, RefusesWhatCannotBe) {
  CrossCheckOptions options;
  options.end = 1.0;
  options.steps = {1e-2, 5e-3, 2e-3, 1e-3};
  const auto run = [&] { (void)cross_check(bouncing_bar(), options); };
  EXPECT_MODEL_ERROR(run(), "the number of steps is 4");
  options.steps.push_back(2.0);
  EXPECT_MODEL_ERROR(run(), "a step is 2");
  options.steps.back() = 5e-4;
  options.time_stepping.control = StepControl{};
  EXPECT_MODEL_ERROR(run(), "time_stepping.control");
  options.time_stepping.control.reset();
  options.end = std::nan("");
  EXPECT_MODEL_ERROR(run(), "end is nan");
  EXPECT_MODEL_ERROR((void)spread_steps(1e-3, 1e-2, 5), "the range of steps");
}

}  // namespace
