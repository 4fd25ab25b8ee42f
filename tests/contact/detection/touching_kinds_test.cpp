#include <carom/contact/detection/body_touches.h>
#include <carom/contact/detection/touching_kinds.h>

#include "tests/contact/detection/placed_model.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>

namespace {

using namespace carom;
using namespace carom::planar;

constexpr ContactFilter of_ground_only{.groups = 2, .touches = 1}, of_all{.groups = 4};

BodyId add_disc(System& system, const ContactFilter& filter) {
  const BodyId body = system.add(RigidBody{.mass = disc(1.0, 0.1)});
  system.add(Disc{.body = body, .radius = 0.1, .filter = filter});
  return body;
}

System with_law() {
  System system;
  system.set_default_law(Surface{.friction = 0.3, .normal_restitution = 0.5});
  return system;
}

TouchingKinds kinds_of(const System& system) {
  const carom_test::PlacedModel model(system);
  const BodyOutlines outlines(model.assembly);
  const auto may_touch = [](const BodyOutline& a, const BodyOutline& b) {
    return !(a.is_point() && b.is_point()) && carom::may_touch(a.filter, b.filter);
  };
  return touching_kinds(outlines.list(), PairFilter(model.assembly), may_touch);
}

void expect_kinds(const System& system, bool any, bool all) {
  const TouchingKinds found = kinds_of(system);
  EXPECT_EQ(found.any, any);
  EXPECT_EQ(found.all, all);
  EXPECT_EQ(Outlines(carom_test::PlacedModel(system).assembly).bodies_touch(), any);
}

TEST(TouchingKinds, OneTouchesNoOther) {
  System system = with_law();
  const BodyId body = add_disc(system, {});
  system.add(Disc{.body = body, .radius = 0.1, .centre = {0.3, 0.0}});
  expect_kinds(system, false, true);
}

TEST(TouchingKinds, FiltersPartAll) {
  System system = with_law();
  for (int i = 0; i < 3; ++i) add_disc(system, of_ground_only);
  expect_kinds(system, false, false);
  add_disc(system, of_all);  // touches them, and they do not touch it
  expect_kinds(system, false, false);
  add_disc(system, {.groups = 1, .touches = 2});
  expect_kinds(system, true, false);
}

TEST(TouchingKinds, AllOfSeveralFilters) {
  System system = with_law();
  add_disc(system, of_all);
  add_disc(system, {.groups = 8});
  expect_kinds(system, true, true);
}

TEST(TouchingKinds, JointsPartTwoBodiesAndNotTheThird) {
  System system = with_law();
  const BodyId one = add_disc(system, {}), two = add_disc(system, {});
  system.add(Revolute{.from = one, .to = two});
  expect_kinds(system, false, false);
  add_disc(system, {});
  expect_kinds(system, true, false);
}

TEST(TouchingKinds, OfVeryManyFiltersNotAllPairsAreLookedAt) {
  System system = with_law();
  // Groups of one side and of the other: none touches its own side. As many kinds as discs.
  constexpr std::uint32_t count = 1000;
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t side = i % 2 == 0 ? 1 : 2, number = i << 2;
    add_disc(system, {.groups = side | number, .touches = 3 - side});
  }
  const carom_test::PlacedModel model(system);
  const BodyOutlines outlines(model.assembly);
  for (const bool touch : {true, false}) {
    std::size_t looks = 0;
    const auto may_touch = [&](const BodyOutline& a, const BodyOutline& b) {
      ++looks;
      return touch && carom::may_touch(a.filter, b.filter);
    };
    const TouchingKinds found = touching_kinds(outlines.list(), PairFilter(model.assembly), may_touch);
    EXPECT_TRUE(found.any);  // where nothing is known, too
    EXPECT_FALSE(found.all);
    EXPECT_LE(looks, 100 * count);
  }
}

TEST(TouchingKinds, PointsDoNotTouchPoints) {
  System system = with_law();
  for (int i = 0; i < 2; ++i) system.add(Point{.body = system.add(RigidBody{.mass = disc(1.0, 0.1)})});
  expect_kinds(system, false, false);
  add_disc(system, {});
  expect_kinds(system, true, false);
}

}  // namespace
