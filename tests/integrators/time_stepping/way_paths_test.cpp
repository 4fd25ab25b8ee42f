// The way of a step as paths: one where nothing is hit, chords between impacts where a body is.

#include "tests/contact/detection/moved_model.h"

#include <carom/carom.h>
#include <carom/integrators/time_stepping/time_stepper.h>
#include <carom/integrators/time_stepping/way_paths.h>

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::MovedModel;
using Form = WayPaths::Form;

constexpr double rounding = 1e-13;  // numbers of about 1
constexpr double g = 9.81;

/// Two discs over a floor, which they alone touch.
System discs_over_a_floor(double height, double restitution) {
  System system;
  const MaterialId floor = system.material("floor"), thing = system.material("thing");
  system.between(floor, thing, {.friction = 0.0, .normal_restitution = restitution});
  system.add(Gravity{.acceleration = {0.0, -g}});
  system.add(HalfPlane{.normal = {0.0, 1.0}, .material = floor});
  for (const double more : {0.0, 5.0}) {
    const BodyId body = system.add(RigidBody{
        .mass = disc(1.0, 0.1), .position = {more, height + more}, .velocity = {1.5, -2.0}, .spin = 3.0});
    system.add(Disc{.body = body, .radius = 0.1, .material = thing});
  }
  return system;
}

MovedModel falling() { return {discs_over_a_floor(3.0, 0.5), 0.2, {0.0, -g, 0.0, 0.0, -g, 0.0}, 1.0}; }

TEST(WayPaths, OnWhichNothingIsHitAreOne) {
  MovedModel model = falling();
  StepFlights none_hit;
  WayPaths paths(model.assembly, model.detector);
  for (const Form form : {Form::chord, Form::parabola, Form::chord}) {
    paths.begin({model.start, model.end, model.start.v, none_hit, {}}, form);
    ASSERT_TRUE(paths.next());
    EXPECT_EQ(paths.path().begin().state.time, model.start.time);
    EXPECT_EQ(paths.path().end().state.time, model.end.time);
    EXPECT_EQ(&paths.whole(), &paths.path());
    EXPECT_FALSE(paths.next());
  }
}

TEST(WayPaths, AreParabolasOrChordsAsAsked) {
  MovedModel model = falling();
  StepFlights none_hit;
  WayPaths paths(model.assembly, model.detector);
  const StepWay way{model.start, model.end, model.start.v, none_hit, {}};
  const std::vector<Index> watched{0, 1};
  for (const Form form : {Form::chord, Form::parabola}) {
    paths.begin(way, form);
    ASSERT_TRUE(paths.next());
    paths.path().watch(watched);
    const PathSample middle = paths.path().sample(1.1, PathLook::exact);
    const State exact = model.at(1.1);
    // The chord is g h^2/8 below the parabola in the middle.
    const double below = form == Form::chord ? g * 0.2 * 0.2 / 8.0 : 0.0;
    for (const std::size_t body : {0U, 3U}) {
      EXPECT_NEAR(middle.state.q[body], exact.q[body], rounding);
      EXPECT_NEAR(middle.state.q[body + 1], exact.q[body + 1] - below, rounding);
      EXPECT_NEAR(middle.state.v[body + 1], exact.v[body + 1], rounding);  // the mean of both ends
      EXPECT_NEAR(paths.path().begin().acceleration[body + 1], form == Form::chord ? 0.0 : -g, 1e-11);
    }
  }
}

// A parabola leaves with the velocities behind impacts at the start, not with those before them.
TEST(WayPaths, BeginBehindImpactsAtTheStart) {
  MovedModel model = falling();
  const std::vector<double> after = model.start.v;
  for (double& v : model.start.v) v = -3.0 * v;
  StepFlights none_hit;
  WayPaths paths(model.assembly, model.detector);
  paths.begin({model.start, model.end, after, none_hit, {}}, Form::parabola);
  ASSERT_TRUE(paths.next());
  for (std::size_t i = 0; i < after.size(); ++i) {
    EXPECT_NEAR(paths.path().begin().state.v[i], after[i], rounding) << i;
    EXPECT_NEAR(paths.path().end().state.v[i], model.end.v[i], rounding) << i;
  }
}

