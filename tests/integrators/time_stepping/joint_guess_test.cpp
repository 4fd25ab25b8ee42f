// Steps of mechanisms in the air begin with a guess by the steps before: it costs one sweep or two, changes
// nothing but rounding, continues from checkpoints (of earlier versions too), survives failed steps, and
// allocates nothing.

#include "tests/allocation_counter.h"
#include "tests/integrators/same_run.h"
#include "tests/integrators/throws.h"
#include "tests/paths.h"
#include "tests/temporary_folder.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::bits_of;

constexpr double never = std::numeric_limits<double>::infinity();

/// Rods of 1 m and 1 kg, pinned to the origin and to each other, released level.
System chain(int rods, const double& broken_after = never) {
  System system;
  system.add(Gravity{{0.0, -9.81}});
  BodyId before = ground;
  for (int i = 0; i < rods; ++i) {
    const BodyId body = system.add(RigidBody{.mass = rod(1.0, 1.0), .position = {i + 0.5, 0.0}});
    const End<2> end = i == 0 ? End<2>(ground) : End<2>(before, {0.5, 0.0});
    system.add(Revolute{.from = end, .to = {body, {-0.5, 0.0}}});
    before = body;
  }
  const auto push = [&broken_after](double time) {
    return Vec<2>(time > broken_after ? std::numeric_limits<double>::quiet_NaN() : std::sin(time), 0.0);
  };
  system.add(AppliedForce{.on = before, .force = push}, "push");
  return system;
}

const TimeStepping options{.step = 1e-3, .tolerance = 1e-10};

TEST(JointGuess, StepsNeedOneSweepOrTwo) {
  for (const int rods : {1, 10}) {
    Simulation simulation(chain(rods), options);
    for (int i = 0; i < static_cast<int>(most_extrapolated); ++i) simulation.step();
    const std::int64_t sweeps = simulation.statistics().sweeps;
    for (int i = 0; i < 500; ++i) {
      simulation.step();
      ASSERT_LE(simulation.report().sweeps, 2) << i;
    }
    // Without a guess it is 6 or 7.
    EXPECT_LE(simulation.statistics().sweeps - sweeps, 600) << rods;
  }
}

// Rods in line have small pivots, the more of them the smaller, and are not near a singular position.
TEST(JointGuess, ManyRodsInLineNeedTheSweepsOfAFew) {
  const auto sweeps = [](int rods) {
    Simulation simulation(chain(rods), options);
    for (int i = 0; i < 50; ++i) simulation.step();
    return simulation.statistics().most_sweeps;
  };
  const int of_few = sweeps(10);
  EXPECT_LE(of_few, 3);
  for (const int rods : {30, 100, 300}) EXPECT_LE(sweeps(rods), of_few) << rods;
}

TEST(JointGuess, ContinuesFromACheckpointBitForBit) {
  const carom_test::TemporaryFolder folder;
  for (const int steps : {1, 3, 10, 700}) {  // with a history that is not full, and one that is
    Simulation whole(chain(6), options);
    for (int i = 0; i < steps; ++i) whole.step();
    whole.save(folder / "some");
    Simulation fresh(chain(6), options);
    fresh.load(folder / "some");
    for (int i = 0; i < 50; ++i) {
      whole.step();
      fresh.step();
      ASSERT_EQ(fresh.report().sweeps, whole.report().sweeps) << steps << " " << i;
    }
    EXPECT_EQ(bits_of(fresh), bits_of(whole)) << steps;
    whole.save(folder / "whole");
    fresh.save(folder / "fresh");
    EXPECT_EQ(folder.text_of("fresh"), folder.text_of("whole")) << steps;
  }
}

