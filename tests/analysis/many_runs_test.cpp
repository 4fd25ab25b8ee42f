// Many runs on several threads: the same bits for any number of them, and what some of them throw.

#include "tests/integrators/throws.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;

/// A ball that is thrown at a floor, of which each run has another one.
System thrown(std::size_t run) {
  System system;
  system.add(Gravity{{0.0, -9.81}});
  system.add(HalfPlane{.normal = {0.0, 1.0}},
             Surface{.friction = 0.3, .normal_restitution = 0.001 * static_cast<double>(run)});
  const BodyId ball =
      system.add(RigidBody{.mass = disc(1.0, 0.1), .position = {0.0, 1.0}, .velocity = {1.0, 0.0}});
  system.add(Disc{.body = ball, .radius = 0.1});
  return system;
}

constexpr std::size_t runs = 400;

std::vector<double> ends_on(int threads, const Mode& mode) {
  std::vector<double> ends(3 * runs);
  const auto failures = for_each_run(runs, threads, [&](std::size_t run) {
    Simulation simulation(thrown(run), mode);
    simulation.run_until(1.0);
    const State& state = simulation.state();
    ends[3 * run] = state.q[0];
    ends[3 * run + 1] = state.q[1];
    ends[3 * run + 2] = simulation.energy().total();
  });
  EXPECT_TRUE(failures.empty());
  return ends;
}

TEST(ManyRuns, HaveTheSameBitsForAnyNumberOfThreads) {
  for (const Mode& mode : {Mode(EventDriven{}), Mode(TimeStepping{.step = 1e-2})}) {
    const std::vector<double> one = ends_on(1, mode);
    for (const int threads : {2, 4}) EXPECT_EQ(ends_on(threads, mode), one) << threads;
  }
}

TEST(ManyRuns, FailuresAreCollectedByTheirNumbers) {
  for (const int threads : {1, 3}) {
    std::vector<int> made(100, 0);
    const auto failures = for_each_run(made.size(), threads, [&](std::size_t run) {
      ++made[run];
      if (run % 30 == 7) throw std::runtime_error("run " + std::to_string(run));
      if (run == 50) throw 1;
      if (run == 60) Simulation(thrown(2000), EventDriven{});
    });
    EXPECT_EQ(made, std::vector<int>(100, 1));
    ASSERT_EQ(failures.size(), 6U);
    constexpr std::array<std::size_t, 6> expected{7, 37, 50, 60, 67, 97};
    for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(failures[i].run, expected[i]);
    EXPECT_EQ(failures[0].message, "run 7");
    EXPECT_EQ(failures[2].message, "");
    EXPECT_NE(failures[3].message.find("normal_restitution is 2"), std::string::npos);
    EXPECT_THROW(std::rethrow_exception(failures[3].thrown), ModelError);
  }
}

TEST(ManyRuns, NoneAreMadeOfNone) {
  EXPECT_TRUE(for_each_run(0, 2, [](std::size_t) { FAIL(); }).empty());
}

TEST(ManyRuns, WrongNumbersAreRefused) {
  for (const int threads : {0, -3}) {
    EXPECT_THROWS(ModelError, for_each_run(1, threads, [](std::size_t) {}), "threads is", "at least 1");
  }
}

}  // namespace
