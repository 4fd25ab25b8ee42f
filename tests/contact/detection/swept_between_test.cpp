// Outlines that meet between the ends of a path, at both of which nothing is near: boxes hold all that is
// swept, not the ends alone.

#include "tests/contact/detection/moved_model.h"

#include <carom/carom.h>
#include <carom/contact/detection/swept_pairs.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::add_outline;
using carom_test::MovedModel;

constexpr double pi = std::numbers::pi;

System with_peg(const Vec<2>& centre) {
  System system;
  system.set_default_law({.friction = 0.0, .normal_restitution = 0.0});
  system.add(Peg{.centre = centre, .radius = 0.1});
  return system;
}

/// Number of pairs of outlines that are listed on a path.
std::size_t listed(System system, double span, std::vector<double> accelerations = {}) {
  const MovedModel model(std::move(system), span, std::move(accelerations));
  SweptPairs pairs(model.assembly, model.detector, FlatPairs::all);
  return pairs.find_outlines(model.path).size();
}

// The end of a bar is at half its height at both ends of the path, and at all of it in the middle. What is at
// three times that is never near.
TEST(SweptBetween, AreFoundWhereABarTurns) {
  for (const double height : {1.0, 3.0}) {
    System system = with_peg({0.0, height});
    add_outline(system, {{{-1.0, 0.0}, {1.0, 0.0}}, 0.01},
                {.mass = rod(1.0, 2.0), .angle = pi / 6.0, .spin = 2.0 * pi / 3.0});
    EXPECT_EQ(listed(std::move(system), 1.0), height < 2.0 ? 1U : 0U);
  }
}

// A disc that is thrown up is where it was when it comes down.
TEST(SweptBetween, AreFoundWhereADiscIsThrown) {
  constexpr double g = 9.81, up = 5.0, top = 0.5 * up * up / g;
  for (const double height : {top, 3.0 * top}) {
    System system = with_peg({0.0, height});
    add_outline(system, {{{0.0, 0.0}}, 0.1}, {.mass = disc(1.0, 0.1), .velocity = {0.0, up}});
    EXPECT_EQ(listed(std::move(system), 2.0 * up / g, {0.0, -g, 0.0}), height < 2.0 * top ? 1U : 0U);
  }
}

// A peg goes on an arc about a point, past a disc that rests at the middle of that; or far below one. Of what
// moves against the ground the box is wider by half of the way: far is what does not come so near.
TEST(SweptBetween, AreFoundWhereGroundTurns) {
  for (const bool is_far : {false, true}) {
    const double half_turn = is_far ? 0.1 : pi / 3.0, height = is_far ? 4.0 : 1.0;
    System system;
    system.set_default_law({.friction = 0.0, .normal_restitution = 0.0});
    system.add(Peg{.centre = {0.0, 1.0},
                   .radius = 0.1,
                   .pivot = {0.0, 0.0},
                   .motion = {.angle = [half_turn](double t) { return (2.0 * t - 1.0) * half_turn; },
                              .spin = [half_turn](double) { return 2.0 * half_turn; }}});
    add_outline(system, {{{0.0, 0.0}}, 0.1}, {.mass = disc(1.0, 0.1), .position = {0.0, height}});
    EXPECT_EQ(listed(std::move(system), 1.0), is_far ? 0U : 1U);
  }
}

}  // namespace
