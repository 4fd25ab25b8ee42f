// How loads changed over the last steps: the guess by it, and that a failed step leaves it as it was.

#include "examples/scenes/net.h"
#include "tests/integrators/same_run.h"
#include "tests/integrators/throws.h"

#include <carom/core/assembly.h>
#include <carom/core/whole_file.h>
#include <carom/integrators/run/load_history.h>

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;

/// Loads of two freedoms after n steps, whose differences have no rounding.
std::vector<double> cubic(int n) { return {1.0 * n * n * n, 7.0 - 2.0 * n * n * n}; }

constexpr double step = 0.25;

/// History of steps 0 to `steps`.
LoadHistory seen(int steps) {
  LoadHistory history;
  for (int n = 1; n <= steps; ++n) {
    history.go_on(step, 2);
    history.record_change({0, 2}, cubic(n - 1).data(), cubic(n).data());
    history.pending = false;
  }
  return history;
}

std::vector<double> guessed(const LoadHistory& history, int steps, double next_step) {
  std::vector<double> guess(2);
  history.guess({0, 2}, next_step, cubic(steps).data(), guess.data());
  return guess;
}

TEST(LoadHistory, GuessesByThePolynomialThroughWhatItKnows) {
  EXPECT_EQ(guessed(seen(0), 0, step), cubic(0)) << "nothing known";
  EXPECT_EQ(guessed(seen(1), 1, step)[0], 2.0) << "0, 1";
  EXPECT_EQ(guessed(seen(2), 2, step)[0], 21.0) << "0, 1, 8: 8 + 7 + 6";
  for (const int steps : {3, 4, 10}) {
    EXPECT_EQ(seen(steps).known, 3);
    EXPECT_EQ(guessed(seen(steps), steps, step), cubic(steps + 1)) << steps;
  }
}

TEST(LoadHistory, OfStepsOfAnotherLengthTheLastIsUsed) {
  const LoadHistory history = seen(4);
  EXPECT_EQ(guessed(history, 4, 2.0 * step)[0], 64.0 + 2.0 * 37.0);
  EXPECT_EQ(guessed(history, 4, 0.5 * step)[0], 64.0 + 0.5 * 37.0);
  EXPECT_EQ(guessed(history, 4, 10.5 * step), cubic(4)) << "too far for two near values";
  LoadHistory other = history;
  other.go_on(2.0 * step, 2);
  EXPECT_EQ(other.known, 1);
  EXPECT_TRUE(other.pending);
}

TEST(LoadHistory, WhatFloatsCannotHoldIsGuessedAsItIs) {
  LoadHistory history;
  history.go_on(step, 3);
  const std::vector<double> then{0.0, 0.0, 1.0}, now{1e39, -1e39, 3.0};
  history.record_change({0, 3}, then.data(), now.data());
  EXPECT_EQ(history.changes[0], (std::vector<float>{0.0F, 0.0F, 2.0F}));
}

/// A net that draws together, pushed by a force that can be broken from outside.
struct Pushed {
  Pushed(int k, TimeStepping options) : simulation(scene(k, broken_after), options) {}
  static System scene(int k, const double& broken_after) {
    System system;
    // Components that are done, and that are not begun, when that of the net fails.
    const auto add_pair = [&system](double x) {
      const BodyId left = system.add(Particle{.mass = 1.0, .position = {x, 50.0}, .velocity = {0.3, 1.0}});
      const BodyId right = system.add(Particle{.mass = 1.0, .position = {x + 1.0, 50.0}});
      system.add(
          SpringDamper{.from = left, .to = right, .stiffness = 1e4, .damping = 1.0, .free_length = 0.9});
    };
    add_pair(-100.0);
    scenes::add_net(system, {.k = k, .prestress = 0.01, .height = 10.0});
    const BodyId last = Assembly(system).layout()->id(static_cast<Index>(k * k + 1));
    add_pair(-200.0);
    const auto push = [&broken_after](double time) {
      return Vec<2>(time > broken_after ? std::numeric_limits<double>::quiet_NaN() : 300.0 * time, 0.0);
    };
    system.add(AppliedForce{.on = last, .force = push}, "push");
    return system;
  }
  void fail() {
    broken_after = simulation.state().time;
    EXPECT_THROWS(SolverError, simulation.step(), "'push'");
    broken_after = never;
  }

  static constexpr double never = std::numeric_limits<double>::infinity();
  double broken_after = never;
  Simulation simulation;
};

TEST(LoadHistory, AFailedStepLeavesItAsItWas) {
  // Small nets are one block, large ones several.
  for (const int k : {4, 40}) {
    for (const Iteration iteration :
         {Iteration::fixed_point, Iteration::anderson, Iteration::linearly_implicit}) {
      if (k > 4 && iteration == Iteration::linearly_implicit) continue;  // a matrix of thousands of rows
      for (const ForceRule rule : {ForceRule::trapezoidal, ForceRule::energy_momentum}) {
        SCOPED_TRACE(std::to_string(k) + " " + std::string(to_string(iteration)) + " " +
                     std::string(to_string(rule)));
        const TimeStepping options{
            .step = 1e-4, .tolerance = 1e-10, .force_rule = rule, .iteration = iteration};
        Pushed whole(k, options), failing(k, options);
        for (int i = 0; i < 12; ++i) {
          whole.simulation.step();
          if (i != 1) failing.fail();
          if (i == 8) failing.fail();
          failing.simulation.step();
          ASSERT_EQ(failing.simulation.report().sweeps, whole.simulation.report().sweeps) << i;
        }
        EXPECT_EQ(carom_test::bits_of(failing.simulation), carom_test::bits_of(whole.simulation));
      }
    }
  }
}

TEST(LoadHistory, CheckpointsAreTheSameWithAndWithoutAFailedStep) {
  const std::string path =
      (std::filesystem::path(testing::TempDir()) / "carom_load_history.checkpoint").string();
  Pushed run(40, {.step = 1e-4, .tolerance = 1e-10});
  for (int i = 0; i < 5; ++i) {
    const auto saved = [&] {
      run.simulation.save(path);
      return read_file(path, "checkpoint");
    };
    const std::string before = saved();
    run.fail();
    EXPECT_EQ(saved() == before, true) << i;
    run.simulation.step();
  }
  std::filesystem::remove(path);
}

}  // namespace
