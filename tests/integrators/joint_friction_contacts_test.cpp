// Bars pinned to each other with friction that depends on the force in the pins, thrown on slopes: contacts
// and joints leave forces open (corners on one pin, bars that lie flat), and bounds of friction follow from
// them.

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
using carom_test::Random;

/// Two to four bars over a slope, in a row but for angles; pinned to the ground if the seed is odd.
/// Coefficients (friction times radius of a pin) are up to 5 cm for bars of half a metre and more; beyond,
/// motions without unique or any accelerations come up, which end with an error.
struct PinnedBars {
  System system;
  std::vector<BodyId> bars;
  std::string text;

  /// \param reach of the shapes, in parts of the bars: where 1, corners of two bars meet at each pin
  PinnedBars(std::uint64_t seed, int count, double slope, double coefficient, double reach = 1.0) {
    Random random(seed);
    const double friction = random.uniform(0.0, 0.5), restitution = random.uniform(0.0, 0.6);
    text = "seed " + std::to_string(seed) + ", " + std::to_string(count) + " bars, slope " + to_text(slope) +
           ", coefficient " + to_text(coefficient);
    const Vec<2> normal(-std::sin(slope), std::cos(slope));
    system.add(Gravity{{0.0, -9.81}});
    system.add(HalfPlane{.normal = normal}, Surface{.friction = friction,
                                                    .normal_restitution = restitution,
                                                    .tangential_restitution = restitution});
    const bool anchored = seed % 2 == 1;
    Vec<2> at = (anchored ? 0.5 : random.uniform(0.5, 1.5)) * normal;
    double length_before = 0.0;
    for (int i = 0; i < count; ++i) {
      const double length = random.uniform(0.5, 1.2);
      double angle = slope + (i == 0 && !anchored ? random.uniform(0.0, 0.6) : random.uniform(-0.3, 0.6));
      const auto along = [&] { return Vec<2>(std::cos(angle), std::sin(angle)); };
      if ((at + length * along()).dot(normal) < 0.05) angle = slope + 0.2;
      const BodyId bar = system.add(RigidBody{.mass = rod(random.uniform(0.5, 2.0), length),
                                              .position = at + 0.5 * length * along(),
                                              .angle = angle});
      const double end = 0.5 * reach * length;
      system.add(Segment{.body = bar, .from = {-end, 0.0}, .to = {end, 0.0}});
      if (i > 0 || anchored) {
        const End<2> before = i == 0 ? End<2>(ground, at) : End<2>(bars.back(), {0.5 * length_before, 0.0});
        const JointId pin = system.add(Revolute{.from = before, .to = {bar, {-0.5 * length, 0.0}}});
        system.add(JointFriction{.joint = pin, .coefficient = coefficient});
      }
      bars.push_back(bar);
      at += length * along();
      length_before = length;
    }
  }
};

/// Steps that so much motion takes at most: some 20 for an impact or a change of modes, of which there are up
/// to a hundred. Where accelerations jumped from evaluation to evaluation there were 1e5 in a millisecond.
constexpr std::int64_t most_steps = 4000;

/// Runs to a time; empty, or the error that ended it.
std::string run_to(const PinnedBars& scene, double end) {
  Simulation run(scene.system, EventDriven{.step_limit = 1e7});
  try {
    run.run_until(end);
  } catch (const SolverError& error) {
    return scene.text + ": " + error.what();
  }
  EXPECT_LT(run.statistics().flow_steps, most_steps) << scene.text;
  // Quadratures at the tolerance of the steps.
  EXPECT_LT(std::abs(run.energy().residual()), 1e-8 * run.energy().scale()) << scene.text;
  return {};
}

void expect_run(const PinnedBars& scene, double end) { EXPECT_EQ(run_to(scene, end), ""); }

void three_pinned_bars_on(double slope) {
  for (std::uint64_t seed = 0; seed < 3; ++seed) expect_run(PinnedBars(2 * seed, 3, slope, 0.01), 1.5);
}

TEST(JointFrictionWithContacts, ThreePinnedBarsOnASlope) { three_pinned_bars_on(0.1); }

TEST(JointFrictionWithContactsLong, ThreePinnedBarsOnASlope) {
  for (const double slope : {0.02, 0.3}) three_pinned_bars_on(slope);
}

TEST(JointFrictionWithContacts, RandomBars) {
  Random random(5);
  for (std::uint64_t seed = 20; seed < carom_test::usual_or(26U, 22U); ++seed) {
    const int count = 2 + static_cast<int>(random.below(3));
    const double slope = random.uniform(-0.3, 0.5);
    expect_run(PinnedBars(seed, count, slope, std::pow(10.0, random.uniform(-3.0, -1.3))), 1.5);
  }
}

// They chattered between modes until event_limit ended them, where the forces by which modes were decided
// were not those of the flow.
TEST(JointFrictionWithContactsLong, ModesAreDecidedByTheForcesOfTheFlow) {
  struct Bars {
    std::uint64_t seed;
    int count;
    double slope, coefficient;
  };
  for (const Bars& bars : {Bars{1108, 3, 0.01455722373406293, 0.0014882935531297906},
                           Bars{1765, 4, 0.4395724110236499, 0.01927255757135608},
                           Bars{1004, 4, 0.015478762048043104, 0.02161083628590272},
                           Bars{1055, 4, 0.3133866057156747, 0.06619674309968117}}) {
    expect_run(PinnedBars(bars.seed, bars.count, bars.slope, bars.coefficient), 2.0);
  }
}

