// Depths of two outlines on a path, against closed forms; and that none is missed, against looks at many
// times.

#include "tests/contact/detection/moved_model.h"
#include "tests/random.h"
#include "tests/shares.h"

#include <carom/carom.h>
#include <carom/contact/detection/outline_depth.h>
#include <carom/core/numerics/never.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::add_outline;
using carom_test::body_outline;
using carom_test::ground_outline;
using carom_test::MovedModel;
using carom_test::OwnedOutline;
using carom_test::Random;
using carom_test::random_accelerations;
using carom_test::random_outline;
using carom_test::reference_gap;

constexpr double rounding = 1e-13;  // numbers of about 1
constexpr double fine = 1e-7;       // [m]
constexpr NearOutlines of_bodies{.a = 0, .b = 1}, of_ground{.a = 0, .piece = 0};

OwnedOutline round_outline(double radius) { return {{{0.0, 0.0}}, radius}; }
OwnedOutline box_outline(double x, double y) { return {{{-x, -y}, {x, -y}, {x, y}, {-x, y}}}; }

System with_law() {
  System system;
  system.set_default_law({.friction = 0.0, .normal_restitution = 0.0});
  return system;
}

/// Adds a body with an outline.
void add(System& system, const OwnedOutline& outline, const Vec<2>& place, const Vec<2>& velocity,
         double spin = 0.0) {
  add_outline(system, outline,
              {.mass = disc(1.0, 0.1), .position = place, .velocity = velocity, .spin = spin});
}

/// The first time of a level; no other is of interest.
double first(MovedModel& model, const NearOutlines& of, double level, double until = never) {
  OutlineDepth depth(model.detector);
  return depth.first(model.path, of, level, fine, until);
}

/// Expects a time at which a gap is at a level, or less than `fine` below: where it falls at a rate.
void expect_found(double found, double exact, double rate) {
  EXPECT_GE(found, exact - rounding);
  EXPECT_LE(found, exact + fine / rate + rounding);
}

MovedModel discs_that_meet() {
  System system = with_law();
  add(system, round_outline(0.1), {-1.0, 0.0}, {2.0, 0.0});
  add(system, round_outline(0.2), {1.0, 0.0}, {-1.0, 0.0});
  return {std::move(system), 1.0};
}

// They go through each other: at the end they are apart again.
TEST(OutlineDepth, OfTwoDiscsIsTheirDistance) {
  MovedModel model = discs_that_meet();
  OutlineDepth depth(model.detector);
  EXPECT_NEAR(depth.gap_at_begin(model.path, of_bodies), 2.0 - 0.3, rounding);
  EXPECT_NEAR(depth.gap_at_end(model.path, of_bodies), 1.0 - 0.3, rounding);
  for (const double level : {-1e-6, -0.05, -0.2})
    expect_found(first(model, of_bodies, level), (1.7 - level) / 3.0, 3.0);
}

TEST(OutlineDepth, IsNeverReachedByLessThanTheDeepest) {
  MovedModel model = discs_that_meet();
  // The deepest is -0.3, where the centres meet.
  EXPECT_LT(first(model, of_bodies, -0.3 + 1e-6), never);
  EXPECT_EQ(first(model, of_bodies, -0.3 - 1e-6), never);
}

TEST(OutlineDepth, OfNoInterestIsNotFound) {
  MovedModel model = discs_that_meet();
  const double exact = 1.8 / 3.0;  // at a depth of 0.1
  EXPECT_EQ(first(model, of_bodies, -0.1, exact - 1e-3), never);
  expect_found(first(model, of_bodies, -0.1, exact + 1e-3), exact, 3.0);
}

TEST(OutlineDepth, AtTheBeginIsFoundThere) {
  System system = with_law();
  add(system, round_outline(0.1), {0.05, 0.0}, {1.0, 0.0});
  add(system, round_outline(0.1), {0.0, 0.0}, {0.0, 0.0});
  MovedModel model(std::move(system), 1.0, {}, 3.0);
  EXPECT_EQ(first(model, of_bodies, -0.15 + 1e-12), 3.0);
  EXPECT_EQ(first(model, of_bodies, -0.16), never);  // it goes out
}

