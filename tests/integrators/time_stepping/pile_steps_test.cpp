// Piles of discs in time stepping: certificates, what is at rest, forces on the ground, order of insertion.

#include "examples/scenes/discs.h"
#include "examples/scenes/incline.h"
#include "tests/allocation_counter.h"
#include "tests/temporary_folder.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <numbers>
#include <string>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;

constexpr double step = 1e-3;  // [s]

/// A box as high as wide when it is full, of 2 m at most.
scenes::Discs box_of(int count) {
  scenes::Discs discs{.count = count};
  discs.width = std::min(2.0, 0.1 * std::sqrt(static_cast<double>(count)));
  return discs;
}

double mass_of(const scenes::Discs& discs, int i) {
  const double radius = discs.radius * (1.0 + discs.spread * scenes::scattered(i));
  return discs.density * std::numbers::pi * radius * radius;
}

/// Largest certificate of the contacts of the last step.
double worst_residual(const Simulation& simulation) {
  double worst = 0.0;
  for (const ContactRecord& contact : simulation.report().contacts) worst = std::max(worst, contact.residual);
  return worst;
}

/// Kinetic energy of the discs with two contacts or more that bear [J].
double supported_energy(const Simulation& simulation, const std::vector<BodyId>& all,
                        const scenes::Discs& discs) {
  std::vector<int> contacts(all.size(), 0);
  const auto count = [&](BodyId body) {
    const auto found = std::find(all.begin(), all.end(), body);
    if (found != all.end()) ++contacts[static_cast<std::size_t>(found - all.begin())];
  };
  for (const ContactRecord& contact : simulation.report().contacts) {
    if (contact.mode == ContactMode::open) continue;
    count(contact.body);
    count(contact.other);
  }
  double energy = 0.0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (contacts[i] < 2) continue;
    const int number = static_cast<int>(i);
    const double mass = mass_of(discs, number),
                 radius = discs.radius * (1.0 + discs.spread * scenes::scattered(number));
    const double spin = simulation.state().spin(all[i]);
    energy += 0.5 * mass * simulation.state().velocity(all[i]).squaredNorm() +
              0.25 * mass * radius * radius * spin * spin;
  }
  return energy;
}

/// Force of the ground on the discs in the last step [N].
Vec<2> ground_force(const Simulation& simulation) {
  Vec<2> sum = Vec<2>::Zero();
  for (const ContactRecord& contact : simulation.report().contacts) {
    if (!contact.obstacle.valid()) continue;
    const Vec<2> n(contact.normal[0], contact.normal[1]), t(n[1], -n[0]);
    sum += (contact.impulse[0] * n + contact.impulse[1] * t) / step;
  }
  return sum;
}

TEST(PileSteps, NothingIsAllocatedAtRest) {
  System system;
  scenes::add_discs(system, box_of(100));
  Simulation simulation(system, TimeStepping{.step = step});
  simulation.run_until(3.0);  // the collapse has more contacts than the rest, and longer sweeps
  const std::int64_t before = carom_test::allocations();
  for (int i = 0; i < 500; ++i) simulation.step();
  EXPECT_EQ(carom_test::allocations() - before, 0);
  EXPECT_GT(simulation.report().contacts.size(), 100U);
}

void piles_are_certified_in_every_step(std::initializer_list<int> counts) {
  // Up to fifty contacts exact solvers are asked where sweeps do not end.
  for (const int count : counts) {
    System system;
    scenes::add_discs(system, box_of(count));
    Simulation simulation(system, TimeStepping{.step = step});
    std::size_t most = 0;
    for (int i = 0; i < 1500; ++i) {
      simulation.step();
      most = std::max(most, simulation.report().contacts.size());
    }
    EXPECT_GT(most, static_cast<std::size_t>(count));
    EXPECT_LE(simulation.statistics().worst_residual, 1e-10) << count;
    EXPECT_EQ(simulation.contact_statistics().accepted_at_cap, 0) << count;
  }
}

TEST(PileSteps, SmallPilesAreCertifiedInEveryStep) { piles_are_certified_in_every_step({5, 10}); }

TEST(PileStepsLong, SmallPilesAreCertifiedInEveryStep) { piles_are_certified_in_every_step({20, 25}); }

