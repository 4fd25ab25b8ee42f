#include <carom/contact/detection/contact_look.h>

#include "tests/contact/detection/placed_model.h"

#include <carom/carom.h>
#include <carom/core/constraint_set.h>

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;

/// Two boxes, the upper one turned and with a corner in the lower one, which lies on a peak of terrain, has a
/// corner in a tilted block, and another one in a half-plane.
System piled() {
  System system;
  system.set_default_law({.friction = 0.5, .normal_restitution = 0.0});
  system.add(HalfPlane{.point = {0.0, -0.099}, .normal = {0.0, 1.0}});
  system.add(Terrain{.vertices = {{-1.0, -1.0}, {-0.05, -0.098}, {1.0, -1.0}}, .depth = 0.1}, "peak");
  system.add(planar::Block{.vertices = {{0.0, -0.3}, {0.4, -0.3}, {0.4, 0.11}}}, "tilted");
  for (int i = 0; i < 2; ++i) {
    const BodyId body =
        system.add(RigidBody{.mass = box(1.0, 0.4, 0.2), .position = {0.03 * i, 0.28 * i}, .angle = 0.9 * i});
    system.add(Polygon{.body = body, .vertices = {{-0.2, -0.1}, {0.2, -0.1}, {0.2, 0.1}, {-0.2, 0.1}}});
  }
  return system;
}

class ContactLookTest : public testing::Test {
protected:
  const carom_test::PlacedModel model{piled()};
  const Detector detector{model.assembly};
  ContactLook look{model.assembly, detector};
  ConstraintSet found;
};

TEST_F(ContactLookTest, FindsWhatTheDetectorFinds) {
  GroundPlaces places;
  detector.place(0.0, places);
  BodyContactSearch search;
  ConstraintSet expected;
  expected.add();
  look.find(model.state.view(), 1.0, expected);  // what was there before is left out
  look.find(model.state.view(), 0.0, found);
  EXPECT_LT(found.size(), expected.size());
  expected.clear();
  detector.find_all({model.state.view(), model.evaluation, places}, search, expected);
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(found[i].key, expected[i].key);
    EXPECT_EQ(found[i].gap, expected[i].gap);
  }
}

// A key names the pair whose contact it is the key of: a vertex of a body or of the ground, and an outline.
TEST_F(ContactLookTest, KeysNameTheirPairs) {
  look.find(model.state.view(), 0.0, found);
  int of_bodies = 0, of_ground_vertices = 0, of_ground_outlines = 0, without_outlines = 0;
  for (const Constraint& contact : found) {
    SCOPED_TRACE(detector.name(contact.key));
    const std::optional<ContactPair> pair = detector.outlines().pair_of(contact.key);
    if (!pair) {
      ++without_outlines;
      EXPECT_NE(detector.name(contact.key).find("half-plane"), std::string::npos);
      continue;
    }
    ++(pair->other != none                                        ? of_bodies
       : detector.outlines().ground_vertex(pair->feature) != none ? of_ground_vertices
                                                                  : of_ground_outlines);
    SingleConstraint again;
    look.contact(*pair, model.state.view(), again);
    EXPECT_EQ(again.key, contact.key);
    EXPECT_NEAR(again.gap, contact.gap, 1e-15);  // rounding of places of up to 1 m
  }
  EXPECT_GT(of_bodies, 0);
  EXPECT_GT(of_ground_vertices, 0);
  EXPECT_GT(of_ground_outlines, 0);
  EXPECT_GT(without_outlines, 0);
}

TEST_F(ContactLookTest, KeysOfWhatIsNotThereNameNothing) {
  look.find(model.state.view(), 0.0, found);
  for (const Constraint& contact : found) {
    ConstraintKey other = contact.key;
    other.b.serial += 100;
    EXPECT_FALSE(detector.outlines().pair_of(other)) << detector.name(contact.key);
    other = contact.key;
    other.a.feature += 100;
    EXPECT_FALSE(detector.outlines().pair_of(other));
  }
  EXPECT_FALSE(
      detector.outlines().pair_of({{FeatureKey::Owner::joint, 0, 0}, {FeatureKey::Owner::joint, 0, 0}}));
}

}  // namespace
