// Large components are cut into blocks; who works on which changes no bit.

#include "examples/scenes/net.h"
#include "tests/integrators/same_run.h"
#include "tests/model_error.h"

#include <carom/carom.h>
#include <carom/core/assembly.h>
#include <carom/core/workers.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Fifty blocks, between which springs cross; its lowest row lies along the plane.
scenes::Net large() { return {.k = 160, .prestress = 0.01, .tilt = 0.1, .height = -1e-6}; }

System large_net() {
  System system;
  scenes::add_net(system, large());
  return system;
}

std::vector<std::uint64_t> bits_after(int threads, TimeStepping options, int steps) {
  options.threads = threads;
  Simulation simulation(large_net(), options);
  for (int i = 0; i < steps; ++i) simulation.step();
  EXPECT_GT(simulation.statistics().contact_steps, 0);
  return carom_test::bits_of(simulation);
}

TEST(Threads, BlocksTogetherAreTheComponent) {
  const Assembly assembly(large_net());
  ASSERT_EQ(assembly.components().size(), 1U);
  const Component& component = assembly.components()[0];
  ASSERT_EQ(component.blocks.size(), component.bodies.size() / BlockTable::block_size);
  ASSERT_GE(component.blocks.size(), 3U);
  Index body = component.bodies.begin, v = component.v.begin;
  for (Index block = component.blocks.begin; block < component.blocks.end; ++block) {
    EXPECT_EQ(assembly.blocks()[block].bodies.begin, body);
    EXPECT_EQ(assembly.blocks()[block].v.begin, v);
    body = assembly.blocks()[block].bodies.end;
    v = assembly.blocks()[block].v.end;
  }
  EXPECT_EQ(body, component.bodies.end);
  EXPECT_EQ(v, component.v.end);
  Index block = component.blocks.begin;
  for (Index run = component.runs.begin; run < component.runs.end; ++run) {
    EXPECT_EQ(assembly.blocks().runs()[run].begin, block);
    EXPECT_FALSE(assembly.blocks().runs()[run].empty());
    block = assembly.blocks().runs()[run].end;
  }
  EXPECT_EQ(block, component.blocks.end);
}

TEST(Threads, TwoBlocksAreEnoughForTwo) {
  for (const Index blocks : {1U, 2U, 3U, 80U}) {
    System system;
    BodyId last;
    for (Index i = 0; i < blocks * BlockTable::block_size; ++i) {
      const BodyId next = system.add(Particle{.mass = 1.0, .position = {static_cast<double>(i), 0.0}});
      if (i > 0) system.add(SpringDamper{.from = last, .to = next, .stiffness = 1.0});
      last = next;
    }
    const Assembly assembly(std::move(system));
    ASSERT_EQ(assembly.blocks().size(), blocks);
    EXPECT_EQ(assembly.blocks().runs().size(), blocks == 1 ? 1 : blocks < 24 ? 2 : BlockTable::most_runs);
  }
}

TEST(Threads, ElementsActUpToTheirBlockOfARun) {
  const Assembly assembly(large_net());
  const auto run_of = [&](Index block) {
    Index run = 0;
    while (block >= assembly.blocks().runs()[run].end) ++run;
    return run;
  };
  ASSERT_GE(assembly.blocks().runs().size(), 3U);
  std::vector<Index> last_loading_block(assembly.blocks().size());
  std::iota(last_loading_block.begin(), last_loading_block.end(), Index{0});
  std::set<Index> loaded_across_runs;
  for (Index kind = 0; kind < assembly.force_kinds().size(); ++kind) {
    const ForceKind& force = *assembly.force_kinds()[kind];
    if (force.is_field()) continue;
    std::set<Index> seen;
    const auto blocks_of = [&](Index element) {
      std::vector<BodyId> ends;
      force.ends(element, ends);
      std::set<Index> blocks;
      for (const BodyId end : ends) {
        const Index body = assembly.layout()->index(end);
        for (Index block = 0; block < assembly.blocks().size(); ++block) {
          const Range bodies = assembly.blocks()[block].bodies;
          if (body >= bodies.begin && body < bodies.end) blocks.insert(block);
        }
      }
      seen.insert(element);
      return blocks;
    };
    bool across = false;
    for (Index block = 0; block < assembly.blocks().size(); ++block) {
      const Range elements = assembly.blocks().elements_up_to(block, kind);
      for (Index element = elements.begin; element < elements.end; ++element) {
        const std::set<Index> blocks = blocks_of(element);
        EXPECT_EQ(*blocks.rbegin(), block);
        EXPECT_EQ(run_of(*blocks.begin()), run_of(block));
        across = across || blocks.size() > 1;
        for (Index before = *blocks.begin(); before <= block; ++before) {
          last_loading_block[before] = std::max(last_loading_block[before], block);
        }
      }
    }
    EXPECT_TRUE(across);
    const Range bridges = assembly.blocks().bridges(0, kind);
    EXPECT_FALSE(bridges.empty());
    for (Index element = bridges.begin; element < bridges.end; ++element) {
      const std::set<Index> blocks = blocks_of(element);
      EXPECT_NE(run_of(*blocks.begin()), run_of(*blocks.rbegin()));
      loaded_across_runs.insert(blocks.begin(), blocks.end());
    }
    EXPECT_EQ(seen.size(), force.size());
  }
  EXPECT_LT(loaded_across_runs.size(), assembly.blocks().size());
  for (Index block = 0; block < assembly.blocks().size(); ++block) {
    EXPECT_EQ(assembly.blocks()[block].last_loading_block, last_loading_block[block]) << block;
    EXPECT_EQ(assembly.blocks()[block].loaded_across_runs, loaded_across_runs.contains(block)) << block;
  }
}