// Of 300 none ends with an error; seed 1073 (four bars with 4.6 cm in a heap) is near the place where bounds
// and forces do not settle. None ends at event_limit.
TEST(JointFrictionWithContactsLong, RandomBars) {
  Random random(11);
  const carom_test::SeedRange seeds = carom_test::seeds_from(1000, 200, 1000);
  int failed = 0;
  for (std::uint64_t seed = seeds.first; seed < seeds.last; ++seed) {
    const int bars = 2 + static_cast<int>(random.below(3));
    const double slope = random.uniform(-0.3, 0.5);
    const double coefficient = std::pow(10.0, random.uniform(-3.0, -1.3));
    const std::string error = run_to(PinnedBars(seed, bars, slope, coefficient), 2.0);
    if (error.empty()) continue;
    ++failed;
    EXPECT_NE(error.find("not solved"), std::string::npos) << error;
    EXPECT_EQ(error.find("event_limit"), std::string::npos) << error;
  }
  EXPECT_LE(200 * failed, seeds.count());
}

/// Largest distance of the bars' centres in the two modes.
double distance(const PinnedBars& scene, double end, double step) {
  Simulation exact(scene.system, EventDriven{});
  Simulation stepped(scene.system, TimeStepping{.step = step});
  exact.run_until(end);
  stepped.run_until(end);
  double largest = 0.0;
  for (const BodyId bar : scene.bars) {
    largest = std::max(largest, (exact.state().position(bar) - stepped.state().position(bar)).norm());
  }
  return largest;
}

void modes_agree(const carom_test::SeedRange& seeds, int least_compared) {
  // Through the first impacts, which later ones amplify. Corners apart, so that forces are unique until bars
  // lie flat.
  int compared = 0;
  for (std::uint64_t seed = seeds.first; seed < seeds.last; ++seed) {
    const PinnedBars scene(seed, 2, 0.1, 0.02, 0.9);
    double coarse = 0.0, fine = 0.0;
    try {
      coarse = distance(scene, 0.5, 4e-4);
      fine = distance(scene, 0.5, 2.5e-5);
    } catch (const SolverError&) {
      continue;  // of time stepping, whose sweeps need not contract here
    }
    ++compared;
    EXPECT_LT(fine, std::max(0.5 * coarse, 1e-5)) << scene.text << ", coarse " << coarse;
  }
  EXPECT_GE(compared, least_compared);
}

TEST(JointFrictionWithContacts, ModesAgree) { modes_agree({0, 1}, 1); }

TEST(JointFrictionWithContactsLong, ModesAgree) { modes_agree({0, 5}, 3); }

/// Chains of two to four capsules with friction in their joints fall on the ground and come to lie. A slow
/// impact, which friction in a joint has no impulse in, lets the joint slip by little; where it stopped again
/// the friction lifted the end that had just closed, and so on until `event_limit`.
void chains_come_to_rest(const carom_test::SeedRange& seeds) {
  for (std::uint64_t seed = seeds.first; seed < seeds.last; ++seed) {
    SCOPED_TRACE(seed);
    carom_test::Random random(seed);
    System system;
    system.add(Gravity{{0.0, -9.81}});
    const double e = random.uniform(0.0, 0.7);
    system.set_default_law(
        {.friction = random.uniform(0.0, 0.8), .normal_restitution = e, .tangential_restitution = e});
    system.add(HalfPlane{.normal = incline(random.uniform(-0.15, 0.15))});
    const unsigned count = 2 + random.below(3);
    Vec<2> place(random.uniform(-0.8, 0.0), 1.4);
    const Vec<2> velocity = random.vec<2>(1.0);
    double angle = random.uniform(-0.3, 0.3), before = 0.0;
    BodyId previous;
    for (unsigned i = 0; i < count; ++i) {
      const double length = random.uniform(0.2, 0.5), radius = 0.02;
      angle += random.uniform(-0.3, 0.3);
      const Vec<2> along(std::cos(angle), std::sin(angle));
      const BodyId capsule = system.add(RigidBody{.mass = rod(random.uniform(0.3, 2.0), length),
                                                  .position = place + 0.5 * length * along,
                                                  .angle = angle,
                                                  .velocity = velocity});
      const double end = 0.5 * length - radius;
      system.add(Segment{.body = capsule, .from = {-end, 0.0}, .to = {end, 0.0}, .radius = radius});
      if (i > 0) {
        const JointId joint = system.add(
            Revolute{.from = {previous, {0.5 * before, 0.0}}, .to = {capsule, {-0.5 * length, 0.0}}});
        system.add(JointFriction{.joint = joint, .bound = std::pow(10.0, random.uniform(-2.5, 0.5))});
      }
      previous = capsule;
      before = length;
      place += length * along;
    }
    Simulation simulation(std::move(system), EventDriven{.event_limit = 1e5});
    simulation.run_until(1.5);
    // The tolerances of some thousand steps.
    EXPECT_LE(std::abs(simulation.energy().residual()), 1e-8 * simulation.energy().scale());
  }
}

TEST(JointFrictionWithContacts, ChainsComeToRest) {
  chains_come_to_rest({0, carom_test::count_of_samples(40U)});
}

TEST(JointFrictionWithContactsLong, ChainsComeToRest) {
  chains_come_to_rest(carom_test::seeds_from(0, 200, 2000));
}

}  // namespace
