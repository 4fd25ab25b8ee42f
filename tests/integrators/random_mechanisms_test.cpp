// Random mechanisms without contact: event-driven runs keep their joints and their ledger, time stepping
// converges to them with order two.

#include "tests/integrators/random_mechanisms.h"
#include "tests/energy/ledger_check.h"
#include "tests/integrators/joint_run.h"
#include "tests/shares.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
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

const EventDriven exact_run{.relative_tolerance = 1e-10, .absolute_tolerance = 1e-10};

/// How long runs may be compared: up to the time at which a change of 1e-12 at the start has grown to 1e-6,
/// at most 1 s. Behind it a run tells no more than its rounding.
double comparable_time(const Scene& scene) {
  constexpr double change = 1e-12, grown = 1e-6;
  constexpr int looks = 20;
  Simulation one(scene.system, exact_run), other(scene.system, exact_run);
  State state = other.state();
  for (double& spin : state.v) spin *= 1.0 + change;
  state.v[2] += change;  // where all are at rest
  other.set_state(state);
  for (int look = 1; look < looks; ++look) {
    const double time = look / static_cast<double>(looks);
    one.run_until(time);
    other.run_until(time);
    if (difference(one.state(), other.state()) >= grown) return time;
  }
  return 1.0;
}

void both_modes(const Scene& scene, const std::string& name) {
  SCOPED_TRACE(name);
  try {
    const double compared = comparable_time(scene);
    carom_test::note(name + " compared until", compared);
    WatchedRun run(scene, exact_run);
    run.simulation.run_until(compared);
    const State exact = run.simulation.state();
    run.simulation.run_until(1.0);
    // Errors are a series in h^2: their ratio is 4 but for the second term, which seldom matters at once, and
    // for the exact run's error.
    double error = 0.0, ratio = 0.0, step = 5e-4;
    for (int halving = 0; halving < 8; ++halving, step *= 0.5) {
      Simulation stepping(scene.system, TimeStepping{.step = step});
      stepping.run_until(compared);
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

void trees(const carom_test::SeedRange& seeds) {
  for (std::uint64_t seed = seeds.first; seed < seeds.last; ++seed)
    both_modes(random_tree(seed), "tree " + std::to_string(seed));
}
void loops(const carom_test::SeedRange& seeds) {
  for (std::uint64_t seed = seeds.first; seed < seeds.last; ++seed)
    both_modes(random_loop(seed), "loop " + std::to_string(seed));
}

/// Friction turns round somewhere within a step: errors are of order 1 in the mean over many steps.
void rubbing(const carom_test::SeedRange& seeds) {
  constexpr double compared = 0.3, coarse = 4e-4, fine_step = 5e-5;
  double logarithm = 0.0;
  int counted = 0;
  for (std::uint64_t seed = seeds.first; seed < seeds.last; ++seed) {
    SCOPED_TRACE("rubbing tree " + std::to_string(seed));
    try {
      const Scene scene = rubbing_tree(seed);
      WatchedRun run(scene, exact_run);
      run.simulation.run_until(compared);
      const State exact = run.simulation.state();
      run.simulation.run_until(1.0);
      const auto mean_error = [&](double step) {
        double sum = 0.0;
        for (const double factor : {1.0, 0.93, 0.87, 0.81}) {
          Simulation stepping(scene.system, TimeStepping{.step = factor * step});
          JointCheck check(stepping);
          stepping.run_until(compared);
          EXPECT_LE(check.gap, gap_limit);
          EXPECT_LE(check.speed, speed_limit);
          EXPECT_TRUE(carom_test::ledger_closes(stepping.energy()));
          sum += difference(stepping.state(), exact);
        }
        return sum;
      };
      const double error = mean_error(coarse), finer = mean_error(fine_step);
      if (!(finer > 1e-8)) continue;  // all stuck: the exact run's error is left
      logarithm += std::log(error / finer);
      ++counted;
    } catch (const std::exception& error) {
      ADD_FAILURE() << error.what();
    }
  }
  const double order = logarithm / counted / std::log(coarse / fine_step);
  carom_test::note("rubbing trees, mean order", order);
  EXPECT_GT(order, 0.9);
}

TEST(RandomMechanisms, Trees) { trees({0, 4}); }
TEST(RandomMechanisms, Loops) { loops({0, 4}); }

// All seeds (shares.h) take some minutes.
TEST(RandomMechanismsLong, Trees) { trees(carom_test::seeds_from(4, 56, 496)); }
TEST(RandomMechanismsLong, TreesThatRub) { rubbing(carom_test::seeds_from(0, 15, 200)); }
TEST(RandomMechanismsLong, Loops) { loops(carom_test::seeds_from(4, 20, 196)); }

}  // namespace
