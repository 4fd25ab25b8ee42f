// Contacts that jam a body: by enumeration of all modes the law of impact has no answer where e differ, and
// always has one without restitution.

#include "tests/contact/touching_body.h"
#include "tests/random.h"
#include "tests/shares.h"

#include <carom/carom.h>
#include <carom/contact/island_problem.h>
#include <carom/contact/solvers/impact_solver.h>
#include <carom/contact/solvers/solution_list.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::Random;
using carom_test::Touch;
using Jam = carom_test::TouchingBody;

/// Between a floor and a ceiling: their impulses cancel each other. It falls onto the floor.
std::vector<Touch> corridor(double floor, double ceiling) {
  return {{{0.0, 0.0}, {0.0, 1.0}, {.friction = 0.3, .normal_restitution = floor}},
          {{0.0, 0.0}, {0.0, -1.0}, {.friction = 0.3, .normal_restitution = ceiling}}};
}

constexpr std::array<double, 3> falls{1.0, -1.0, 0.0};

TEST(PlasticJam, UnequalRestitutionHasNoAnswer) {
  // xi_1 + xi_2 = e_1 gamma_1 + e_2 gamma_2 = e_2 - e_1 < 0 for all impulses: both cannot be >= 0.
  Jam jam(corridor(0.5, 0.2));
  IslandProblem problem = jam.impact(falls, false);
  EXPECT_EQ(SolutionList().enumerate(problem.problem()), Outcome::no_solution);
  EXPECT_FALSE(problem.solve(jam.chain).usable());
  EXPECT_EQ(problem.restitution_factor(), 1.0);
}

// The ceiling touches beside the floor, by delta: to have both velocities the body has to turn at
// -(e_1 - e_2)/delta, at which it is shot round by 1/2 J w^2.
TEST(PlasticJam, WhatOnlyImpulsesWithoutMeasureCanGiveIsNotGiven) {
  constexpr double delta = 1e-5, spin = (0.5 - 0.2) / delta, inertia = 0.1;
  std::vector<Touch> touches = corridor(0.5, 0.2);
  touches[1].point = {delta, 0.0};
  for (Touch& touch : touches) touch.law.friction = 0.0;
  Jam jam(touches);
  IslandProblem shot = jam.impact(falls, false);
  EXPECT_TRUE(shot.solve(jam.chain).usable());
  // The body turns by the billionth of W that does not cancel, which is known to 2e-7.
  const double energy = 0.5 * inertia * spin * spin;
  EXPECT_NEAR(jam.gain(shot, falls), energy, 1e-6 * energy);
  IslandProblem stopped = jam.impact(falls, true);
  EXPECT_TRUE(stopped.solve(jam.chain).usable());
  EXPECT_EQ(stopped.restitution_factor(), 0.0);
  EXPECT_LE(jam.gain(stopped, falls), 1e-12);  // rounding, as below
}

// The ceiling touches beside the floor, farther away: impulses of Newton's law that are no larger than this
// stay, and gains are told.
TEST(PlasticJam, GainsOfTheLawStay) {
  std::vector<Touch> touches = corridor(0.5, 0.2);
  touches[1].point = {0.1, 0.0};
  for (Touch& touch : touches) touch.law.friction = 0.0;
  Jam jam(touches);
  IslandProblem problem = jam.impact(falls, true);
  EXPECT_TRUE(problem.solve(jam.chain).usable());
  EXPECT_EQ(problem.restitution_factor(), 1.0);
  const double gain = jam.gain(problem, falls);
  EXPECT_GT(gain, 0.0);
  // It was compared with the answer without restitution, and came back.
  IslandProblem not_compared = jam.impact(falls, false);
  EXPECT_TRUE(not_compared.solve(jam.chain).usable());
  EXPECT_EQ(gain, jam.gain(not_compared, falls));
}

TEST(PlasticJam, TheOtherWayRoundThereIsOne) {
  Jam jam(corridor(0.2, 0.5));
  IslandProblem problem = jam.impact(falls, true);
  EXPECT_NE(SolutionList().enumerate(problem.problem()), Outcome::no_solution);
  EXPECT_TRUE(problem.solve(jam.chain).usable());
  EXPECT_EQ(problem.restitution_factor(), 1.0);
}

TEST(PlasticJam, IsSolvedWithoutRestitution) {
  Jam jam(corridor(0.5, 0.2));
  IslandProblem problem = jam.impact(falls, true);
  ASSERT_TRUE(problem.solve(jam.chain).usable());
  EXPECT_EQ(problem.restitution_factor(), 0.0);
  EXPECT_LE(problem.report().residual, 1e-12);  // as any answer of the exact solvers
  std::array<double, 3> after = falls;
  problem.map().add_velocities(after.data());
  EXPECT_NEAR(after[1], 0.0, 1e-14);
  EXPECT_LE(jam.gain(problem, falls), 0.0);
  // It holds in all sweeps of a step, with other loads too, and ends with the next build().
  problem.set_free_velocity(std::array<double, 3>{1.0, -1.5, 0.0}.data());
  ASSERT_TRUE(problem.solve(jam.chain).usable());
  EXPECT_EQ(problem.restitution_factor(), 0.0);
  EXPECT_EQ(problem.problem().vector()[0], -1.5);
  const std::array<double, 3> rises{1.0, 1.0, 0.0};
  jam.state(problem, rises);
  ASSERT_TRUE(problem.solve(jam.chain).usable());
  EXPECT_EQ(problem.restitution_factor(), 1.0);
}

