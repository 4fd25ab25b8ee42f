// Located impacts that are slower than the capture speed: where nothing presses the contact they rebound, as
// others do.

#include "tests/energy/ledger_check.h"
#include "tests/integrators/same_run.h"
#include "tests/integrators/time_stepping/located_runs.h"
#include "tests/random.h"
#include "tests/shares.h"
#include "tests/temporary_folder.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::ledger_closes;
using carom_test::located;

constexpr double radius = 0.1;

enum Scene : unsigned {
  particle,
  disc_at_wall,
  box_at_wall,
  disc_at_block,
  two_discs,
  discs_on_floor,
  scenes
};

struct SlowImpact {
  System system;
  BodyId body;
  bool pair = false;
  double radius_of_body = radius;

  SlowImpact(unsigned scene, double restitution, double gap, double speed) {
    system.set_default_law({.friction = 0.0, .normal_restitution = restitution});
    const double height = scene == discs_on_floor ? radius : 0.0;
    if (scene == discs_on_floor) {
      system.add(Gravity{{0.0, -9.81}});
      system.add(HalfPlane{.normal = {0.0, 1.0}});
    }
    if (scene == disc_at_block) {
      system.add(planar::Block{.vertices = {{0.0, -1.0}, {1.0, -1.0}, {1.0, 1.0}, {0.0, 1.0}}});
    } else if (scene <= box_at_wall) {
      system.add(HalfPlane{.normal = {-1.0, 0.0}});
    }
    if (scene == particle) {
      radius_of_body = 0.0;
      body = system.add(Particle{.mass = 1.0, .position = {-gap, 0.0}, .velocity = {speed, 0.0}});
      return;
    }
    body = system.add(
        RigidBody{.mass = disc(1.0, radius), .position = {-gap - radius, height}, .velocity = {speed, 0.0}});
    if (scene == box_at_wall) {
      system.add(
          Polygon{.body = body,
                  .vertices = {{-radius, -radius}, {radius, -radius}, {radius, radius}, {-radius, radius}}});
    } else {
      system.add(Disc{.body = body, .radius = radius});
    }
    pair = scene == two_discs || scene == discs_on_floor;
    if (!pair) return;
    const BodyId other = system.add(RigidBody{.mass = disc(1.0, radius), .position = {radius, height}});
    system.add(Disc{.body = other, .radius = radius});
  }
};

/// One impact, at a time that is the end of a step, the start of the run, or any other.
void expect_rebound(std::uint64_t seed) {
  carom_test::Random random(seed);
  const auto scene = static_cast<unsigned>(seed % scenes);
  const double restitution = random.below(4) == 0 ? 1.0 : random.uniform(0.1, 1.0);
  const double speed = std::pow(10.0, random.uniform(-5.0, -2.05));
  const double step = std::pow(10.0, random.uniform(-4.0, -1.5));
  const auto when = (seed / scenes) % 3;
  const double steps = random.uniform(1.0, 200.0);
  const double gap = when == 0 ? 0.0 : step * speed * (when == 1 ? std::floor(steps) : steps);
  const SlowImpact impact(scene, restitution, gap, speed);
  Simulation simulation(impact.system, located(step));
  const double behind = 20.3 * step;
  simulation.run_until(gap / speed + behind);
  const double after = impact.pair ? 0.5 * speed * (1.0 - restitution) : -restitution * speed;
  const double place = -impact.radius_of_body + after * behind;
  // Gaps are closed to 1e-12 m, or one step of the rounding of places.
  EXPECT_NEAR(simulation.state().velocity(impact.body)[0], after, 1e-6 * speed) << "seed " << seed;
  EXPECT_NEAR(simulation.state().position(impact.body)[0], place, 4e-12) << "seed " << seed;
  EXPECT_EQ(simulation.statistics().cut_sequences, 0) << "seed " << seed;
  EXPECT_TRUE(ledger_closes(simulation.energy())) << "seed " << seed;
}

TEST(SlowImpacts, ReboundWhereNothingPresses) {
  for (std::uint64_t seed = 0; seed < 36; ++seed) expect_rebound(seed);
}

TEST(SlowImpactsLong, ReboundWhereNothingPresses) {
  const carom_test::SeedRange range = carom_test::seeds_from(1000, 600, 6000);
  for (std::uint64_t seed = range.first; seed < range.last; ++seed) expect_rebound(seed);
}

// A contact that loads press does not: bounces come to an end.
TEST(SlowImpacts, EndWhereLoadsPress) {
  for (const unsigned scene : {0U, 1U, 2U}) {
    SlowImpact impact(scene, 0.9, 1e-6, 5e-3);
    impact.system.add(Gravity{{9.81, 0.0}});
    Simulation simulation(impact.system, located(1e-3));
    simulation.run_until(0.01);
    EXPECT_NEAR(simulation.state().velocity(impact.body)[0], 0.0, 1e-14) << scene;
    EXPECT_NEAR(simulation.state().position(impact.body)[0], -impact.radius_of_body, 1e-11) << scene;
  }
}

// What rebounds although it is slow is part of a checkpoint: the contact closes at the end of the step.
TEST(SlowImpacts, GoOnBitForBitAfterACheckpoint) {
  const carom_test::TemporaryFolder folder;
  constexpr double step = 0.125, speed = 0x1p-8;
  const SlowImpact impact(two_discs, 1.0, 4.0 * step * speed, speed);
  Simulation whole(impact.system, located(step));
  whole.run_until(4.0 * step);
  whole.save(folder / "half");
  Simulation rest(impact.system, located(step));
  rest.load(folder / "half");
  whole.run_until(1.0);
  rest.run_until(1.0);
  EXPECT_EQ(carom_test::bits_of(rest), carom_test::bits_of(whole));
  EXPECT_NEAR(whole.state().velocity(impact.body)[0], 0.0, 1e-15);
}

}  // namespace
