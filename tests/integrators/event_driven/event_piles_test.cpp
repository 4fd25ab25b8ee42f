// Piles of bodies with friction: they jam, slide, and come to rest; accounts close and nothing penetrates.

#include "tests/integrators/event_driven/random_piles.h"
#include "tests/integrators/event_run.h"
#include "tests/shares.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace {

using namespace random_piles;
using namespace carom_test;

// Projections leave gaps at rounding; output states, and gaps that close within a step, at the tolerance of
// gaps.
constexpr double allowed_overlap = 1e-8;

/// Total of what runs did.
struct Runs {
  std::int64_t jams = 0;                 // impacts without collision
  int at_rest = 0, failed = 0, all = 0;  // runs
};

/// Runs a pile. An error of the run must name parts; it is counted.
void run(const PileOptions& options, double end, Runs& runs) {
  SCOPED_TRACE("friction " + to_text(options.friction) + ", restitution " + to_text(options.restitution) +
               ", seed " + std::to_string(options.seed) + (options.discs_only ? ", discs" : ", mixed") +
               (options.sharp ? ", sharp" : ""));
  const RandomPile pile(options);
  Simulation simulation(pile.system(), EventDriven{.interval = 0.05, .record_events = false});
  const LedgerWatch ledger(simulation, 10.0);
  double deepest = 0.0;
  simulation.observe([&](const Simulation& now) { deepest = std::max(deepest, pile.deepest(now.state())); });
  try {
    simulation.run_until(end);
  } catch (const SolverError& error) {
    EXPECT_FALSE(error.failure().parts.empty()) << error.what();
    ++runs.failed;
  }
  EXPECT_TRUE(ledger.closes());
  EXPECT_LT(deepest, allowed_overlap);
  runs.jams += simulation.statistics().events[static_cast<std::size_t>(EventKind::impact_without_collision)];
  runs.at_rest += simulation.energy().kinetic() < 1e-12 ? 1 : 0;
  ++runs.all;
}

/// Discs and mixed shapes; with sharp polygons mixed shapes only.
void run_all(PileOptions options, const carom_test::SeedRange& seeds, double end, Runs& runs) {
  for (const bool discs_only : {false, true}) {
    if (discs_only && options.sharp) continue;
    for (const double friction : {0.0, 0.3, 0.8}) {
      for (const double restitution : {0.0, 0.3, 0.5}) {
        for (std::uint64_t seed = seeds.first; seed < seeds.last; ++seed) {
          options.discs_only = discs_only;
          options.friction = friction;
          options.restitution = restitution;
          options.seed = seed;
          run(options, end, runs);
        }
      }
    }
  }
}

void record(const Runs& runs) {
  testing::Test::RecordProperty("jams", std::to_string(runs.jams));
  testing::Test::RecordProperty("at_rest", std::to_string(runs.at_rest));
  testing::Test::RecordProperty("failed", std::to_string(runs.failed));
}

TEST(EventPiles, SmallOnesInAV) {
  Runs runs;
  run_all({.bodies = 3}, {1, 2}, 1.0, runs);
  EXPECT_EQ(runs.failed, 0);
  record(runs);
}

TEST(EventPiles, SmallOnesBetweenWalls) {
  Runs runs;
  run_all({.bodies = 4}, {2, 3}, 1.0, runs);
  EXPECT_EQ(runs.failed, 0);
  record(runs);
}

TEST(EventPiles, SmallOnesOfSharpPolygons) {
  Runs runs;
  run_all({.bodies = 3, .sharp = true}, {1, 3}, 1.0, runs);
  EXPECT_EQ(runs.failed, 0);
  record(runs);
}

// Two of these discs slide while more contacts than needed keep the others: forces are not unique then, and
// move bodies. The flow had others than those that the modes were decided by, at one event after the other.
TEST(EventPiles, PlasticDiscsWhoseForcesAreNotUniqueComeToRest) {
  Runs runs;
  run({10, true, 0.5, 0.0, 1}, 2.0, runs);
  EXPECT_EQ(runs.failed, 0);
  EXPECT_EQ(runs.at_rest, 1);
}

TEST(EventPiles, DiscsThatBounceAndWhoseForcesAreNotUniqueComeToRest) {
  Runs runs;
  run({8, true, 0.5, 0.3, 7}, 2.0, runs);
  EXPECT_EQ(runs.failed, 0);
  EXPECT_EQ(runs.at_rest, 1);
}

// Three discs in a row on a wall, of which the outer ones roll and the middle one slides: its normal force is
// not unique, and with it the friction that moves them. Forces that were shared out so that margins are
// largest moved them as the answer did, those that the flow had did not: one event after the other.
TEST(EventPilesLong, DiscsWhoseForcesThatAreNotUniqueMoveThemGoOn) {
  Runs runs;
  run({20, true, 0.5, 0.3, 5}, 0.9, runs);
  EXPECT_EQ(runs.failed, 0);
}