/// Random jams by another law than Newton's, of which all have an answer. Returns how many are plastic.
int solve_random_jams(ImpactLaw law) {
  int jammed = 0;
  for (std::uint64_t seed = 0; seed < 1500; ++seed) {
    Random random(seed);
    std::vector<Touch> touches(2 + random.below(2));
    for (Touch& touch : touches) {
      touch = {random.vec<2>(0.5), random.vec<2>(1.0).normalized(), {}};
      const double e = random.uniform(0.0, 1.0), along = random.uniform(0.0, 1.0);
      touch.law = {.friction = random.uniform(0.0, 1.5),
                   .normal_restitution = e,
                   .tangential_restitution = law == ImpactLaw::energetic ? 0.0 : along,
                   .impact_law = law};
    }
    Jam jam(touches);
    const std::array<double, 3> velocity{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-3, 3)};
    IslandProblem problem(IslandOptions{.plastic_jams = true});
    ImpactSolver solver;
    problem.use(&solver, law);
    jam.state(problem, velocity);
    EXPECT_TRUE(problem.solve(jam.chain).usable()) << seed;
    EXPECT_LE(problem.report().residual, 1e-10) << seed;  // tolerated_residual
    if (problem.restitution_factor() == 1.0) continue;
    ++jammed;
    EXPECT_LE(jam.gain(problem, velocity), 1e-12) << seed;  // rounding, as below
  }
  return jammed;
}

TEST(PlasticJam, PoissonsLawHasAnAnswerOfItsOwn) {
  // The least impulses of the expansion, e P of the compression, are in the cones of P.
  EXPECT_EQ(solve_random_jams(ImpactLaw::poisson), 0);
}

TEST(PlasticJam, WhatIsJammedCannotGiveBackEnergy) { EXPECT_GT(solve_random_jams(ImpactLaw::energetic), 0); }

TEST(PlasticJam, IsTakenOfRandomJamsWhereEnumerationFindsNoAnswerAndOnlyThere) {
  int without = 0, jammed = 0;
  for (std::uint64_t seed = 0; seed < carom_test::count_of_samples(1500U); ++seed) {
    Random random(seed);
    const bool one = random.below(4) == 0;  // one restitution for all rows
    const double common = random.uniform(0.0, 1.0);
    const auto e = [&] { return one ? common : random.uniform(0.0, 1.0); };
    std::vector<Touch> touches(2 + random.below(2));
    for (Touch& touch : touches) {
      touch = {random.vec<2>(0.5), random.vec<2>(1.0).normalized(), {}};
      touch.law = {
          .friction = random.uniform(0.0, 1.5), .normal_restitution = e(), .tangential_restitution = e()};
    }
    Jam jam(touches);
    const std::array<double, 3> velocity{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-3, 3)};
    IslandProblem problem = jam.impact(velocity, true);
    const Outcome listed = SolutionList().enumerate(problem.problem());
    const bool usable = problem.solve(jam.chain).usable();
    ASSERT_TRUE(usable) << seed;
    EXPECT_LE(problem.report().residual, 1e-10) << seed;  // tolerated_residual
    if (listed == Outcome::no_solution) ++without;
    if (problem.restitution_factor() == 1.0) {
      EXPECT_NE(listed, Outcome::no_solution) << seed;
      continue;
    }
    ++jammed;
    EXPECT_EQ(listed, Outcome::no_solution) << seed;
    EXPECT_FALSE(one) << seed;
    // Rounding of an energy of about 1 J with impulses of a few N s.
    EXPECT_LE(jam.gain(problem, velocity), 1e-12) << seed;
  }
  EXPECT_GE(without, carom_test::usual_or(20, 4));  // else nothing was tried
  EXPECT_EQ(jammed, without);
}

// A body turns about a point that is pressed between two walls, and a third one stops it. Impulses of the two
// cancel but for rounding, so that whatever they have left of the velocity asks for impulses without measure.
TEST(PlasticJam, WhatTurnsInAJamIsStoppedByImpulsesOfItsMeasure) {
  constexpr double spin = 1.0, inertia = 0.1, energy = 0.5 * inertia * spin * spin;
  constexpr double usual = 10.0;  // N s: what stops it, with levers of 0.1 m and more, twice
  int without_measure = 0;
  for (std::uint64_t seed = 0; seed < carom_test::usual_or(5000U, 2500U); ++seed) {
    Random random(seed);
    const double e = random.uniform(0.0, 0.6), mu = random.uniform(0.3, 1.0);
    const double between = std::pow(10.0, random.uniform(-16.0, -6.0));  // [m]
    const double noise = std::pow(10.0, random.uniform(-12.0, -6.0));    // [m/s]
    const Vec<2> wall = random.vec<2>(1.0).normalized(), point{random.uniform(0.1, 0.5), 0.0};
    const Surface law{.friction = mu, .normal_restitution = e};
    Jam jam({{{0.0, 0.0}, wall, law},
             {{random.uniform(-between, between), random.uniform(-between, between)}, -wall, law},
             {point, {0.0, -1.0}, law}});
    const std::array<double, 3> velocity{random.uniform(-noise, noise), random.uniform(-noise, noise), spin};
    const auto largest = [](const IslandProblem& problem) {
      double impulse = 0.0;
      for (const double part : problem.impulses()) impulse = std::max(impulse, std::abs(part));
      return impulse;
    };
    IslandProblem as_found = jam.impact(velocity, false);
    if (as_found.solve(jam.chain).usable() && largest(as_found) > 1e4 * usual) ++without_measure;
    IslandProblem problem = jam.impact(velocity, true);
    ASSERT_TRUE(problem.solve(jam.chain).usable()) << seed;
    EXPECT_LE(largest(problem), 1e4 * usual) << seed;
    EXPECT_LE(jam.gain(problem, velocity), 1e-6 * energy) << seed;
  }
  EXPECT_GE(without_measure, carom_test::usual_or(5, 2));  // else nothing was tried
}

}  // namespace