// data/chain_version_6.checkpoint is that of chain(6) at 0.3 s, as version 6 wrote it: without what joints
// did, and without large contact problems. A run from it has no guess at first, which changes nothing but
// rounding.
TEST(JointGuess, CheckpointsOfTheVersionBeforeAreRead) {
  constexpr int rods = 6;
  Simulation whole(chain(rods), options);
  whole.run_until(0.3);
  Simulation other(chain(rods), options);
  other.load(carom_test::source_file("tests/integrators/time_stepping/data/chain_version_6.checkpoint"));
  EXPECT_EQ(other.time(), whole.time());
  EXPECT_EQ(other.statistics().steps, whole.statistics().steps);
  EXPECT_EQ(other.contact_statistics().problems, 0);
  // Iterations end within rounding of the constraints, 1e-13 of numbers up to 6 m and 10 m/s, in each step;
  // that version made displacements along the joints otherwise, which are of order h^4.
  const auto expect_same = [&](double allowed) {
    for (std::size_t i = 0; i < whole.state().q.size(); ++i) {
      EXPECT_NEAR(other.state().q[i], whole.state().q[i], allowed) << i;
      EXPECT_NEAR(other.state().v[i], whole.state().v[i], 10.0 * allowed) << i;
    }
  };
  expect_same(1e-9);
  other.step();
  whole.step();
  EXPECT_LT(whole.report().sweeps, other.report().sweeps);
  for (int i = 0; i < 20; ++i) {
    other.step();
    whole.step();
  }
  expect_same(1e-9);
}

// data/chain_version_7.checkpoint is that of chain(6) at 0.3 s, as version 7 wrote it: it lacks some counts
// of the statistics only.
TEST(JointGuess, CheckpointsOfVersion7AreRead) {
  Simulation whole(chain(6), options);
  whole.run_until(0.3);
  Simulation other(chain(6), options);
  other.load(carom_test::source_file("tests/integrators/time_stepping/data/chain_version_7.checkpoint"));
  for (int i = 0; i < 20; ++i) {
    whole.step();
    other.step();
  }
  EXPECT_EQ(other.statistics().steps, whole.statistics().steps);
  EXPECT_EQ(other.statistics().cut_sequences, 0);
  // The run before was another compiler's: rounding, in 20 steps of a chain.
  for (std::size_t i = 0; i < whole.state().q.size(); ++i) {
    EXPECT_NEAR(other.state().q[i], whole.state().q[i], 1e-11) << i;
  }
}

TEST(JointGuess, AFailedStepLeavesItAsItWas) {
  const carom_test::TemporaryFolder folder;
  for (const Iteration iteration :
       {Iteration::fixed_point, Iteration::anderson, Iteration::linearly_implicit, Iteration::automatic}) {
    SCOPED_TRACE(std::string(to_string(iteration)));
    double broken_after = never;
    TimeStepping stepping = options;
    stepping.iteration = iteration;
    Simulation whole(chain(4), stepping), failing(chain(4, broken_after), stepping);
    for (int i = 0; i < 12; ++i) {
      whole.step();
      failing.save(folder / "before");
      broken_after = failing.time();
      EXPECT_THROWS(SolverError, failing.step(), "'push'");
      broken_after = never;
      failing.save(folder / "after");
      ASSERT_EQ(folder.text_of("after"), folder.text_of("before")) << i;
      failing.step();
      ASSERT_EQ(failing.report().sweeps, whole.report().sweeps) << i;
    }
    EXPECT_EQ(bits_of(failing), bits_of(whole));
  }
}

TEST(JointGuess, StepsAllocateNothing) {
  for (const int rods : {10, 100}) {
    Simulation simulation(chain(rods), options);
    for (int i = 0; i < 20; ++i) simulation.step();
    const std::int64_t before = carom_test::allocations();
    for (int i = 0; i < 20'000 / rods; ++i) simulation.step();
    EXPECT_EQ(carom_test::allocations() - before, 0) << rods;
  }
}

// Steps of another length, and a state that is set, have nothing to go by.
TEST(JointGuess, BeginsAnewWhereTheStepsBeforeSayNothing) {
  const auto settled = [] {
    Simulation simulation(chain(4), options);
    for (int i = 0; i < 50; ++i) simulation.step();
    EXPECT_EQ(simulation.report().sweeps, 1);
    return simulation;
  };
  Simulation set = settled();
  set.set_state(set.state());
  set.step();
  EXPECT_GT(set.report().sweeps, 2);
  Simulation cut = settled();
  cut.run_until(cut.time() + 0.5e-3);
  EXPECT_GT(cut.report().sweeps, 2);
}

}  // namespace
