#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <sstream>
#include <string>
#include <vector>

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

// Order one, but for two of the steps that go another way: what a lost contact looked like.
TEST(CrossCheck, OutliersStandOutOfAnyLine) {
  for (const double order : {1.0, 2.0}) {
    std::vector<CrossCheckLevel> levels;
    int number = 0;
    for (const double step : spread_steps(1e-3, 1e-5, 20)) {
      const double scatter = ++number % 3 == 0 ? 0.4 : number % 3 == 1 ? 1.0 : 1.9;
      levels.push_back({.step = step, .position_error = 3.0 * scatter * std::pow(step, order)});
    }
    EXPECT_TRUE(find_outliers(levels).empty());
    for (const std::size_t lost : {4U, 9U, 11U, 17U}) levels[lost].position_error = 0.05;
    const std::vector<CrossCheckOutlier> outliers = find_outliers(levels);
    ASSERT_EQ(outliers.size(), 4U);
    EXPECT_EQ(outliers[0].level.step, levels[17].step);  // the smallest error was expected there
    EXPECT_EQ(outliers[3].level.step, levels[4].step);
    EXPECT_LT(outliers[0].expected, 10.0 * std::pow(levels[17].step, order));
  }
  EXPECT_TRUE(find_outliers({}).empty());
  EXPECT_TRUE(find_outliers({{.step = 1e-3, .position_error = 1.0}}).empty());
}

// A push shorter than the steps, which one of the step lengths meets: too hard then, and not at all else.
TEST(CrossCheck, NamesTheStepThatGoesAstrayAndTheBody) {
  constexpr double time = 0.102, width = 1e-4;  // within 10 us of 96 steps of 1.063 ms
  System system;
  system.add(Particle{.mass = 1.0, .velocity = {1.0, 0.0}}, "calm");
  const BodyId pushed = system.add(Particle{.mass = 1.0, .position = {0.0, 1.0}}, "pushed");
  const auto push = [](double t) { return Vec<2>(std::max(0.0, 1.0 - std::abs(t - time) / width), 0.0); };
  system.add(AppliedForce{.on = pushed, .force = push, .breaks = {time - width, time, time + width}});
  CrossCheckOptions options;
  options.end = 0.2;
  options.steps = spread_steps(4e-3, 1e-3, 10);
  const CrossCheck check = cross_check(system, options);
  ASSERT_EQ(check.outliers.size(), 1U);
  EXPECT_EQ(check.outliers[0].level.step, options.steps[9]);
  EXPECT_EQ(check.outliers[0].level.body, "particle 'pushed'");
  EXPECT_EQ(check.probes.size(), 15U);  // the sixteenth is the largest step itself
  std::ostringstream text;
  text << check;
  EXPECT_NE(text.str().find("outliers: 1 of 25 steps"), std::string::npos) << text.str();
  EXPECT_NE(text.str().find("particle 'pushed'"), std::string::npos) << text.str();
}

TEST(CrossCheck, NoOutlierWhereABoxFallsFromItsCorner) {
  System system;
  system.add(Gravity{{0.0, -9.81}});
  system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = 0.0, .normal_restitution = 0.6});
  const double angle = 0.3;
  const BodyId body = system.add(RigidBody{.mass = box(1.0, 1.2, 0.6),
                                           .position = {0.0, 0.6 * std::sin(angle) + 0.3 * std::cos(angle)},
                                           .angle = angle});
  system.add(Polygon{.body = body, .vertices = {{-0.6, -0.3}, {0.6, -0.3}, {0.6, 0.3}, {-0.6, 0.3}}});
  CrossCheckOptions options;
  options.end = 0.45;
  options.steps = spread_steps(1e-3, 2e-4, 8);
  const CrossCheck check = cross_check(system, options);
  EXPECT_TRUE(check.outliers.empty());
  EXPECT_GT(check.position_order, 0.7);
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
  options.probes = -1;
  EXPECT_MODEL_ERROR(run(), "probes is -1");
  options.probes = 2'000'000'000;
  EXPECT_MODEL_ERROR(run(), "probes is 2000000000; allowed: 0 to 100000");
  EXPECT_MODEL_ERROR((void)spread_steps(1.0, 0.1, 2'000'000'000), "number of steps is 2000000000");
  options.probes = 0;
  options.end = std::nan("");
  EXPECT_MODEL_ERROR(run(), "end is nan");
  EXPECT_MODEL_ERROR((void)spread_steps(1e-3, 1e-2, 5), "the range of steps");
}

}  // namespace
