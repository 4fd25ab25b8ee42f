#include <carom/contact/detection/body_features.h>
#include <carom/contact/detection/ground_laws.h>
#include <carom/contact/detection/ground_shapes.h>

#include "tests/contact/detection/placed_model.h"
#include "tests/model_error.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

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

TEST(GroundLaws, PairsWithoutOneAreRefusedByName) {
  const carom_test::PlacedModel model(scene());
  const BodyFeatures features(model.assembly);
  const GroundShapes shapes(model.assembly.system());
  EXPECT_MODEL_ERROR(GroundLaws(model.assembly, features, shapes),
                     "contact of particle 'ball' on half-plane 'floor'",
                     "law is not given between no material and material 'ice'",
                     "allowed: a Surface on the obstacle, between the two materials or as default law");
}

TEST(GroundLaws, AreLookedUpByPair) {
  System system = scene();
  system.set_default_law({.friction = 0.3, .normal_restitution = 0.0});
  const carom_test::PlacedModel model(system);
  const BodyFeatures features(model.assembly);
  const GroundShapes shapes(model.assembly.system());
  const GroundLaws laws(model.assembly, features, shapes);
  EXPECT_FALSE(laws.facts().static_friction);
  const MaterialId steel = system.material("steel");
  for (Index material = 0; material < 2; ++material) {
    const bool is_steel = features.materials()[material].material == steel;
    EXPECT_EQ(laws.law(material, 0).friction, is_steel ? 0.1 : 0.3);
    EXPECT_EQ(laws.law(material, 1).friction, 0.2);
  }
  system.set_default_law({.friction = 0.3, .normal_restitution = 0.0, .static_friction = 0.4});
  const carom_test::PlacedModel other(system);
  EXPECT_TRUE(GroundLaws(other.assembly, BodyFeatures(other.assembly), GroundShapes(other.assembly.system()))
                  .facts()
                  .static_friction);
}

TEST(LawFacts, OneLawIsEnoughForAFact) {
  LawFacts facts;
  facts.add({.friction = 0.3, .normal_restitution = 0.5});
  EXPECT_FALSE(facts.static_friction || facts.other_impact_law || facts.rolling_resistance);
  facts.add({.friction = 0.3, .normal_restitution = 0.5, .static_friction = 0.4});
  EXPECT_TRUE(facts.static_friction && !facts.other_impact_law && !facts.rolling_resistance);
  facts.add({.friction = 0.3, .normal_restitution = 0.5, .impact_law = ImpactLaw::poisson});
  facts.add({.friction = 0.3, .normal_restitution = 0.5, .rolling_resistance = 0.01});
  EXPECT_TRUE(facts.static_friction && facts.other_impact_law && facts.rolling_resistance);
}

}  // namespace