// A disc that is thrown up on a box comes down through it: at the end it is nearer to the lower side.
TEST(OutlineDepth, OfABoxAndADiscOnAParabola) {
  constexpr double g = 9.81, up = 1.0, high = 0.5, reach = 0.2 + 0.1;
  System system = with_law();
  add(system, box_outline(1.0, 0.2), {0.0, 0.0}, {0.0, 0.0});
  add(system, round_outline(0.1), {0.3, high}, {0.2, up});
  MovedModel model(std::move(system), 0.5, {0.0, 0.0, 0.0, 0.0, -g, 0.0});
  OutlineDepth depth(model.detector);
  EXPECT_NEAR(depth.gap_at_begin(model.path, of_bodies), high - reach, rounding);
  EXPECT_NEAR(depth.gap_at_end(model.path, of_bodies), std::abs(high + 0.5 * up - 0.125 * g) - reach,
              rounding);
  for (const double level : {-1e-3, -0.1, -0.25}) {
    const double root = std::sqrt(up * up + 2.0 * g * (high - reach - level));
    expect_found(first(model, of_bodies, level), (up + root) / g, root);
  }
}

// The side of a bar that turns comes down on a disc that is at rest; then its corner is beside it.
TEST(OutlineDepth, OfABarThatTurnsIntoADisc) {
  constexpr double spin = 2.0, half = 0.05, radius = 0.1, at = 0.8, angle = 0.9;
  System system = with_law();
  add(system, box_outline(1.0, half), {0.0, 0.0}, {0.0, 0.0}, spin);
  add(system, round_outline(radius), at * Vec<2>(std::cos(angle), std::sin(angle)), {0.0, 0.0});
  MovedModel model(std::move(system), 1.0);
  OutlineDepth depth(model.detector);
  const auto gap = [&](double t) {
    const double x = at * std::abs(std::cos(angle - spin * t)), y = at * std::abs(std::sin(angle - spin * t));
    return std::hypot(std::max(x - 1.0, 0.0), y - half) - radius;  // y > half at both ends
  };
  EXPECT_NEAR(depth.gap_at_begin(model.path, of_bodies), gap(0.0), rounding);
  EXPECT_NEAR(depth.gap_at_end(model.path, of_bodies), gap(1.0), rounding);
  for (const double level : {-1e-3, -0.05, -0.12}) {
    const double turned = std::asin((level + half + radius) / at);
    expect_found(first(model, of_bodies, level), (angle - turned) / spin, spin * at * std::cos(turned));
  }
  EXPECT_EQ(first(model, of_bodies, -half - radius - 1e-6), never);
}

TEST(OutlineDepth, OfADiscThroughAThinWallThatIsFarAtBothEnds) {
  constexpr double half = 1e-3, radius = 0.1, way = 20.0;
  System system = with_law();
  system.add(Wall{.from = {0.0, -1.0}, .to = {0.0, 1.0}, .radius = half});
  add(system, round_outline(radius), {-0.5 * way, 0.1}, {way, 0.0});
  MovedModel model(std::move(system), 1.0);
  OutlineDepth depth(model.detector);
  EXPECT_NEAR(depth.gap_at_begin(model.path, of_ground), 0.5 * way - radius - half, rounding * way);
  const double level = -0.01;
  expect_found(first(model, of_ground, level), (0.5 * way - radius - half - level) / way, way);
}

TEST(OutlineDepth, OfADiscInACircleIsHowFarItIsOutside) {
  System system = with_law();
  system.add(CircleInside{.centre = {0.5, 0.0}, .radius = 1.0});
  add(system, round_outline(0.1), {0.5, 0.3}, {2.0, 0.0});
  MovedModel model(std::move(system), 1.0);
  OutlineDepth depth(model.detector);
  EXPECT_NEAR(depth.gap_at_begin(model.path, of_ground), 0.6, rounding);
  EXPECT_NEAR(depth.gap_at_end(model.path, of_ground), 0.9 - std::hypot(2.0, 0.3), rounding);
  const double from_centre = 0.9 + 0.05, along = std::sqrt(from_centre * from_centre - 0.09);
  expect_found(first(model, of_ground, -0.05), along / 2.0, 2.0 * along / from_centre);
}

TEST(OutlineDepth, OfGroundThatMovesIntoABody) {
  System system = with_law();
  system.add(Peg{.centre = {2.0, 0.0},
                 .radius = 0.3,
                 .motion = {.displacement = [](double t) { return Vec<2>(-t * t, 0.0); },
                            .velocity = [](double t) { return Vec<2>(-2.0 * t, 0.0); }}});
  add(system, round_outline(0.2), {0.5, 0.0}, {0.0, 0.0});
  MovedModel model(std::move(system), 1.5);
  OutlineDepth depth(model.detector);
  EXPECT_NEAR(depth.gap_at_begin(model.path, of_ground), 1.0, rounding);
  EXPECT_NEAR(depth.gap_at_end(model.path, of_ground), 0.75 - 0.5, rounding);
  expect_found(first(model, of_ground, -0.1), std::sqrt(1.1), 2.0 * std::sqrt(1.1));
}