/// One step of the discs.
struct SteppedDiscs {
  SteppedDiscs(double height, double restitution, double step)
      : assembly(discs_over_a_floor(height, restitution)),
        stepper(assembly, {.step = step, .impacts = ImpactTimes::located}),
        start(assembly.initial_state()),
        end(start) {
    Companion companion;
    companion.rounding.assign(start.v.size(), 0.0F);
    StepReport report;
    stepper.step(end, companion, step, step, report);
  }
  [[nodiscard]] StepFlights& flights() { return *stepper.last().flights; }
  [[nodiscard]] StepWay way() { return {start, end, start.v, flights(), {}}; }
  Assembly assembly;
  TimeStepper stepper;
  State start, end;
};

// One step in which the lower disc comes down on the floor and goes up again.
TEST(WayPaths, OnWhichABodyIsHitAreItsFlights) {
  constexpr double step = 0.2, height = 0.4, restitution = 0.5, radius = 0.1;
  SteppedDiscs discs(height, restitution, step);
  ASSERT_FALSE(discs.flights().empty());

  const double hit = (-2.0 + std::sqrt(4.0 + 2.0 * g * (height - radius))) / g, rest = step - hit;
  const double up = restitution * (2.0 + g * hit);
  WayPaths paths(discs.assembly, discs.stepper.detector());
  paths.begin(discs.way(), Form::parabola);
  ASSERT_TRUE(paths.next());
  // The impact is located to the tolerance of the step.
  constexpr double located = 1e-10;
  EXPECT_EQ(paths.path().begin().state.time, 0.0);
  EXPECT_NEAR(paths.path().end().state.time, hit, located);
  EXPECT_NEAR(paths.path().end().state.q[1], radius, located);
  EXPECT_NEAR(paths.path().end().state.q[0], 1.5 * hit, located);
  EXPECT_NEAR(paths.path().begin().state.v[1], -2.0, located);
  EXPECT_NEAR(paths.path().end().state.v[1], -2.0 - g * hit, located);
  // The other one flies on.
  EXPECT_NEAR(paths.path().end().state.q[4], 5.0 + height - 2.0 * hit - 0.5 * g * hit * hit, located);
  EXPECT_NEAR(paths.path().end().state.v[4], -2.0 - g * hit, located);
  EXPECT_NEAR(paths.path().begin().acceleration[1], -g, located);
  ASSERT_TRUE(paths.next());
  EXPECT_NEAR(paths.path().begin().state.time, hit, located);
  EXPECT_EQ(paths.path().end().state.time, step);
  EXPECT_NEAR(paths.path().begin().state.v[1], up, 10.0 * located);
  EXPECT_NEAR(paths.path().end().state.v[1], up - g * rest, 10.0 * located);
  EXPECT_NEAR(paths.path().begin().state.v[4], -2.0 - g * hit, 10.0 * located);
  EXPECT_FALSE(paths.next());
}

TEST(WayPaths, TheWholeOneEndsAsTheWayDoes) {
  constexpr double step = 0.2;
  SteppedDiscs discs(0.4, 0.5, step);
  WayPaths paths(discs.assembly, discs.stepper.detector());
  paths.begin(discs.way(), Form::parabola);
  int count = 0;
  while (paths.next()) {
    ++count;
    EXPECT_NE(&paths.whole(), &paths.path());
    EXPECT_EQ(paths.whole().end().state.time, step);
    for (std::size_t i = 0; i < discs.end.q.size(); ++i)
      EXPECT_EQ(paths.whole().end().state.q[i], discs.end.q[i]);
    // Of 10 m/s, from displacements over the length.
    for (std::size_t i = 0; i < discs.end.v.size(); ++i)
      EXPECT_NEAR(paths.whole().end().state.v[i], discs.end.v[i], 1e-13);
  }
  EXPECT_EQ(count, 2);
}

}  // namespace
