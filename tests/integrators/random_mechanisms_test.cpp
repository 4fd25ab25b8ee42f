// Random mechanisms without contact: event-driven runs keep their joints and their account, time stepping
// converges to them with order two.

#include "tests/integrators/random_mechanisms.h"
#include "tests/integrators/joint_run.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <string>

namespace {

using namespace joint_scenes;

/// Largest difference of the coordinates.
double difference(const State& a, const State& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.q.size(); ++i) largest = std::max(largest, std::abs(a.q[i] - b.q[i]));
  return largest;
}

void both_modes(const Scene& scene, const std::string& name) {
  SCOPED_TRACE(name);
  const double early = 0.3;
  try {
    WatchedRun run(scene, {.relative_tolerance = 1e-10, .absolute_tolerance = 1e-10});
    run.simulation.run_until(early);
    const State exact = run.simulation.state();
    run.simulation.run_until(1.0);
    // Errors are a series in h^2: their ratio is 4 but for the second term, which seldom matters at once, and
    // for the exact run's error.
    double error = 0.0, ratio = 0.0, step = 5e-4;
    for (int halving = 0; halving < 5; ++halving, step *= 0.5) {
      Simulation stepping(scene.system, TimeStepping{.step = step});
      stepping.run_until(early);
      const double before = error;
      error = difference(stepping.state(), exact);
      ratio = before / error;
      if (std::abs(ratio - 4.0) <= 0.2 || error <= 1e-8) break;
    }
    carom_test::note(name + " ratio", ratio);
    carom_test::note(name + " step", step);
    if (error > 1e-8) {
      EXPECT_NEAR(ratio, 4.0, 0.2);
    }
  } catch (const std::exception& error) {
    ADD_FAILURE() << error.what();
  }
}

void trees(std::uint64_t first, std::uint64_t last) {
  for (std::uint64_t seed = first; seed < last; ++seed)
    both_modes(random_tree(seed), "tree " + std::to_string(seed));
}
void loops(std::uint64_t first, std::uint64_t last) {
  for (std::uint64_t seed = first; seed < last; ++seed)
    both_modes(random_loop(seed), "loop " + std::to_string(seed));
}

TEST(RandomMechanisms, Trees) { trees(0, 10); }
TEST(RandomMechanisms, Loops) { loops(0, 8); }
TEST(RandomMechanismsLong, Trees) { trees(10, 100); }
TEST(RandomMechanismsLong, Loops) { loops(8, 40); }

}  // namespace
