// Outlines of bodies and on ground in one list: numbers, laws, pairs and their names.

#include <carom/contact/detection/body_materials.h>
#include <carom/contact/detection/body_pairs.h>
#include <carom/contact/detection/detector.h>
#include <carom/contact/detection/outlines.h>

#include "tests/contact/detection/placed_model.h"
#include "tests/random.h"

#include <carom/carom.h>
#include <carom/core/constraint_set.h>

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::PlacedModel;
using carom_test::Random;

constexpr double unlike = 0.01;  // by how much coefficients of two laws differ

/// Boxes and discs of three materials over terrain, a peg, a box of the ground and a half-plane; laws between
/// all of them but stone and wood, each with a coefficient of its own.
System scene(bool bodies_touch) {
  System system;
  const std::vector<std::string> names{"steel", "wood", "stone"};
  std::vector<MaterialId> materials;
  for (const std::string& name : names) materials.push_back(system.material(name));
  const MaterialId floor = system.material("floor");
  double friction = 0.1;
  for (std::size_t a = 0; a < materials.size(); ++a) {
    system.between(materials[a], floor, {.friction = friction += unlike, .normal_restitution = 0.0});
    for (std::size_t b = a; bodies_touch && b < materials.size(); ++b) {
      if (a == 1 && b == 2) continue;  // wood and stone
      system.between(materials[a], materials[b], {.friction = friction += unlike, .normal_restitution = 0.0});
    }
  }
  system.add(HalfPlane{.point = {0.0, -2.0}, .normal = {0.0, 1.0}, .material = floor});
  system.add(Terrain{.vertices = {{-3.0, 0.0}, {0.0, 0.1}, {3.0, 0.0}}, .depth = 0.5, .material = floor});
  system.add(Peg{.centre = {0.0, 1.0}, .radius = 0.2, .material = floor});
  system.add(BoxInside{.lower = {-5.0, -5.0}, .upper = {5.0, 5.0}, .material = floor});
  for (int i = 0; i < 6; ++i) {
    const BodyId body = system.add(RigidBody{.mass = disc(1.0, 0.2), .position = {0.9 * i - 2.0, 3.0}});
    const MaterialId material = materials[static_cast<std::size_t>(i % 3)];
    if (i % 2 == 0) {
      system.add(Disc{.body = body, .radius = 0.2, .material = material});
    } else {
      system.add(Polygon{.body = body,
                         .vertices = {{-0.2, -0.1}, {0.2, -0.1}, {0.2, 0.1}, {-0.2, 0.1}},
                         .material = material});
    }
  }
  return system;
}

TEST(Outlines, VerticesAndOutlinesHaveNumbersOfTheirOwn) {
  const PlacedModel model(scene(true));
  const Outlines outlines(model.assembly);
  const auto of_bodies = static_cast<Index>(outlines.of_bodies().list().size());
  const auto on_ground = static_cast<Index>(outlines.on_ground().outlines().size());
  ASSERT_EQ(of_bodies, 6U);
  ASSERT_GT(on_ground, 2U);
  Index vertices = 0;
  for (Index outline = 0; outline < of_bodies + on_ground; ++outline) {
    EXPECT_EQ(outlines.is_on_ground(outline), outline >= of_bodies);
    if (outlines.is_on_ground(outline)) {
      EXPECT_EQ(outlines.of_ground(outlines.on_ground(outline)), outline);
      EXPECT_EQ(outlines.features(outline).key.owner, FeatureKey::Owner::obstacle);
    }
    for (Index i = 0; i < outlines.features(outline).vertices.size(); ++i, ++vertices) {
      EXPECT_EQ(outlines.outline_of(vertices), outline);
      const Index ground = outlines.ground_vertex(vertices);
      EXPECT_EQ(ground == none, !outlines.is_on_ground(outline));
      if (ground != none) {
        EXPECT_EQ(outlines.of_ground_vertex(ground), vertices);
      }
    }
  }
  EXPECT_EQ(vertices, outlines.of_bodies().vertices().size() + outlines.on_ground().vertices().size());
}

