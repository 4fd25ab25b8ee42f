// Polygons that jam in a trough, where e_n differs from e_t: every step is solved, and says how.

#include "tests/energy/ledger_check.h"
#include "tests/integrators/falling_polygon.h"
#include "tests/random.h"
#include "tests/shares.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::add_falling_polygon;
using carom_test::ledger_closes;
using carom_test::Random;

/// Polygons fall into a steep trough: impulses on both sides meet in their cones.
System trough(std::uint64_t seed, int bodies) {
  Random random(seed);
  System system;
  system.add(Gravity{{0.0, -9.81}});
  const Surface law{.friction = random.uniform(0.3, 0.8), .normal_restitution = 0.3};
  if (bodies > 1) system.set_default_law(law);  // else nothing is there to touch
  const double slope = random.uniform(1.15, 1.35);
  const Vec<2> left(-2.0 * std::cos(slope), 2.0 * std::sin(slope)), right(-left[0], left[1]);
  system.add(Wall{.from = {-0.05, 0.0}, .to = left, .radius = 0.05}, law, "left");
  system.add(Wall{.from = {0.05, 0.0}, .to = right, .radius = 0.05}, law, "right");
  for (int i = 0; i < bodies; ++i) add_falling_polygon(system, random, 0.9 + 0.35 * i);
  return system;
}

bool says_jam(const ContactRecord& contact) { return contact.restitution_factor == 0.0; }

struct JamRuns {
  int refused = 0;          // runs that refuse_jams ends
  std::int64_t jams = 0;    // in the others
  std::int64_t at_cap = 0;  // problems of the others that no solver finished: whether they jam is not known
  std::int64_t noted = 0;   // contacts whose record says so
};

/// A run that refuses jams ends at the first one, or where it is not known, by the names of its contacts and
/// with the problem. \param doubtful jams and answers at the cap of the run that refuses none
void run_refusing(const System& system, TimeStepping options, std::int64_t doubtful, JamRuns& runs) {
  options.impact_rules.refuse_jams = true;
  Simulation simulation(system, options);
  try {
    simulation.run_until(1.0);
    EXPECT_EQ(doubtful, 0);
  } catch (const SolverError& error) {
    ++runs.refused;
    EXPECT_GT(doubtful, 0);
    ASSERT_TRUE(error.has_problem()) << error.what();
    EXPECT_EQ(error.failure().parts.size(), error.problem().groups().size()) << error.what();
    EXPECT_NE(std::string(error.what()).find("refuse_jams"), std::string::npos) << error.what();
  }
  EXPECT_EQ(simulation.statistics().plastic_jams, 0);
  EXPECT_TRUE(ledger_closes(simulation.energy()));
}

JamRuns run_troughs(int bodies, const TimeStepping& options, const carom_test::SeedRange& seeds) {
  JamRuns runs;
  for (std::uint64_t seed = seeds.first; seed < seeds.last; ++seed) {
    SCOPED_TRACE(seed);
    const System system = trough(seed, bodies);
    Simulation simulation(system, options);
    simulation.observe([&](const Simulation& now) {
      const std::vector<ContactRecord>& contacts = now.report().contacts;
      runs.noted += std::count_if(contacts.begin(), contacts.end(), says_jam);
      // Where all contacts jam no impact adds energy.
      const double gained = now.report().energy_gain - now.report().lasting_gain;
      const bool all_jam = std::all_of(contacts.begin(), contacts.end(), says_jam);
      EXPECT_TRUE(!all_jam || gained == 0.0) << gained;
    });
    EXPECT_NO_THROW(simulation.run_until(1.0));
    EXPECT_TRUE(ledger_closes(simulation.energy()));
    const std::int64_t jams = simulation.statistics().plastic_jams,
                       at_cap = simulation.contact_statistics().accepted_at_cap;
    runs.jams += jams;
    runs.at_cap += at_cap;
    run_refusing(system, options, jams + at_cap, runs);
  }
  return runs;
}

void expect_jams(const JamRuns& runs) {
  EXPECT_GT(runs.refused, 0);  // else nothing jams
  EXPECT_GT(runs.jams, 0);
  EXPECT_GE(runs.jams + runs.at_cap, runs.refused);
  EXPECT_GE(runs.noted, 2 * runs.jams);  // at least two contacts jam
}

TEST(Jams, OfSeveralBodiesAreSolvedWithoutRestitutionAndCounted) {
  expect_jams(run_troughs(4, {.step = 1e-3}, {0, 5}));
}

TEST(Jams, WhereImpactsAreLocated) {
  expect_jams(run_troughs(1, {.step = 1e-3, .impacts = ImpactTimes::located}, {0, 10}));
}

// No impulses hold jammed bodies along directions halfway, which turn into each other: those at the start do.
TEST(Jams, WhereDirectionsThatTurnPressTheBody) {
  struct Scene {
    std::uint64_t seed;
    int bodies;
  };
  for (const Scene& scene : {Scene{7000140, 1}, Scene{30000164, 2}, Scene{30000222, 2}, Scene{30000041, 4}}) {
    SCOPED_TRACE(scene.seed);
    Simulation simulation(trough(scene.seed, scene.bodies),
                          TimeStepping{.step = 1e-3, .impacts = ImpactTimes::located});
    EXPECT_NO_THROW(simulation.run_until(1.0));
    EXPECT_TRUE(ledger_closes(simulation.energy()));
  }
}

// A step whose parts have no solution is made whole, which has another motion: a jam that is to be refused is
// told.
TEST(Jams, AreRefusedInPartsOfSteps) {
  int jams = 0, refused = 0;
  for (const std::uint64_t seed : {9U, 52U, 66U, 91U, 132U, 140U, 185U, 231U, 233U, 250U}) {
    SCOPED_TRACE(seed);
    TimeStepping options{.step = 1e-3, .impacts = ImpactTimes::located};
    const System system = trough(seed, 2);
    Simulation simulation(system, options);
    try {
      simulation.run_until(1.0);
    } catch (const SolverError&) {
      continue;
    }
    if (simulation.statistics().plastic_jams == 0) continue;
    ++jams;
    options.impact_rules.refuse_jams = true;
    Simulation refusing(system, options);
    try {
      refusing.run_until(1.0);
      ADD_FAILURE() << "comes to its end";
    } catch (const SolverError& error) {
      ++refused;
      EXPECT_NE(std::string(error.what()).find("refuse_jams"), std::string::npos) << error.what();
    }
  }
  EXPECT_GT(jams, 4);
  EXPECT_EQ(refused, jams);
}

TEST(Jams, WhereImpactsAreResolvedAtTheStartOfSteps) {
  expect_jams(run_troughs(2, {.step = 1e-3, .impact_rules = {.energy_gain = EnergyGain::limit}}, {0, 10}));
}

TEST(Jams, SequentialImpactsTakeOneContactAtATime) {
  const JamRuns runs =
      run_troughs(2, {.step = 1e-3, .impact_rules = {.order = ImpactOrder::sequential}}, {0, 10});
  EXPECT_EQ(runs.jams, 0);
  EXPECT_EQ(runs.refused, 0);
}

TEST(JamsLong, RandomTroughsAreAlwaysSolved) {
  expect_jams(run_troughs(4, {.step = 1e-3}, carom_test::seeds_from(0, 40)));
  expect_jams(
      run_troughs(1, {.step = 1e-3, .impacts = ImpactTimes::located}, carom_test::seeds_from(0, 200)));
}

}  // namespace
