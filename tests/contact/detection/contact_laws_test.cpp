// Laws of contact: found for every pair that may touch, whatever its sides.

#include <carom/contact/detection/body_features.h>
#include <carom/contact/detection/body_pairs.h>
#include <carom/contact/detection/contact_laws.h>
#include <carom/contact/detection/detector.h>
#include <carom/contact/detection/touched_ground.h>

#include "tests/contact/detection/placed_model.h"
#include "tests/model_error.h"

#include <carom/carom.h>
#include <carom/core/constraint_set.h>

#include <gtest/gtest.h>

#include <set>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;

/// A ball of steel and one of nothing; a floor of ice and a wall with a surface of its own.
System scene() {
  System system;
  const MaterialId steel = system.material("steel"), ice = system.material("ice");
  system.add(Particle{.mass = 1.0, .material = steel}, "shot");
  system.add(Particle{.mass = 1.0}, "ball");
  system.add(HalfPlane{.normal = {0, 1}, .material = ice}, "floor");
  system.add(HalfPlane{.normal = {1, 0}}, Surface{.friction = 0.2, .normal_restitution = 0.0}, "wall");
  system.between(steel, ice, {.friction = 0.1, .normal_restitution = 0.0});
  return system;
}

/// What features touch on ground, and by which laws.
struct Touched {
  explicit Touched(const System& system)
      : model(system),
        outlines(model.assembly),
        features(model.assembly),
        touched(model.assembly, features, outlines.shapes(), outlines.laws()) {}

  carom_test::PlacedModel model;
  Outlines outlines;
  BodyFeatures features;
  TouchedGround touched;
};

TEST(TouchedGround, PairsWithoutALawAreRefusedByName) {
  EXPECT_MODEL_ERROR(Touched{scene()}, "contact of particle 'ball' on half-plane 'floor'",
                     "law is not given between no material and material 'ice'",
                     "allowed: a Surface on the obstacle, between the two materials or as default law");
}

TEST(TouchedGround, HasALawForEachPair) {
  System system = scene();
  system.set_default_law({.friction = 0.3, .normal_restitution = 0.0});
  const Touched of(system);
  EXPECT_FALSE(of.touched.facts().static_friction);
  const MaterialId steel = system.material("steel");
  for (Index material = 0; material < 2; ++material) {
    const bool is_steel = of.features.materials()[material].material == steel;
    const auto shapes = of.touched.by(material);
    ASSERT_EQ(shapes.size(), 2U);
    for (Index shape = 0; shape < 2; ++shape) EXPECT_EQ(shapes[shape].shape, shape);
    EXPECT_EQ(of.outlines.laws()[shapes[0].law].friction, is_steel ? 0.1 : 0.3);
    EXPECT_EQ(of.outlines.laws()[shapes[1].law].friction, 0.2);
  }
  system.set_default_law({.friction = 0.3, .normal_restitution = 0.0, .static_friction = 0.4});
  EXPECT_TRUE(Touched(system).touched.facts().static_friction);
}

TEST(TouchedGround, FiltersPartAndPiecesAreTouchedByOutlines) {
  System system;
  system.set_default_law({.friction = 0.3, .normal_restitution = 0.0});
  system.add(Particle{.mass = 1.0});
  system.add(HalfPlane{.normal = {0, 1}});
  system.add(HalfPlane{.normal = {1, 0}, .filter = {.groups = 2, .touches = 2}});
  system.add(Peg{.centre = {0, 5}, .radius = 0.5});
  const Touched of(system);
  ASSERT_EQ(of.touched.by(0).size(), 1U);
  EXPECT_EQ(of.touched.by(0)[0].shape, 0U);
}

// Whatever touches, its pair names the law of its contact, also where a material has several filters.
TEST(ContactLaws, APairNamesItsLaw) {
  System system;
  const MaterialId steel = system.material("steel"), wood = system.material("wood"),
                   ice = system.material("ice");
  const auto law = [](double friction) { return Surface{.friction = friction, .normal_restitution = 0.5}; };
  system.between(steel, ice, law(0.1));
  system.between(wood, ice, law(0.2));
  system.between(steel, wood, law(0.3));
  system.between(steel, steel, law(0.4));
  system.between(wood, wood, law(0.5));
  system.add(HalfPlane{.point = {0.0, -2.0}, .normal = {0, 1}, .material = ice});
  system.add(Terrain{.vertices = {{-3.0, 0.0}, {0.0, 0.1}, {3.0, 0.0}}, .depth = 0.5}, law(0.6));
  system.add(Particle{.mass = 1.0, .position = {0.0, 2.0}, .material = wood});
  for (int i = 0; i < 4; ++i) {
    const BodyId body = system.add(RigidBody{.mass = disc(1.0, 0.1), .position = {1.0 * i, 1.0}});
    system.add(Disc{.body = body,
                    .radius = 0.2,
                    .material = i % 2 == 0 ? steel : wood,
                    .filter = {.groups = i < 2 ? 1U : 3U}});
  }
  const carom_test::PlacedModel model(system);
  const Detector detector(model.assembly);
  GroundPlaces places;
  std::vector<ContactPair> pairs;
  std::vector<Index> bodies;
  for (Index component = 0; component < model.assembly.components().size(); ++component) {
    const auto own = detector.pairs(component);
    pairs.insert(pairs.end(), own.begin(), own.end());
    bodies.push_back(component);
  }
  BodyPairs(detector.outlines()).append(bodies, pairs);
  std::set<double> seen;
  for (const ContactPair& pair : pairs) {
    SingleConstraint contact;
    detector.contact(pair, model.state.view(), model.evaluation, places, contact);
    EXPECT_EQ(detector.law(pair).friction, contact.law.friction);
    EXPECT_FALSE(resists_rolling(detector, pair));
    seen.insert(contact.law.friction);
  }
  EXPECT_EQ(seen, (std::set<double>{0.1, 0.2, 0.3, 0.4, 0.5, 0.6}));
}

TEST(LawFacts, OneLawIsEnoughForAFact) {
  LawFacts facts;
  facts.add(Surface{.friction = 0.3, .normal_restitution = 0.5});
  EXPECT_FALSE(facts.static_friction || facts.other_impact_law || facts.rolling_resistance);
  facts.add(Surface{.friction = 0.3, .normal_restitution = 0.5, .static_friction = 0.4});
  EXPECT_TRUE(facts.static_friction && !facts.other_impact_law && !facts.rolling_resistance);
  facts.add(Surface{.friction = 0.3, .normal_restitution = 0.5, .impact_law = ImpactLaw::poisson});
  facts.add(Surface{.friction = 0.3, .normal_restitution = 0.5, .rolling_resistance = 0.01});
  EXPECT_TRUE(facts.static_friction && facts.other_impact_law && facts.rolling_resistance);
  LawFacts others;
  others.add(facts);
  EXPECT_TRUE(others.static_friction && others.other_impact_law && others.rolling_resistance);
}

}  // namespace