TEST(Outlines, LawsAreThoseOfTheSystem) {
  const PlacedModel model(scene(true));
  const Outlines outlines(model.assembly);
  const System& system = model.assembly.system();
  const BodyOutlines& bodies = outlines.of_bodies();
  const std::vector<MaterialId> materials = body_materials(system);
  int missing = 0, with_ground = 0;
  for (Index a = 0; a < bodies.list().size(); ++a) {
    const MaterialId material = materials[bodies.list()[a].material];
    for (Index b = 0; b < outlines.of_ground(static_cast<Index>(outlines.on_ground().outlines().size()));
         ++b) {
      const bool of_ground = outlines.is_on_ground(b);
      const auto expected =
          of_ground
              ? system.law(material,
                           outlines.shapes().id(outlines.on_ground().outlines()[outlines.on_ground(b)].shape))
              : system.law(material, materials[bodies.list()[b].material]);
      const bool found = outlines.number_of_law(a, b) != none;
      ASSERT_EQ(found, expected.has_value());
      missing += found ? 0 : 1;
      with_ground += found && of_ground ? 1 : 0;
      if (found) {
        EXPECT_EQ(outlines.law(a, b).friction, expected->friction);
      }
      if (!of_ground && a != b) {
        EXPECT_EQ(outlines.laws().may_touch(bodies.list()[a], bodies.list()[b]), found);
      }
    }
  }
  EXPECT_GT(missing, 0);
  EXPECT_GT(with_ground, 0);
}

// A pair is named by the key of its contact, and the key names the pair.
TEST(Outlines, KeysAndPairsNameEachOther) {
  const PlacedModel model(scene(true));
  const Detector detector(model.assembly);
  const Outlines& outlines = detector.outlines();
  GroundPlaces places;
  detector.place(0.0, places);
  int pairs = 0;
  const auto expect_named = [&](const ContactPair& pair) {
    if (!pair.has_outline()) return;
    SingleConstraint contact;
    detector.contact(pair, model.state.view(), model.evaluation, places, contact);
    const std::optional<ContactPair> found = outlines.pair_of(contact.key);
    ASSERT_TRUE(found) << detector.name(contact.key);
    EXPECT_EQ(*found, pair) << detector.name(contact.key);
    EXPECT_EQ(contact.law.friction, detector.law(pair).friction);
    ++pairs;
  };
  for (Index component = 0; component < model.assembly.components().size(); ++component) {
    for (const ContactPair& pair : detector.pairs(component)) expect_named(pair);
  }
  const int with_ground = pairs;
  std::vector<Index> bodies;
  for (Index body = 0; body < 6; ++body) bodies.push_back(body);
  std::vector<ContactPair> between;
  BodyPairs(outlines).append(bodies, between);
  for (const ContactPair& pair : between) expect_named(pair);
  EXPECT_GT(with_ground, 20);
  EXPECT_GT(pairs, with_ground + 20);
}

TEST(Outlines, BodiesThatTouchNothingHaveNone) {
  System system;
  system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = 0.1, .normal_restitution = 0.0});
  const BodyId body = system.add(RigidBody{.mass = disc(1.0, 0.2)});
  system.add(Disc{.body = body, .radius = 0.2});
  const Outlines without(PlacedModel(system).assembly);
  EXPECT_TRUE(without.of_bodies().empty());
  EXPECT_FALSE(without.bodies_touch());
  const PlacedModel model(scene(false));
  const Outlines of_ground_alone(model.assembly);
  EXPECT_FALSE(of_ground_alone.bodies_touch());
  EXPECT_TRUE(of_ground_alone.ground_touches());
  EXPECT_EQ(of_ground_alone.number_of_law(0, 1), none);
}

}  // namespace