// Contacts that slow impacts had parted were closed, which made others slide that did not before: one event
// followed the other at the same time.
TEST(EventPiles, ClosingSlowContactsStartsNoSliding) {
  Runs runs;
  run({6, true, 1.2, 0.3, 77}, 0.8, runs);
  EXPECT_EQ(runs.failed, 0);
}

// Eight contacts of which two slide: no solver had an answer to the problem of accelerations, nor to that of
// its limit at one speed of sliding for all. With the speeds that they have there is one.
TEST(EventPiles, WhatIsNotSolvedInAccelerationsIsSolvedAsALimit) {
  Runs runs;
  run({8, true, 1.2, 0.0, 17}, 1.1, runs);
  EXPECT_GT(runs.jams, 0);
  EXPECT_EQ(runs.failed, 0);
}

// A step of two of these boxes was wrong far behind its own event, and interpolated in front of it too: the
// search for meetings looked at a million places.
TEST(EventPiles, MeetingsAreSearchedInTheMotionThatIs) {
  const RandomPile pile({4, false, 0.0, 0.5, 3, true});
  Simulation simulation(pile.system(), EventDriven{.record_events = false});
  simulation.run_until(0.81);
  EXPECT_LT(simulation.statistics().flow_evaluations, 100'000);
}

// A rounded corner rolls off the end of an edge in the instant of an impact: its force is that of the corner.
TEST(EventPiles, ModesAreThoseOfTheFeatureThatComesNext) {
  Runs runs;
  run({4, false, 0.0, 0.3, 4}, 1.2, runs);
  EXPECT_EQ(runs.failed, 0);
}

/// Mean height of the centres [m].
double mean_height(const Simulation& simulation) {
  double sum = 0.0;
  for (const BodyId body : simulation.system().bodies()) sum += simulation.state().position(body)[1];
  return sum / static_cast<double>(simulation.system().bodies().size());
}

/// A pile of discs in a V at rest, in both modes: the difference of mean heights, relative.
double difference_at_rest(const PileOptions& options, double end) {
  const RandomPile pile(options);
  Simulation exact(pile.system(), EventDriven{.record_events = false});
  Simulation steps(pile.system(), TimeStepping{.step = 5e-4});
  for (Simulation* const each : {&exact, &steps}) {
    each->run_until(end);
    EXPECT_LT(each->energy().kinetic(), 1e-12);
  }
  return mean_height(steps) / mean_height(exact) - 1.0;
}

/// Largest difference of a coordinate between steps and events, of 20 discs poured into a V [m].
double difference(const RandomPile& pile, double step, double time) {
  Simulation exact(pile.system(), tight()), steps(pile.system(), TimeStepping{.step = step});
  exact.run_until(time);
  steps.run_until(time);
  EXPECT_GT(exact.statistics().impacts, 0);
  double largest = 0.0;
  for (std::size_t i = 0; i < exact.state().q.size(); ++i)
    largest = std::max(largest, std::abs(exact.state().q[i] - steps.state().q[i]));
  return largest;
}

// Steps notice an impact up to one step late, by any part of a step: the mean over piles shows the order.
// After 0.4 s the first discs have met the walls and each other; after 0.5 s the pile diverges.
TEST(EventPiles, StepsConvergeToEventsWithTheFirstOrder) {
  constexpr double coarse = 1e-3, fine = 1.25e-4;
  double of_coarse = 0.0, of_fine = 0.0;
  for (std::uint64_t seed = 1; seed <= 15; seed += 2) {
    const RandomPile pile({20, true, 0.5, 0.0, seed});
    of_coarse += difference(pile, coarse, 0.4);
    of_fine += difference(pile, fine, 0.4);
  }
  const double order = std::log(of_coarse / of_fine) / std::log(coarse / fine);
  RecordProperty("order", std::to_string(order));
  EXPECT_NEAR(order, 1.0, 0.25);  // eight random parts of a step each
}

// Which disc lies where is chance; a pile of ten may be some per cent higher or lower.
TEST(EventPiles, PilesAtRestAreAsHighInBothModes) {
  EXPECT_NEAR(difference_at_rest({10, true, 0.5, 0.0, 7}, 2.0), 0.0, 0.05);
}

TEST(EventPilesLong, PilesAtRestAreAsHighInBothModes) {
  double sum = 0.0;
  int count = 0;
  for (std::uint64_t seed = 1; seed <= 15; seed += 2) {
    if (seed == 3 || seed == 5) continue;  // a disc rolls away to and fro for longer
    const double found = difference_at_rest({10, true, 0.5, 0.0, seed}, 2.5);
    EXPECT_NEAR(found, 0.0, 0.08);
    sum += found;
    ++count;
  }
  EXPECT_NEAR(sum / count, 0.0, 0.03);
}

TEST(EventPilesLong, TwentyDiscsComeToRest) {
  EXPECT_NEAR(difference_at_rest({20, true, 0.5, 0.0, 3}, 2.5), 0.0, 0.05);
}

// Each impact shook all that touched, and each shake was ended by events of its own: no end in 800 s of
// processor time.
TEST(EventPilesLong, TwentyDiscsThatBounceComeToRest) {
  Runs runs;
  run({20, true, 0.5, 0.3, 3}, 3.0, runs);  // the last disc may roll to and fro for more than 2 s
  EXPECT_EQ(runs.failed, 0);
  EXPECT_EQ(runs.at_rest, 1);
}

// Thirty-one contacts of 20 discs with forces of many freedoms: Lemke's method did not find their largest
// margin, and each event followed the one before at the same time.
TEST(EventPilesLong, ForcesOfManyFreedomsAreSharedOut) {
  Runs runs;
  run({20, true, 0.5, 0.3, 33}, 1.1, runs);
  EXPECT_EQ(runs.failed, 0);
}

// Discs jam at a contact that slides by 1e-7 m/s beside one that slides by 1e-3 m/s: impulses of the limit
// were small against those of the shortest step, and not found.
TEST(EventPilesLong, JamsOfWhatSlidesSlowlyAreFound) {
  Runs runs;
  run({20, true, 0.8, 0.3, 3}, 1.23, runs);
  EXPECT_GT(runs.jams, 0);
  EXPECT_EQ(runs.failed, 0);
}

// Three contacts stop together in a pile where others slide by 1e-3 m/s, and leave a fourth at 1e-12 m/s: in
// the direction of this rounding its friction jammed, and no impact without collision was found.
TEST(EventPilesLong, SlidingOfRoundingDoesNotJam) {
  Runs runs;
  run({20, true, 0.8, 0.0, 9}, 1.06, runs);
  run({20, true, 0.8, 0.0, 15}, 1.28, runs);
  EXPECT_GT(runs.jams, 0);
  EXPECT_EQ(runs.failed, 0);
}

// Of 23 contacts three slide on although the problem of accelerations has an answer, too, in which impulses
// stop them: the search for these came to forces instead, and the run ended.
TEST(EventPilesLong, ForcesFoundInTheSearchForAnImpactAreTaken) {
  Runs runs;
  run({20, true, 1.2, 0.0, 3}, 1.15, runs);
  EXPECT_GT(runs.jams, 0);
  EXPECT_EQ(runs.failed, 0);
}

// A contact jams that slides by 1e-11 m/s, six times what counts as zero: no step of the search for an impact
// was long enough to be tried.
TEST(EventPilesLong, JamsOfWhatSlidesHardlyFasterThanRoundingAreFound) {
  Runs runs;
  run({20, true, 1.2, 0.3, 1}, 0.96, runs);
  EXPECT_GT(runs.jams, 0);
  EXPECT_EQ(runs.failed, 0);
}

// A disc between two walls may be given forces of any size: an answer of 1e39 N was taken, beside which all
// accelerations are rounding, and modes without forces that press; their event came again at the same time.
TEST(EventPilesLong, ForcesThatSayNothingAreNoAnswer) {
  Runs runs;
  run({8, true, 1.2, 0.6, 57}, 1.3, runs);
  run({10, true, 1.2, 0.6, 45}, 0.75, runs);
  EXPECT_EQ(runs.failed, 0);
}

// Friction of four contacts of a pile that rolls is exhausted at once, one of them that of a disc wedged in
// the V: sliding at all of them leaves no forces, and nothing slides yet.
TEST(EventPiles, ContactsThatCannotAllStartToSlideTogetherGoOn) {
  Runs runs;
  run({8, true, 1.2, 0.3, 49}, 0.8, runs);
  EXPECT_EQ(runs.failed, 0);
}

TEST(EventPilesLong, LargerOnes) {
  Runs runs;
  run_all({.bodies = 6}, carom_test::seeds_from(1, 6), 1.5, runs);
  EXPECT_GT(runs.jams, 0);  // else what jams was not tried
  EXPECT_EQ(runs.failed, 0);
  record(runs);
}

TEST(EventPilesLong, OfSharpPolygons) {
  Runs runs;
  run_all({.bodies = 4, .sharp = true}, carom_test::seeds_from(1, 16), 1.5, runs);
  EXPECT_EQ(runs.failed, 0);
  record(runs);
}

}  // namespace
