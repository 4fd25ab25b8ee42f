// Floors whose second top is a little lower: what slides over the ledge tips or drops by micrometres, and
// goes on with its speed, in every mode.

#include "tests/integrators/floor_scenes.h"
#include "tests/random.h"
#include "tests/shares.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace {

using namespace carom_test;
using namespace carom_test::floors;

constexpr double end_time = 1.0;

/// A box, a rod or a particle that slides off a ledge, without friction.
struct Ledge {
  Frame frame{};
  double depth = 1e-5, before = 0.0, speed = 1.0, half = 0.2, high = 0.1, restitution = 0.0;
  double height = 1.0, lower_height = 1.0;  // of the two blocks
  enum class Slider { box, segment, particle } slider = Slider::box;
  bool is_terrain = false;

  [[nodiscard]] double middle() const { return (slider == Slider::particle ? 0.0 : -half) - before; }

  void add_floor(System& system) const {
    if (is_terrain) {
      system.add(Terrain{.vertices = {frame.place(-3.0, 0.0), frame.place(0.0, 0.0), frame.place(0.0, -depth),
                                      frame.place(4.0, -depth)},
                         .depth = height});
      return;
    }
    system.add(tile(frame, -3.0, 0.0, 0.0, height));
    system.add(tile(frame, 0.0, 4.0, -depth, lower_height));
  }
  BodyId add_slider(System& system) const {
    const Vec<2> velocity = frame.direction(speed, 0.0);
    if (slider == Slider::box) return add_box(system, frame, middle(), half, high, speed);
    const Vec<2> place = frame.place(middle(), 0.0);
    if (slider == Slider::particle)
      return system.add(Particle{.mass = 1.0, .position = place, .velocity = velocity});
    const BodyId body = system.add(RigidBody{
        .mass = rod(1.0, 2.0 * half), .position = place, .angle = frame.angle, .velocity = velocity});
    system.add(Segment{.body = body, .from = {-half, 0.0}, .to = {half, 0.0}});
    return body;
  }
  /// Where it is at the end, against where it slides to without ledge: along the floor, and across [m].
  [[nodiscard]] Vec<2> error(Schedule run) const {
    System system = empty(frame, {.friction = 0.0, .normal_restitution = restitution});
    add_floor(system);
    const BodyId body = add_slider(system);
    const Simulation simulation = run_of(system, run, end_time);
    const Vec<2> wanted =
        frame.place(middle() + speed * end_time, (slider == Slider::box ? high : 0.0) - depth);
    const Vec<2> off = simulation.state().position(body) - wanted;
    return {off.dot(frame.direction(1.0, 0.0)), off.dot(frame.direction(0.0, 1.0))};
  }
  /// What the fall gives: along the floor by the slope of what tips, across by what still bounces [m].
  void expect_passed(Schedule run) const {
    SCOPED_TRACE(name(run) + ", " + std::to_string(1e6 * depth) + " um");
    const Vec<2> off = error(run);
    // The fall of a long body turns m g depth / 2 into speed: v dv = g depth.
    EXPECT_LT(std::abs(off[0]), (1e-3 + 2.0 * g * depth / (speed * speed)) * speed * end_time);
    // Time stepping may miss a closing by the fall of a step.
    const double fall = run == Schedule::at_step_start ? 2.0 * g * 1e-6 : 1e-6;
    EXPECT_LT(std::abs(off[1]), 2.0 * depth + fall);
  }
};

// The scene of the issue: the rear corner of the box ended at the corner of the ledge.
TEST(LowerLedges, ABoxSlidesOffALedgeOfTenMicrometres) {
  for (const Schedule run : runs) Ledge{.before = -0.15}.expect_passed(run);
}

// A rod lies over the corner of the lower top, a micrometre above it.
TEST(LowerLedges, ARodTipsOntoTheLowerTop) {
  for (const double depth : {1e-7, 1e-6, 1e-5, 1e-4}) {
    for (const Schedule run : runs)
      Ledge{.depth = depth, .before = 0.05, .half = 0.35, .slider = Ledge::Slider::segment}.expect_passed(
          run);
  }
}

// Where a corner of a box that has tipped comes off the ledge, it does not touch the top once more.
TEST(LowerLedges, ABoxThatHasTippedLeavesTheLedgeWithoutImpact) {
  System system = empty({}, {.friction = 0.0, .normal_restitution = 0.0});
  system.add(tile({}, -3.0, 0.0, 0.0, 1.0));
  const BodyId body = add_box(system, {}, -0.11, 0.1, 0.05, 1.0);
  Simulation simulation(system, EventDriven{});
  simulation.run_until(0.3);
  for (const EventRecord& event : simulation.events()) EXPECT_NE(event.kind, EventKind::impact);
  EXPECT_LT(simulation.state().spin(body), -1.0);
}

Ledge random_ledge(std::uint64_t seed) {
  Random random(seed);
  Ledge ledge;
  if (random.below(3) > 0) ledge.frame.angle = random.uniform(-3.0, 3.0);
  if (random.below(3) > 0) ledge.frame.origin = random.vec<2>(10.0);
  ledge.depth = std::pow(10.0, random.uniform(-7.0, -4.0));
  const unsigned start = random.below(3);
  ledge.before =
      start == 0 ? 0.0 : std::pow(10.0, random.uniform(start == 1 ? -16.0 : -4.0, start == 1 ? -9.0 : -1.0));
  ledge.speed = random.uniform(0.5, 2.0);
  ledge.half = random.uniform(0.05, 0.3);
  ledge.high = random.uniform(0.02, 0.3);
  ledge.restitution = random.below(2) == 0 ? 0.0 : 0.3;
  ledge.height = random.uniform(0.2, 1.0);
  ledge.lower_height = random.below(2) == 0 ? ledge.height - ledge.depth : random.uniform(0.2, 1.0);
  ledge.slider = static_cast<Ledge::Slider>(random.below(3));
  ledge.is_terrain = random.below(4) == 0;
  return ledge;
}

void expect_all_pass(SeedRange seeds) {
  for (std::uint64_t seed = seeds.first; seed < seeds.last; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    for (const Schedule run : runs) EXPECT_NO_THROW(random_ledge(seed).expect_passed(run));
  }
}

TEST(LowerLedges, AllSlidersPassAllLedges) { expect_all_pass(seeds_from(1, count_of_samples(40U))); }

TEST(LowerLedgesLong, AllSlidersPassAllLedges) { expect_all_pass(seeds_from(100, 1000, 20000)); }

}  // namespace
