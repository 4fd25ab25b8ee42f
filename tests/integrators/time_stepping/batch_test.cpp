// Uncoupled bodies go through a step in one loop, and as if each were alone.

#include <carom/carom.h>
#include <carom/core/assembly.h>
#include <carom/core/workers.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;

struct Start {
  Vec<2> position, velocity;
  double radius, spin;
};

/// Discs of all sizes, some of which fall on the floor within a few steps.
std::vector<Start> starts(int count) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::vector<Start> all;
  for (int i = 0; i < count; ++i) {
    const double radius = 0.01 + 0.05 * unit(random);
    const double height = radius + (i % 3 == 0 ? 1e-3 : 5.0) * unit(random);
    all.push_back(
        {{1.0 * i, height}, {unit(random) - 0.5, -2.0 * unit(random)}, radius, 20.0 * (unit(random) - 0.5)});
  }
  return all;
}

void add_floor(System& system) {
  system.add(Gravity{{0.0, -9.81}});
  system.add(HalfPlane{.point = {0.0, 0.0}, .normal = {0.0, 1.0}},
             Surface{.friction = 0.3, .normal_restitution = 0.5, .tangential_restitution = 0.2}, "floor");
}

BodyId add_disc(System& system, const Start& start) {
  const BodyId body = system.add(RigidBody{.mass = disc(30.0 * start.radius * start.radius, start.radius),
                                           .position = start.position,
                                           .velocity = start.velocity,
                                           .spin = start.spin});
  system.add(Disc{.body = body, .radius = start.radius});
  return body;
}

System discs(const std::vector<Start>& all) {
  System system;
  add_floor(system);
  for (const Start& start : all) add_disc(system, start);
  return system;
}

TEST(Batch, IsUncoupledBodiesOfOneKindInARow) {
  System system;
  add_floor(system);
  const std::vector<Start> all = starts(9);
  std::vector<BodyId> bodies;
  for (std::size_t i = 0; i < 3; ++i) bodies.push_back(add_disc(system, all[i]));
  system.add(Particle{.mass = 1.0});
  for (std::size_t i = 3; i < 9; ++i) bodies.push_back(add_disc(system, all[i]));
  system.add(SpringDamper{.from = {bodies[4]}, .to = {bodies[5]}, .stiffness = 1.0});
  system.add(SpringDamper{.from = {ground, {0.0, 9.0}}, .to = {bodies[7]}, .stiffness = 1.0});
  const Assembly assembly(std::move(system));
  std::vector<Index> sizes;
  Index component = 0;
  for (const Range batch : assembly.batches()) {
    EXPECT_EQ(batch.begin, component);
    component = batch.end;
    sizes.push_back(assembly.bodies_of(batch).size());
  }
  EXPECT_EQ(component, assembly.components().size());
  // Three discs; the particle; disc 3; the pair; disc 6; the one on a spring to the ground; disc 8.
  EXPECT_EQ(sizes, (std::vector<Index>{3, 1, 1, 2, 1, 1, 1}));
}

/// Numbers of a body alone and among others are the same bits.
void demand_same_as_alone(const std::vector<Start>& all, const TimeStepping& mode, int steps) {
  Simulation together(discs(all), mode);
  std::size_t contacts = 0;
  for (int i = 0; i < steps; ++i) contacts += together.step().contacts.size();
  EXPECT_GT(contacts, all.size() / 4);
  double energy = 0.0;
  EnergyFlows flows;
  for (std::size_t i = 0; i < all.size(); ++i) {
    Simulation alone(discs({all[i]}), mode);
    for (int k = 0; k < steps; ++k) alone.step();
    for (std::size_t k = 0; k < 3; ++k) {
      ASSERT_EQ(alone.state().q[k], together.state().q[3 * i + k]) << "disc " << i << ", coordinate " << k;
      ASSERT_EQ(alone.state().v[k], together.state().v[3 * i + k]) << "disc " << i << ", velocity " << k;
    }
    energy += alone.energy().total();
    for (std::size_t k = 0; k < energy_flow_count; ++k) {
      flows.values[k] += alone.energy().flow(static_cast<EnergyFlow>(k));
    }
  }
  // Sums of as many energies in another order.
  const double rounding = 1e-15 * static_cast<double>(all.size());
  EXPECT_NEAR(together.energy().total(), energy, rounding * std::abs(energy));
  for (std::size_t k = 0; k < energy_flow_count; ++k) {
    EXPECT_NEAR(together.energy().flow(static_cast<EnergyFlow>(k)), flows.values[k],
                rounding * std::abs(energy))
        << k;
  }
}