void expect_same_bits(int steps) {
  if (!Workers::several_available()) GTEST_SKIP() << "built without oneTBB";
  for (const ForceRule rule : {ForceRule::trapezoidal, ForceRule::energy_momentum}) {
    const TimeStepping options{.step = 1e-4, .tolerance = 1e-10, .force_rule = rule};
    const auto one = bits_after(1, options, steps);
    EXPECT_EQ(bits_after(2, options, steps), one) << to_string(rule);
  }
}

TEST(Threads, SameBitsForAnyNumber) { expect_same_bits(3); }

TEST(ThreadsLong, SameBitsForAnyNumber) { expect_same_bits(12); }

TEST(Threads, SameBitsWithAnderson) {
  if (!Workers::several_available()) GTEST_SKIP() << "built without oneTBB";
  const TimeStepping options{.step = 1e-4, .tolerance = 1e-10, .iteration = Iteration::anderson};
  EXPECT_EQ(bits_after(2, options, 6), bits_after(1, options, 6));
}

TEST(Threads, SameBitsOfTwoSweepsInOneGo) {
  // In free fall the second sweep follows the first block by block.
  const auto run = [](int threads, double tolerance) {
    System system;
    scenes::add_net(system, {.k = 160, .prestress = 0.01, .height = 10.0});
    Simulation simulation(std::move(system),
                          TimeStepping{.step = 1e-4, .tolerance = tolerance, .threads = threads});
    for (int i = 0; i < 40; ++i) {
      simulation.step();
      if (i > 20 && tolerance > 0.0) {
        EXPECT_EQ(simulation.report().sweeps, 2);
      }
    }
    return simulation;
  };
  const Simulation one = run(1, 1e-10);
  if (Workers::several_available()) {
    EXPECT_EQ(carom_test::bits_of(run(2, 1e-10)), carom_test::bits_of(one));
  }
  // Iterated down to rounding, which takes more sweeps than two.
  const Simulation exact = run(1, 0.0);
  EXPECT_GT(exact.report().sweeps, 2);
  double apart = 0.0;
  for (std::size_t i = 0; i < one.state().q.size(); ++i) {
    apart = std::max(apart, std::abs(one.state().q[i] - exact.state().q[i]));
  }
  EXPECT_GT(apart, 0.0);
  EXPECT_LT(apart, 40 * 1e-10);  // the tolerance of every step
  EXPECT_LT(std::abs(one.energy().residual()), 1e3 * epsilon * one.energy().scale());
}

TEST(Threads, TwoSweepsInOneGoThatFailChangeNothing) {
  System system;
  const scenes::Net net{.k = 70, .prestress = 0.01, .height = 10.0};
  scenes::add_net(system, net);
  constexpr double gust = 0.0015;
  const auto blow = [](double time) { return Vec<2>(time > gust ? nan : 1.0, 0.0); };
  const Assembly described(system);
  system.add(AppliedForce{.on = described.layout()->id(2500), .force = blow}, "gust");
  Simulation simulation(std::move(system), TimeStepping{.step = 1e-4, .tolerance = 1e-10});
  for (int i = 0; i < 15; ++i) simulation.step();
  ASSERT_EQ(simulation.report().sweeps, 2);
  const auto before = carom_test::bits_of(simulation);
  try {
    simulation.step();
    FAIL() << "a force that is no number";
  } catch (const SolverError& error) {
    EXPECT_NE(std::string(error.what()).find("'gust'"), std::string::npos) << error.what();
  }
  EXPECT_EQ(carom_test::bits_of(simulation), before);
}

TEST(Threads, FewerSweepsAreFoundEnough) {
  // A net that draws together needs two sweeps until its dashpots have calmed it, which two in one go see
  // too.
  System system;
  scenes::add_net(system, {.k = 70, .prestress = 0.01, .height = 10.0, .damping = 10.0});
  Simulation simulation(std::move(system), TimeStepping{.step = 1e-4, .tolerance = 1e-7});
  ASSERT_GT(simulation.assembly().blocks().size(), 1U);
  int most = 0;
  for (int i = 0; i < 200; ++i) {
    simulation.step();
    most = std::max(most, simulation.report().sweeps);
  }
  EXPECT_GE(most, 2);
  EXPECT_EQ(simulation.report().sweeps, 1);
}

TEST(Threads, WhatALoopThrowsComesOut) {
  for (const int threads : {1, 2}) {
    if (threads > 1 && !Workers::several_available()) continue;
    const Workers workers(threads);
    std::vector<int> calls(100, 0);
    workers.for_each(100, [&](Index i) { ++calls[i]; });
    EXPECT_EQ(calls, std::vector<int>(100, 1));
    const auto run = [&] {
      workers.for_each(100, [](Index i) {
        if (i == 57) throw std::runtime_error("57");
      });
    };
    EXPECT_THROW(run(), std::runtime_error);
  }
}

TEST(Threads, RefusesNumbersThatCannotBe) {
  System system;
  system.add(Particle{.mass = 1.0});
  EXPECT_MODEL_ERROR(Simulation(system, TimeStepping{.threads = 0}), "threads is 0", "at least 1");
  if (!Workers::several_available()) {
    EXPECT_MODEL_ERROR(Simulation(system, TimeStepping{.threads = 2}), "threads is 2", "oneTBB");
  }
}

}  // namespace