TEST(PileSteps, WhatAStepKeepsForTheNextOneChangesNoBits) {
  // A run that is loaded anew in every step has nothing of the step before at hand: names, islands and pairs
  // are found again. From the fall, in which contacts change, until all lie.
  const scenes::Discs discs = box_of(60);
  System system;
  static_cast<void>(scenes::add_discs(system, discs));
  const carom_test::TemporaryFolder folder;
  const std::string path = folder / "step";
  for (const double from : {0.2, 0.5, 1.5}) {
    Simulation kept(system, TimeStepping{.step = step});
    kept.run_until(from);
    for (int i = 0; i < 20; ++i) {
      kept.save(path);
      Simulation fresh(system, TimeStepping{.step = step});
      fresh.load(path);
      fresh.step();
      kept.step();
      ASSERT_EQ(fresh.state().v, kept.state().v) << "from " << from << " s, step " << i;
      ASSERT_EQ(fresh.state().q, kept.state().q) << "from " << from << " s, step " << i;
      ASSERT_EQ(fresh.report().contacts.size(), kept.report().contacts.size());
    }
  }
}

TEST(PileSteps, StatisticsAreThoseOfTheReports) {
  for (const ImpactTimes impacts : {ImpactTimes::at_step_start, ImpactTimes::located}) {
    const bool located = impacts == ImpactTimes::located;
    scenes::Discs discs = box_of(located ? 6 : 40);  // each meeting ends a step
    discs.restitution = 0.4;
    System system;
    static_cast<void>(scenes::add_discs(system, discs));
    Simulation simulation(system, TimeStepping{.step = step, .impacts = impacts});
    std::int64_t contacts = 0, count = 0, several = 0, not_unique = 0;
    double deepest = 0.0, residual = 0.0;
    for (int i = 0; i < 500; ++i) {
      simulation.step();
      for (const ContactRecord& contact : simulation.report().contacts) {
        ++contacts;
        count += contact.impact ? 1 : 0;
        several += contact.outcome == Outcome::several_solutions ? 1 : 0;
        not_unique += contact.outcome == Outcome::forces_not_unique ? 1 : 0;
        deepest = std::min(deepest, contact.gap);
        residual = std::max(residual, contact.residual);
      }
    }
    const Statistics& statistics = simulation.statistics();
    EXPECT_GT(count, 10);
    EXPECT_EQ(statistics.contact_steps, contacts);
    EXPECT_EQ(statistics.impacts, count);
    EXPECT_EQ(statistics.several_solutions, several);
    EXPECT_EQ(statistics.forces_not_unique, not_unique);
    EXPECT_EQ(statistics.deepest_gap, deepest);
    EXPECT_EQ(statistics.worst_residual, residual);
  }
}

TEST(PileSteps, OrderOfInsertionChangesOneStepByRoundingOnly) {
  const scenes::Discs discs = box_of(20);
  System system;
  const std::vector<BodyId> all = scenes::add_discs(system, discs);
  Simulation fallen(system, TimeStepping{.step = step});
  fallen.run_until(0.5);
  // The same discs where they are now, in either order.
  std::vector<double> reference;
  for (const bool reversed : {false, true}) {
    System again;
    again.add(Gravity{{0.0, -scenes::discs_gravity}});
    again.set_default_law({.friction = discs.friction, .normal_restitution = discs.restitution});
    again.add(HalfPlane{.normal = {0.0, 1.0}});
    again.add(HalfPlane{.normal = {1.0, 0.0}});
    again.add(HalfPlane{.point = {discs.width, 0.0}, .normal = {-1.0, 0.0}});
    std::vector<BodyId> ids(all.size());
    for (std::size_t k = 0; k < all.size(); ++k) {
      const std::size_t i = reversed ? all.size() - 1 - k : k;
      const int number = static_cast<int>(i);
      const double radius = discs.radius * (1.0 + discs.spread * scenes::scattered(number));
      ids[i] = again.add(RigidBody{.mass = disc(mass_of(discs, number), radius),
                                   .position = fallen.state().position(all[i]),
                                   .velocity = fallen.state().velocity(all[i]),
                                   .spin = fallen.state().spin(all[i])});
      again.add(Disc{.body = ids[i], .radius = radius});
    }
    // Sweeps visit contacts in another order: they are asked for an answer of rounding.
    Simulation simulation(again, TimeStepping{.step = step, .contact_budget = {.residual = 1e-15}});
    simulation.step();
    EXPECT_GT(simulation.report().contacts.size(), 20U);
    std::vector<double> numbers;
    for (const BodyId id : ids) {
      const Vec<2> velocity = simulation.state().velocity(id);
      numbers.insert(numbers.end(), {velocity[0], velocity[1], discs.radius * simulation.state().spin(id)});
    }
    if (reference.empty()) reference = numbers;
    // Speeds up to 1 m/s through a problem of condition 1e3.
    for (std::size_t k = 0; k < numbers.size(); ++k) EXPECT_NEAR(numbers[k], reference[k], 1e-12) << k;
  }
}

