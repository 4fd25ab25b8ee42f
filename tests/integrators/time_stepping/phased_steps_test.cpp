// Steps in phases: each coupling set goes through its own. What is far from each other moves as if it were
// alone; what comes near another set within a step acts on it; energies, counts and records are of all.

#include "tests/energy/ledger_check.h"
#include "tests/integrators/event_driven/body_scenes.h"
#include "tests/integrators/time_stepping/located_runs.h"
#include "tests/random.h"
#include "tests/shares.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace {

using namespace body_scenes;
using carom_test::ledger_closes;
using carom_test::located;

/// Some bodies around a place: discs and boxes that fall, hit each other and the floor, and a pendulum that
/// one of them may hit.
struct Group {
  explicit Group(carom_test::Random& random) {
    for (int i = 0; i < 3; ++i) {
      radii.push_back(random.uniform(0.05, 0.12));
      places.push_back({random.uniform(-0.3, 0.3), 0.2 + 0.3 * i});
      velocities.push_back({random.uniform(-1.0, 1.0), random.uniform(-2.0, 0.5)});
    }
    hangs = random.uniform(0.0, 1.0) < 0.5;
  }
  std::vector<BodyId> add_to(System& system, double x) const {
    std::vector<BodyId> bodies;
    for (std::size_t i = 0; i < radii.size(); ++i)
      bodies.push_back(add_disc(system, 1.0, radii[i], places[i] + Vec<2>(x, 0.0), velocities[i], 0.5));
    if (hangs) {
      const BodyId rod = add_box(system, 2.0, 0.1, 0.6, {x - 0.5, 0.6});
      system.add(Revolute{.from = ground, .to = {rod, {0.0, 0.3}}});
      bodies.push_back(rod);
    }
    return bodies;
  }
  std::vector<double> radii;
  std::vector<Vec<2>> places, velocities;
  bool hangs = false;
};

void add_world(System& system) {
  system.add(Gravity{{0.0, -g}});
  system.set_default_law({.friction = 0.3, .normal_restitution = 0.6});
  system.add(HalfPlane{.normal = {0.0, 1.0}});
}

TEST(PhasedSteps, SetsMoveAsIfTheyWereAlone) {
  constexpr double apart = 16.0;  // [m], a number without rounding
  constexpr double h = 2e-3, end = 0.25;
  int hits = 0;
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U, 5U, 6U, 7U, 8U}) {
    SCOPED_TRACE(seed);
    carom_test::Random random(seed);
    const std::vector<Group> groups{Group(random), Group(random), Group(random)};
    System all;
    add_world(all);
    std::vector<std::vector<BodyId>> bodies;
    for (std::size_t i = 0; i < groups.size(); ++i)
      bodies.push_back(groups[i].add_to(all, apart * static_cast<double>(i)));
    Simulation together(all, located(h));
    together.run_until(end);
    EXPECT_TRUE(ledger_closes(together.energy()));
    std::int64_t impacts = 0;
    double energy = 0.0;
    for (std::size_t i = 0; i < groups.size(); ++i) {
      System one;
      add_world(one);
      const double x = apart * static_cast<double>(i);
      const std::vector<BodyId> own = groups[i].add_to(one, x);
      Simulation alone(one, located(h));
      alone.run_until(end);
      impacts += alone.statistics().impacts;
      energy += alone.energy().total();
      for (std::size_t b = 0; b < own.size(); ++b) {
        const Vec<2> far = together.state().position(bodies[i][b]) - alone.state().position(own[b]);
        // Steps end to the tolerance of 1e-12 m, which impacts amplify.
        EXPECT_LT(far.norm(), 1e-9);
      }
    }
    EXPECT_EQ(together.statistics().impacts, impacts);
    EXPECT_NEAR(together.energy().total(), energy, 1e-8);
    hits += static_cast<int>(impacts);
  }
  EXPECT_GT(hits, 60);
}

