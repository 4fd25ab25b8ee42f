#include <carom/integrators/step_grid.h>

#include "tests/model_error.h"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace carom;

TEST(StepGrid, IsThatOfTheMode) {
  Companion companion;
  companion.grid_start = 1.0;
  companion.grid_steps = 3;
  const Mode stepping = TimeStepping{.step = 0.5};
  EXPECT_EQ(StepGrid(stepping).length(), 0.5);
  EXPECT_EQ(StepGrid(stepping).next(companion), 3.0);
  const Mode events = EventDriven{.interval = 0.25};
  EXPECT_EQ(StepGrid(events).length(), 0.25);
  EXPECT_EQ(StepGrid(events).next(companion), 2.0);
  EXPECT_LT(StepGrid(events).closeness(1.0), StepGrid(stepping).closeness(1.0));
}

TEST(StepGrid, BeginsAnewBesideItsTimes) {
  const Mode mode = TimeStepping{.step = 0.5};
  Companion companion;
  companion.grid_steps = 3;
  StepGrid(mode).match(companion, 1.5);
  EXPECT_EQ(companion.grid_steps, 3);
  StepGrid(mode).match(companion, 1.6);
  EXPECT_EQ(companion.grid_start, 1.6);
  EXPECT_EQ(companion.grid_steps, 0);
}

TEST(StepGrid, SkipsToOneOfItsTimes) {
  const Mode mode = EventDriven{.interval = 0.1};
  Companion companion;
  companion.grid_start = 1.0;
  StepGrid(mode).skip_to(companion, 1.7);
  EXPECT_EQ(companion.grid_start, 1.0);
  EXPECT_EQ(companion.grid_steps, 7);
  StepGrid(mode).skip_to(companion, 1.75);
  EXPECT_EQ(companion.grid_start, 1.75);
  EXPECT_EQ(companion.grid_steps, 0);
}

TEST(StepGrid, PeriodicEventsComeInTheirRhythm) {
  Companion companion;
  EXPECT_TRUE(std::isinf(next_due(companion)));
  companion.rhythms = {{0.0, 1.0, 0}, {0.0, 0.3, 0}};
  EXPECT_EQ(next_due(companion), 0.3);
  skip_events(companion, 2.05);
  EXPECT_EQ(companion.rhythms[0].fired, 2);
  EXPECT_EQ(companion.rhythms[1].fired, 6);
  skip_events(companion, -1.0);
  EXPECT_EQ(companion.rhythms[0].fired, 0);
}

TEST(StepGrid, RefusesTimesThatDoNotMove) {
  const Mode mode = TimeStepping{.step = 1e-3};
  const Companion companion;
  EXPECT_NO_THROW(StepGrid(mode).demand_times("step", 1.0, companion, 1.0));
  EXPECT_MODEL_ERROR(StepGrid(mode).demand_times("step", 1e15, companion, 1e15), "step: step is 0.001");
  EXPECT_MODEL_ERROR(StepGrid(mode).demand_interval(-1.0, 0.0), "every: interval is -1");
  EXPECT_MODEL_ERROR(StepGrid(mode).demand_interval(1e-15, 0.0), "every: interval");
}

}  // namespace