TEST(Batch, EveryBodyGoesAsIfItWereAlone) {
  demand_same_as_alone(starts(300), TimeStepping{.step = 1e-3}, 60);
}

/// More bodies than are worked on at once: contacts are found, solved and booked part by part.
TEST(Batch, EveryBodyOfManyGoesAsIfItWereAlone) {
  demand_same_as_alone(starts(1100), TimeStepping{.step = 1e-3}, 30);
}

TEST(Batch, ContactsOfManyAreReportedInTheOrderOfTheirBodies) {
  Simulation simulation(discs(starts(1100)), TimeStepping{.step = 1e-3});
  std::size_t count = 0;
  for (int i = 0; i < 60; ++i) {
    const std::vector<ContactRecord>& contacts = simulation.step().contacts;
    count += contacts.size();
    EXPECT_TRUE(std::is_sorted(contacts.begin(), contacts.end(),
                               [](const auto& a, const auto& b) { return a.body < b.body; }));
  }
  EXPECT_GT(count, 1000U);
  const double scale = simulation.energy().scale();
  EXPECT_LE(std::abs(simulation.energy().residual()), 1e-12 * scale);  // of some thousand works
}

TEST(Batch, GapsAreOpenedBodyByBody) {
  demand_same_as_alone(starts(60), TimeStepping{.step = 1e-3, .project_gaps = true}, 60);
}

TEST(Batch, ThreadsGiveTheSameBits) {
  if (!Workers::several_available()) GTEST_SKIP() << "built without oneTBB";
  const std::vector<Start> all = starts(1500);
  Simulation one(discs(all), TimeStepping{.step = 1e-3});
  Simulation two(discs(all), TimeStepping{.step = 1e-3, .threads = 2});
  for (int i = 0; i < 30; ++i) {
    one.step();
    two.step();
  }
  EXPECT_EQ(one.state().q, two.state().q);
  EXPECT_EQ(one.state().v, two.state().v);
  EXPECT_EQ(one.energy().total(), two.energy().total());
}

/// A net beside them iterates and does not change them.
TEST(Batch, GoesOnBesideBodiesThatAreIterated) {
  const std::vector<Start> all = starts(40);
  System system = discs(all);
  const BodyId a = system.add(Particle{.mass = 0.1, .position = {-3.0, 1.0}});
  const BodyId b = system.add(Particle{.mass = 0.1, .position = {-2.0, 1.0}});
  system.add(SpringDamper{.from = a, .to = b, .stiffness = 100.0, .free_length = 0.5});
  Simulation beside(std::move(system), TimeStepping{.step = 1e-3});
  Simulation alone(discs(all), TimeStepping{.step = 1e-3});
  for (int i = 0; i < 60; ++i) {
    beside.step();
    alone.step();
  }
  for (std::size_t i = 0; i < alone.state().q.size(); ++i) {
    ASSERT_EQ(alone.state().q[i], beside.state().q[i]) << i;
    ASSERT_EQ(alone.state().v[i], beside.state().v[i]) << i;
  }
}

/// An overflow of one body fails the step, which names the cause, and leaves all of them where they were.
TEST(Batch, FailsAsAWhole) {
  System system;
  system.add(Gravity{{0.0, -1e145}}, "pull");
  for (int i = 0; i < 5; ++i) {
    system.add(RigidBody{.mass = disc(i == 3 ? 1e20 : 1.0, 0.1), .position = {1.0 * i, 0.0}});
  }
  Simulation simulation(std::move(system), TimeStepping{.step = 1.0});
  const State before = simulation.state();
  try {
    simulation.step();
    FAIL() << "an energy that is not finite was counted";
  } catch (const SolverError& error) {
    EXPECT_NE(std::string(error.what()).find("'pull'"), std::string::npos) << error.what();
  }
  EXPECT_EQ(simulation.state().q, before.q);
  EXPECT_EQ(simulation.state().v, before.v);
  EXPECT_EQ(simulation.time(), 0.0);
}

}  // namespace