// The disc that comes back from the wall flies beyond all that it sweeps in a step where nothing is hit.
TEST(PhasedSteps, WhatIsHitMayHitOthersInTheSameStep) {
  System system;
  system.set_default_law({.friction = 0.0, .normal_restitution = 1.0});
  system.add(HalfPlane{.normal = {1.0, 0.0}});
  const BodyId fast = add_disc(system, 1.0, 0.1, {0.3, 0.0}, {-10.0, 0.0}, 0.0);
  const BodyId rests = add_disc(system, 1.0, 0.1, {0.9, 0.0}, {0.0, 0.0}, 0.0);
  const BodyId behind = add_disc(system, 1.0, 0.1, {1.25, 0.0}, {0.0, 0.0}, 0.0);
  Simulation simulation(system, located(0.1));
  const StepReport& report = simulation.step();
  // At the wall after 0.2 m; 0.6 m back to the second, which takes 0.15 m to the third.
  EXPECT_NEAR(simulation.state().position(fast)[0], 0.7, 1e-11);
  EXPECT_NEAR(simulation.state().position(rests)[0], 1.05, 1e-11);
  EXPECT_NEAR(simulation.state().position(behind)[0], 1.3, 1e-11);
  EXPECT_NEAR(simulation.state().velocity(behind)[0], 10.0, 1e-11);
  std::vector<double> times;
  for (const ContactRecord& contact : report.contacts) {
    if (contact.impact) times.push_back(contact.time);
  }
  ASSERT_EQ(times.size(), 3U);
  EXPECT_TRUE(std::is_sorted(times.begin(), times.end()));
  EXPECT_NEAR(times[0], 0.02, 1e-12);
  EXPECT_NEAR(times[1], 0.08, 1e-12);
  EXPECT_NEAR(times[2], 0.095, 1e-12);
  EXPECT_TRUE(ledger_closes(simulation.energy()));
}

TEST(PhasedSteps, StandForOneStepInCounts) {
  System system;
  add_world(system);
  for (int i = 0; i < 5; ++i) add_disc(system, 1.0, 0.1, {2.0 * i, 0.101 + 0.001 * i}, {0.0, -1.0}, 0.0);
  // So that bodies are not followed one by one.
  add_disc(system, 1.0, 0.1, {0.0, 0.8}, {0.0, 0.0}, 0.0);
  TimeStepping options = located(0.01);
  options.iteration = Iteration::linearly_implicit;
  Simulation simulation(system, options);
  simulation.step();
  EXPECT_EQ(simulation.statistics().steps, 1);
  EXPECT_EQ(simulation.statistics().impacts, 5);
  EXPECT_EQ(simulation.report().contacts.size(), 5U);
  EXPECT_NEAR(simulation.time(), 0.01, 0.0);
  EXPECT_EQ(simulation.report().step, 0.01);
  EXPECT_TRUE(ledger_closes(simulation.energy()));
}

/// How far two discs are apart [m].
double gap_of(const Simulation& simulation, BodyId a, BodyId b, double radii) {
  return (simulation.state().position(a) - simulation.state().position(b)).norm() - radii;
}

// The way of the disc that the floor does not hit was taken for straight: a quarter of g h off, so that a
// pair which had parted more slowly seemed to overlap when the other one was hit, and was not looked for.
TEST(PhasedSteps, APairThatPartsSlowlyClosesAgainInTheStep) {
  constexpr double radius = 0.1, capture_speed = 0.01;
  for (const double h : {1e-2, 1e-3}) {
    for (const double restitution : {0.1, 0.5, 1.0}) {
      for (const double gap : {0.0, 1e-9, 1e-6, 1e-5}) {
        for (const double parting : {-0.02, 0.0, 1e-3, 5e-3, 2e-2}) {
          System system;
          system.add(Gravity{{0.0, -g}});
          system.set_default_law({.friction = 0.0, .normal_restitution = restitution});
          system.add(HalfPlane{.normal = {0.0, 1.0}});
          const BodyId lower = add_disc(system, 1.0, radius, {0.0, radius + 0.5 * h}, {0.0, -1.0});
          const BodyId upper =
              add_disc(system, 1.0, radius, {0.0, 3.0 * radius + 0.5 * h + gap}, {0.0, -1.0 + parting});
          Simulation simulation(system, located(h));
          simulation.step();
          // A slower closing that opens again comes as deep at most.
          const double allowed = 1e-9 + 0.25 * capture_speed * h;
          EXPECT_GT(gap_of(simulation, lower, upper, 2.0 * radius), -allowed)
              << h << ", e " << restitution << ", gap " << gap << ", " << parting;
        }
      }
    }
  }
}

