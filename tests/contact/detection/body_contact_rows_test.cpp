// Rows of contacts of two bodies: those without drift against those with it, products with both rows at once
// against one by one, and a memory of the search before against none.

#include "tests/constraint_sets.h"
#include "tests/contact/detection/placed_model.h"
#include "tests/random.h"

#include <carom/carom.h>
#include <carom/contact/contact_velocity.h>
#include <carom/contact/detection/body_touches.h>
#include <carom/contact/detection/detector.h>
#include <carom/core/constraint_set.h>

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::PlacedModel;
using carom_test::Random;

/// Discs, boxes and particles, close enough for many to overlap.
System crowd() {
  System system;
  system.set_default_law({.friction = 0.3, .normal_restitution = 0.2, .static_friction = 0.4});
  for (int i = 0; i < 30; ++i) {
    const Vec<2> place(0.3 * (i % 6), 0.3 * (i / 6));
    if (i % 5 == 4) {
      system.add(Particle{.mass = 1.0, .position = place});
      continue;
    }
    const BodyId body = system.add(RigidBody{.mass = {.mass = 1.0 + i, .inertia = 0.1}, .position = place});
    if (i % 5 == 3) {
      system.add(Polygon{.body = body, .vertices = {{-0.2, -0.2}, {0.2, -0.2}, {0.2, 0.2}, {-0.2, 0.2}}});
    } else {
      system.add(Disc{.body = body, .radius = 0.17});
    }
  }
  return system;
}

class BodyContactRows : public testing::Test {
protected:
  BodyContactRows() : model_(crowd()), detector_(model_.assembly) { detector_.place(0.0, places_); }

  void shake(double by) {
    for (double& number : model_.state.q) number += random_.uniform(-by, by);
    for (double& number : model_.state.v) number = random_.uniform(-1.0, 1.0);
    model_.update();
  }
  ContactQuery query(const LastingContacts* lasting) const {
    return {model_.state.view(), model_.evaluation, places_, nullptr, 0.0, lasting};
  }

  PlacedModel model_;
  Detector detector_;
  GroundPlaces places_;
  Random random_{7};
};

TEST_F(BodyContactRows, WithoutDriftTheyHaveTheSameBits) {
  const Outlines& outlines = detector_.outlines();
  BodyContactSearch memory;
  std::size_t contacts = 0;
  for (int i = 0; i < 20; ++i) {
    shake(0.02);
    for (const Touch& touch : find_body_touches(outlines, query(nullptr), memory)) {
      SingleConstraint all, rows;
      outlines.write(touch, query(nullptr), all);
      write_rows(outlines, touch, memory, model_.state.view(), rows);
      EXPECT_EQ(rows.key, all.key);
      EXPECT_EQ(carom_test::numbers_of(rows), carom_test::numbers_of(all));
      EXPECT_EQ(rows.gap, all.gap);
      EXPECT_EQ(rows.friction, all.friction);
      EXPECT_EQ(rows.law.friction, all.law.friction);
      EXPECT_EQ(rows.surface_velocity, all.surface_velocity);
      ASSERT_EQ(rows.bodies, all.bodies);
      ASSERT_EQ(rows.rows, all.rows);
      for (std::size_t b = 0; b < 3; ++b) {
        EXPECT_EQ(rows.blocks[b].body, all.blocks[b].body);
        EXPECT_EQ(rows.blocks[b].v, all.blocks[b].v);
        EXPECT_EQ(rows.blocks[b].columns, all.blocks[b].columns);
      }
      ++contacts;
    }
  }
  EXPECT_GT(contacts, 200U);
}

TEST_F(BodyContactRows, ProductsWithBothRowsHaveTheBitsOfEach) {
  BodyContactSearch memory;
  ConstraintSet found;
  shake(0.02);
  detector_.find_between_bodies(query(nullptr), memory, found);
  ASSERT_GT(found.size(), 10U);
  const double* const v = model_.state.v.data();
  for (Constraint& contact : found) {
    contact.surface_velocity = {0.3, -0.2, 0.0};
    const std::array<double, 2> both = times_both_rows(contact, v), speeds = speeds_of_both_rows(contact, v);
    for (int row = 0; row < 2; ++row) {
      EXPECT_EQ(both[static_cast<std::size_t>(row)], contact.times(row, v));
      EXPECT_EQ(speeds[static_cast<std::size_t>(row)], contact.speed(row, v));
    }
  }
}

TEST_F(BodyContactRows, AMemoryOfTheSearchBeforeChangesNothing) {
  BodyContactSearch kept;
  std::vector<std::pair<ConstraintKey, ContactMode>> before;
  for (int i = 0; i < 40; ++i) {
    if (i % 4 != 0) shake(i % 8 == 3 ? 0.05 : 1e-6);  // contacts change, or stay
    LastingContacts lasting;
    detector_.remember(before, 1e-3, {}, lasting);
    const LastingContacts* const known = lasting.empty() ? nullptr : &lasting;
    BodyContactSearch fresh;
    ConstraintSet with, without;
    detector_.find_between_bodies(query(known), kept, with);
    detector_.find_between_bodies(query(known), fresh, without);
    ASSERT_EQ(with.size(), without.size()) << i;
    before.clear();
    for (std::size_t c = 0; c < with.size(); ++c) {
      EXPECT_EQ(with[c].key, without[c].key);
      EXPECT_EQ(carom_test::numbers_of(with[c]), carom_test::numbers_of(without[c]));
      EXPECT_EQ(with[c].allowed_approach, without[c].allowed_approach);
      before.emplace_back(with[c].key, ContactMode::stick);
    }
  }
  EXPECT_GT(before.size(), 10U);
}

}  // namespace