TEST(PileSteps, AHeavyBlockOnLightOnesIsSolved) {
  // A million times the mass of each block below it: sweeps alone would need as many sweeps.
  System system;
  system.add(Gravity{{0.0, -9.81}});
  system.set_default_law({.friction = 0.5, .normal_restitution = 0.0});
  system.add(HalfPlane{.normal = {0.0, 1.0}});
  constexpr int count = 10;
  constexpr double height = 0.1, heavy = 1e6;
  for (int i = 0; i < count; ++i) {
    const double mass = i + 1 == count ? heavy : 1.0;
    const BodyId body =
        system.add(RigidBody{.mass = box(mass, 0.4, height), .position = {0.0, (i + 0.5) * height}});
    system.add(Polygon{.body = body, .vertices = {{-0.2, -0.05}, {0.2, -0.05}, {0.2, 0.05}, {-0.2, 0.05}}});
  }
  Simulation simulation(system, TimeStepping{.step = step});
  for (int i = 0; i < 100; ++i) simulation.step();
  EXPECT_EQ(simulation.report().contacts.size(), 2U * count);
  EXPECT_LE(simulation.statistics().worst_residual, 1e-10);
  EXPECT_EQ(simulation.contact_statistics().accepted_at_cap, 0);
  const double weight = 9.81 * (heavy + count - 1);
  EXPECT_NEAR(ground_force(simulation)[1] / weight, 1.0, 1e-8);
}

/// Brick of 1 m by 0.2 m on a plane, at an angle whose tangent is a part of the coefficient of friction.
System brick_on_incline(double part, double friction, BodyId& brick) {
  System system;
  const double angle = std::atan(part * friction);
  const Vec<2> normal = incline(angle);
  system.add(Gravity{{0.0, -9.81}});
  system.add(HalfPlane{.normal = normal}, Surface{.friction = friction, .normal_restitution = 0.0});
  brick = system.add(RigidBody{
      .mass = box(1.0, 1.0, 0.2), .position = 0.1 * normal, .angle = std::atan2(-normal[0], normal[1])});
  system.add(Polygon{.body = brick, .vertices = {{-0.5, -0.1}, {0.5, -0.1}, {0.5, 0.1}, {-0.5, 0.1}}});
  return system;
}

TEST(PileStepsLong, ABrickBelowTheAngleOfFrictionDoesNotCreep) {
  BodyId brick;
  Simulation simulation(brick_on_incline(0.99, 0.5, brick), TimeStepping{.step = 0.01});
  const Vec<2> start = simulation.state().position(brick);
  simulation.run_until(3600.0);
  EXPECT_LT((simulation.state().position(brick) - start).norm(), 1e-9);
}

TEST(PileSteps, ABrickAboveTheAngleOfFrictionSlides) {
  BodyId brick;
  constexpr double friction = 0.5, part = 1.01, time = 2.0;
  Simulation simulation(brick_on_incline(part, friction, brick), TimeStepping{.step = step});
  simulation.run_until(time);
  const double angle = std::atan(part * friction);
  const double acceleration = 9.81 * (std::sin(angle) - friction * std::cos(angle));
  // Constant acceleration, which the trapezoidal rule integrates exactly.
  EXPECT_NEAR(simulation.state().velocity(brick).norm(), acceleration * time, 1e-10);
}

TEST(PileStepsLong, TwoThousandDiscsComeToRest) {
  const scenes::Discs discs = box_of(2000);
  System system;
  const std::vector<BodyId> all = scenes::add_discs(system, discs);
  double weight = 0.0, heights = 0.0;
  for (int i = 0; i < discs.count; ++i) weight += mass_of(discs, i) * scenes::discs_gravity;
  Simulation simulation(system, TimeStepping{.step = step});
  for (const BodyId id : all) heights += simulation.state().position(id)[1] / discs.count;
  const double energy_of_fall = 0.5 * weight * heights;  // of the order of what they fall with
  double fastest = 0.0;
  while (simulation.time() < 4.0) {
    simulation.step();
    for (const BodyId id : all) fastest = std::max(fastest, simulation.state().velocity(id).norm());
  }
  EXPECT_LE(simulation.statistics().worst_residual, 5e-3);
  // A single disc sinks by at most 3/2 of its way in a step into what it meets.
  EXPECT_GE(simulation.statistics().deepest_gap, -5.0 * 1.5 * step * fastest);
  while (simulation.time() < 5.0) {
    simulation.step();
    ASSERT_LE(worst_residual(simulation), 1e-8) << simulation.time();
  }
  for (int i = 0; i < 200; ++i) {
    simulation.step();
    ASSERT_LE(worst_residual(simulation), 1e-10) << simulation.time();
    ASSERT_LE(supported_energy(simulation, all, discs), 1e-12 * energy_of_fall) << simulation.time();
  }
  const Vec<2> force = ground_force(simulation);
  EXPECT_NEAR(force[1] / weight, 1.0, 1e-8);
  EXPECT_NEAR(force[0] / weight, 0.0, 1e-8);
}

}  // namespace