TEST(OutlineDepth, NamesTheContactOfBoth) {
  System system = with_law();
  system.add(Wall{.from = {0.0, -1.0}, .to = {0.0, 1.0}, .radius = 0.1});
  add(system, round_outline(0.1), {-1.0, 0.1}, {1.0, 0.0});
  add(system, box_outline(0.3, 0.2), {-1.0, 2.0}, {1.0, 0.0});
  const MovedModel model(std::move(system), 1.0);
  OutlineDepth depth(model.detector);
  const Outlines& outlines = model.detector.outlines();
  const std::optional<ContactPair> with_wall = outlines.pair_of(depth.key_at_begin(model.path, of_ground));
  ASSERT_TRUE(with_wall);
  EXPECT_EQ(with_wall->body, 0U);
  EXPECT_EQ(with_wall->outline, outlines.of_ground(0));
  const std::optional<ContactPair> with_box = outlines.pair_of(depth.key_at_begin(model.path, of_bodies));
  ASSERT_TRUE(with_box);
  EXPECT_EQ(with_box->feature, 0U);  // the centre of the disc
  EXPECT_EQ(with_box->outline, 1U);
  // In whichever order they are given.
  EXPECT_EQ(depth.key_at_begin(model.path, {.a = 1, .b = 0}), depth.key_at_begin(model.path, of_bodies));
}

/// Two bodies that meet, or a body and a block that turns about itself.
MovedModel random_meeting(Random& random, bool on_ground) {
  System system = with_law();
  const double spin = random.uniform(-6.0, 6.0);
  if (on_ground) {
    system.add(planar::Block{
        .vertices = {{-1.0, -0.1}, {1.0, -0.2}, {0.8, 0.3}},
        .radius = random.uniform(0.0, 0.1),
        .motion = {.angle = [spin](double t) { return spin * t; }, .spin = [spin](double) { return spin; }}});
  }
  for (int i = on_ground ? 1 : 0; i < 2; ++i) {
    const double side = i == 0 ? -1.0 : 1.0;
    const OwnedOutline outline = random_outline(random);
    const Vec<2> place = Vec<2>(2.0 * side, 0.0) + random.vec<2>(0.7);
    const Vec<2> velocity = Vec<2>(-4.0 * side, 0.0) + random.vec<2>(3.0);
    add(system, outline, place, velocity, random.uniform(-8.0, 8.0));
  }
  return {std::move(system), 1.0, random_accelerations(random, on_ground ? 1 : 2, 4.0)};
}

TEST(OutlineDepth, MissesNoLevel) {
  Random random(3);
  constexpr int looks = 60, trials = carom_test::count_of_samples(400);
  constexpr double coarse = 1e-3, wrong = 1e-12;
  int reached = 0, open = 0;
  for (int trial = 0; trial < trials; ++trial) {
    const bool on_ground = trial % 2 == 0;
    MovedModel model = random_meeting(random, on_ground);
    const NearOutlines of = on_ground ? of_ground : of_bodies;
    const auto gap = [&](double time) {
      const State at = model.at(time);
      const OwnedOutline other = on_ground ? ground_outline(model, 0, time) : body_outline(model, 1, at);
      return static_cast<double>(reference_gap(body_outline(model, 0, at), other).gap);
    };
    OutlineDepth depth(model.detector);
    if (depth.gap_at_begin(model.path, of) == never) continue;  // two points
    EXPECT_NEAR(depth.gap_at_begin(model.path, of), gap(0.0), wrong);
    EXPECT_NEAR(depth.gap_at_end(model.path, of), gap(1.0), wrong);
    const double level = -random.uniform(1e-3, 0.4);
    const double found = depth.first(model.path, of, level, coarse, never);
    (found < never ? reached : open) += 1;
    if (found < never) {
      EXPECT_LE(gap(found), level + wrong) << trial;
      // It is not too late either, but where it begins deeper.
      if (found > 0.0) {
        EXPECT_GE(gap(found), level - coarse - wrong) << trial;
      }
    }
    for (int look = 0; look <= looks; ++look) {
      const double time = std::min(1.0, found) * look / looks;
      if (time < found) {
        EXPECT_GE(gap(time), level - coarse - wrong) << trial << ' ' << look;
      }
    }
  }
  EXPECT_GT(reached, trials / 4);
  EXPECT_GT(open, trials / 8);
}

}  // namespace