// Bounces that accumulate within a step, up to some ten, and the pair lasts behind them.
TEST(PhasedSteps, BouncesUnderAStiffSpringEndInContact) {
  constexpr double radius = 0.1, h = 4e-3;
  carom_test::Random random(11);
  for (int i = 0; i < carom_test::count_of_samples(3000); ++i) {
    const double stiffness = random.uniform(500.0, 5000.0), apart = random.uniform(1e-4, 2e-3);
    System system;
    system.set_default_law({.friction = 0.0, .normal_restitution = random.uniform(0.3, 0.6)});
    const BodyId a = add_disc(system, 1.0, radius, {0.0, 0.0});
    const BodyId b =
        add_disc(system, random.uniform(0.3, 1.0), radius, {2.0 * radius + apart, 0.0}, {-0.5, 0.0});
    system.add(SpringDamper{.from = a, .to = b, .stiffness = stiffness});
    Simulation simulation(system, located(h));
    for (int step = 0; step < 4; ++step) {
      simulation.step();
      EXPECT_GT(gap_of(simulation, a, b, 2.0 * radius), -2e-5) << i << ", step " << step;
    }
    EXPECT_TRUE(ledger_closes(simulation.energy())) << i;
  }
}

// A dip within the step is found whatever is hit elsewhere meanwhile.
TEST(PhasedSteps, PairsGrazeBesideAFarImpactAsAlone) {
  constexpr double h = 0.02;
  constexpr int seeds = carom_test::count_of_samples(3000);
  int hits = 0;
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    std::vector<Vec<2>> ends;
    std::vector<std::int64_t> impacts;
    for (const bool beside : {false, true}) {
      carom_test::Random random(seed);
      System system;
      system.add(Gravity{{0.0, -g}});
      system.set_default_law({.friction = 0.3, .normal_restitution = 0.7});
      system.add(HalfPlane{.normal = {0.0, 1.0}});
      const auto box_at = [&](const Vec<2>& place) {
        return add_box(system, random.uniform(0.5, 1.0), random.uniform(0.1, 0.2), random.uniform(0.1, 0.2),
                       place, random.uniform(-3.0, 3.0),
                       {random.uniform(-1.5, 1.5), random.uniform(-1.5, 1.5)}, random.uniform(-6.0, 6.0));
      };
      const BodyId a = box_at({16.0, 1.0});
      const double angle = random.uniform(-3.0, 3.0), apart = random.uniform(0.17, 0.23);
      const BodyId b = box_at({16.0 + apart * std::cos(angle), 1.0 + apart * std::sin(angle)});
      system.add(SpringDamper{.from = a, .to = b, .stiffness = 700.0, .free_length = 0.2});
      if (beside) add_disc(system, 1.0, 0.1, {0.0, 0.11 + random.uniform(0.0, 0.02)}, {0.0, -2.0});
      Simulation simulation(system, located(h));
      simulation.step();
      ends.push_back(simulation.state().position(a));
      ends.push_back(simulation.state().position(b));
      impacts.push_back(simulation.statistics().impacts - (beside ? 1 : 0));
    }
    EXPECT_EQ(impacts[0], impacts[1]) << seed;
    EXPECT_LT((ends[0] - ends[2]).norm() + (ends[1] - ends[3]).norm(), 1e-9) << seed;
    hits += static_cast<int>(impacts[0]);
  }
  EXPECT_GT(hits, seeds / 6);
}

}  // namespace
