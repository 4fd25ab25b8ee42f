// Piles of discs from the collapse to rest, each step solved by sweeps from the impulses of the step before.

#include "tests/contact/disc_pile.h"

#include <carom/contact/solvers/residual.h>
#include <carom/contact/solvers/solver_chain.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace carom {
namespace {

using contact_test::DiscPile;
using contact_test::PileOptions;

/// The residual again, from the problem and the impulses alone.
double judge(const DiscPile& pile) {
  std::vector<double> xi(pile.solution().impulse.size());
  pile.problem().velocities(pile.solution().impulse, xi);
  return residual(pile.problem(), pile.solution().impulse, xi).value;
}

/// Lets a pile fall for `falling` steps, then demands of `resting` steps that all are solved to 1e-8 and gain
/// nothing.
void expect_rest(const PileOptions& options, int falling, int resting) {
  DiscPile pile(options);
  SolverChain chain;
  chain.set_budget({.residual = 1e-8});
  for (int step = 0; step < falling; ++step) {
    const ContactReport& report = pile.step(chain);
    ASSERT_TRUE(report.usable()) << "step " << step << ", residual " << report.residual;
  }
  int most_sweeps = 0;
  for (int step = 0; step < resting; ++step) {
    const ContactReport& report = pile.step(chain);
    ASSERT_EQ(report.outcome, Outcome::solved) << "step " << step << ", residual " << report.residual;
    EXPECT_LE(judge(pile), 1e-8);
    // With e = 0 impulses take energy from what falls. What they leave wrong is the residual's part of it.
    EXPECT_LE(pile.gain(), 0.0);
    most_sweeps = std::max(most_sweeps, report.iterations);
  }
  EXPECT_LT(most_sweeps, 80);
  EXPECT_EQ(chain.statistics().not_solved, 0);
  EXPECT_GT(chain.statistics().accepted_at_cap, 0);
}

TEST(DiscPile, OfAHundredComesToRest) { expect_rest({.discs = 100, .width = 0.4}, 1500, 300); }

TEST(DiscPile, OfFiveHundredComesToRest) { expect_rest({.discs = 500, .width = 0.9}, 1300, 200); }

TEST(DiscPileLong, OfTwoThousandComesToRest) { expect_rest({.discs = 2000}, 2000, 500); }

TEST(DiscPile, IsTheSameEveryTime) {
  const PileOptions options{.discs = 150, .width = 0.5};
  DiscPile first(options), second(options), other({.discs = 60, .width = 0.3, .seed = 7});
  SolverChain chain, used;
  for (int step = 0; step < 400; ++step) {
    first.step(chain);
    // The second chain has solved other problems before, larger and smaller ones.
    if (step % 3 == 0) other.step(used);
    second.step(used);
    ASSERT_EQ(first.solution().impulse, second.solution().impulse) << step;
  }
  EXPECT_TRUE(std::equal(first.velocities().begin(), first.velocities().end(), second.velocities().begin()));
}

// Without loads and with one e for all, impacts take energy (docs/method.md, section 5): solved to 1e-12 they
// gain no more than that part of what they move.
TEST(DiscPile, ImpactsOfOneRestitutionGainNothing) {
  for (const double e : {0.0, 0.5, 1.0}) {
    DiscPile pile({.discs = 150, .width = 0.5, .restitution = e, .gravity = 0.0, .speed = 1.0});
    SolverChain chain;
    chain.set_budget({.residual = 1e-12, .sweeps = 20000});
    int impacts = 0;
    for (int step = 0; step < 300; ++step) {
      const double before = pile.kinetic_energy();
      ASSERT_EQ(pile.step(chain).outcome, Outcome::solved) << e;
      if (!pile.problem().groups().empty()) ++impacts;
      EXPECT_LE(pile.gain(), 1e-11 * before) << e;
    }
    EXPECT_GT(impacts, 100);
  }
}

}  // namespace
}  // namespace carom
