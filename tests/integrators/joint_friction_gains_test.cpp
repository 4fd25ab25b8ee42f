// Friction in joints that is bound by their force, in impacts of contacts with unequal restitution, and of
// stops: what an impact gains is told, in both modes.

#include "tests/integrators/redundant_mechanisms.h"
#include "tests/shares.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace {

using namespace joint_scenes;

/// One to three bars, pinned to the ground and to each other with friction, that strike at the start: the tip
/// of the last one a floor, a wall or both, and stops in the pins.
struct Strike {
  Linkage linkage;

  /// \param unequal the restitution of what strikes
  Strike(std::uint64_t seed, bool unequal) {
    carom_test::Random random(seed);
    System& system = linkage.scene.system;
    const double common = random.uniform(0.0, 0.6);
    const auto restitution = [&] {
      const double own = random.below(2) == 0 ? random.uniform(0.0, 0.1) : random.uniform(0.7, 0.9);
      return unequal ? own : common;
    };
    const unsigned bars = 1 + random.below(3);
    Vec<2> at(0.0, 2.0), velocity = Vec<2>::Zero();
    Linkage::Bar before = linkage.base;
    for (unsigned i = 0; i < bars; ++i) {
      const double spin = random.uniform(-6.0, 6.0), length = random.uniform(0.5, 1.0);
      const Vec<2> way = length * Linkage::along(random.uniform(-0.5, 3.6));
      const Linkage::Bar bar = linkage.bar(random.uniform(0.3, 3.0), at, at + way, velocity, spin);
      linkage.pin(before, bar, at);
      const JointId pin = system.joints().back();
      system.add(JointFriction{.joint = pin, .coefficient = random.uniform(0.0, 0.6) * length},
                 "rust " + std::to_string(i));
      // The pin stands at one of its stops.
      const unsigned stop = random.below(4);
      if (stop == 0) system.add(Stop{.joint = pin, .upper = 0.0, .restitution = restitution()});
      if (stop == 1) system.add(Stop{.joint = pin, .lower = 0.0, .restitution = restitution()});
      at += way;
      velocity += spin * Vec<2>(-way[1], way[0]);
      before = bar;
      if (i + 1 == bars) system.add(Point{.body = bar.body, .position = {0.5 * length, 0.0}});
    }
    const auto put = [&](const Vec<2>& normal) {
      const double e = restitution();
      system.add(HalfPlane{.point = at, .normal = normal},
                 Surface{.friction = random.below(3) == 0 ? 0.0 : random.uniform(0.05, 0.8),
                         .normal_restitution = e,
                         .tangential_restitution = e});
    };
    // Its sign such that the tip comes to the plane.
    const Vec<2> floor = Linkage::along(random.uniform(-3.0, 3.0));
    put(floor.dot(velocity) < 0.0 ? floor : Vec<2>(-floor));
    if (random.below(2) == 0) {
      const Vec<2> wall = Linkage::along(random.uniform(-3.0, 3.0));
      put(wall.dot(velocity) < 0.0 ? wall : Vec<2>(-wall));
    }
  }
};

double kinetic(const Simulation& simulation) { return simulation.energy().stored(StoredEnergy::kinetic); }

/// Seen in strikes.
struct Seen {
  int solved = 0;     ///< strikes
  int gains = 0;      ///< of these with impacts that add energy,
  int by_joints = 0;  ///< and friction in joints does too
};

/// Sum of what single impacts add [J]. The contacts of one follow each other in the list.
double gained_by_impacts(const std::vector<EventRecord>& events) {
  double sum = 0.0;
  const EventRecord* last = nullptr;
  for (const EventRecord& event : events) {
    if (event.kind != EventKind::impact && event.kind != EventKind::accumulation) continue;
    const bool same = last != nullptr && last->energy_before == event.energy_before &&
                      last->energy_after == event.energy_after;
    if (!same) sum += std::max(0.0, event.energy_after - event.energy_before);
    last = &event;
  }
  return sum;
}

/// A step from the start, so short that nothing acts but impacts: what is told is what the kinetic energy
/// gains in them.
void expect_told(const Strike& strike, const Mode& mode, const std::string& name, Seen& seen) {
  // Of the energy. In 1e-10 s velocities change by no more where mechanisms are nearly singular.
  constexpr double motion = 1e-6;
  const bool events = std::holds_alternative<EventDriven>(mode);
  Simulation simulation(strike.linkage.scene.system, mode);
  const double before = kinetic(simulation);
  try {
    simulation.step();
  } catch (const SolverError&) {
    return;  // no forces in joints are found for friction this large, or impacts do not come to an end
  }
  ++seen.solved;
  const double told = simulation.report().energy_gain;
  const double gain =
      events ? gained_by_impacts(simulation.events()) : std::max(0.0, kinetic(simulation) - before);
  EXPECT_NEAR(told, gain, motion * (before + gain)) << name;
  EXPECT_EQ(simulation.statistics().energy_gained, told) << name;
  if (!(gain > 10.0 * motion * before)) return;
  EXPECT_GT(simulation.statistics().energy_gains, 0) << name;
  ++seen.gains;
  if (simulation.energy().flow(EnergyFlow::joint_friction) < 0.0) ++seen.by_joints;
}

void expect_told(std::uint64_t seed, bool unequal, bool events, Seen& seen) {
  const Mode mode = events ? Mode(EventDriven{.interval = 1e-10}) : Mode(TimeStepping{.step = 1e-10});
  expect_told(Strike(seed, unequal), mode, "strike " + std::to_string(seed), seen);
}

Seen expect_all_told(const carom_test::SeedRange& seeds, bool unequal, bool events) {
  Seen seen;
  for (std::uint64_t seed = seeds.first; seed < seeds.last; ++seed) expect_told(seed, unequal, events, seen);
  EXPECT_GT(3 * seen.solved, 2 * seeds.count());
  return seen;
}

TEST(JointFrictionGains, WithOneRestitutionOfContactsAndStopsThereAreNone) {
  for (const bool events : {false, true}) EXPECT_EQ(expect_all_told({0, 40}, false, events).gains, 0);
}

// Of a hundred strikes one or two gain, by up to 40 times the energy; these do, 1060 and 1434 by friction in
// joints itself.
TEST(JointFrictionGains, WithUnequalOnesTheyAreTold) {
  for (const bool events : {false, true}) {
    Seen seen;
    for (const std::uint64_t seed : {1005U, 1060U, 1096U, 1258U, 1271U, 1280U, 1386U, 1424U, 1434U}) {
      expect_told(seed, true, events, seen);
    }
    EXPECT_GE(seen.gains, 8);  // one may have no solution that is found
    EXPECT_GE(seen.by_joints, 1);
    expect_all_told({0, 60}, true, events);
  }
}

TEST(JointFrictionGainsLong, AllAreTold) {
  const carom_test::SeedRange seeds = carom_test::seeds_from(1000, 300, 3000);
  for (const bool events : {false, true}) {
    EXPECT_EQ(expect_all_told(seeds, false, events).gains, 0);
    // One of a hundred gains, one of 300 by friction in joints, so that some ranges have none: strikes that
    // surely do are above.
    expect_all_told(seeds, true, events);
  }
}

}  // namespace
