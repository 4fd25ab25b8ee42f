#include <carom/bodies/particle.h>
#include <carom/bodies/rigid_body.h>
#include <carom/bodies/shape_disc.h>
#include <carom/contact/detection/half_space.h>
#include <carom/core/system.h>
#include <carom/joints/gravity.h>
#include <carom/joints/spring_damper.h>

#include "tests/model_error.h"
#include "tests/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

const Surface smooth{.friction = 0.0, .normal_restitution = 0.5};

Particle particle(double mass = 1.0) { return {.mass = mass}; }

double mass_of(const System& system, BodyId id) {
  return system.body_kinds().kind_of(id.serial).mass(system.body_kinds().place(id.serial).slot);
}

TEST(System, StartsEmpty) {
  const System system;
  EXPECT_EQ(system.dimension(), 0);
  EXPECT_TRUE(system.bodies().empty());
  EXPECT_TRUE(system.elements().empty());
  EXPECT_TRUE(system.shapes().empty());
  EXPECT_TRUE(system.obstacles().empty());
  EXPECT_NE(system.token(), System().token());
}

TEST(System, GivesIdentitiesInOrder) {
  System system;
  const BodyId a = system.add(particle());
  const BodyId b = system.add(RigidBody{.mass = disc(1.0, 1.0)});
  const BodyId c = system.add(particle());
  EXPECT_EQ(system.bodies(), (std::vector<BodyId>{a, b, c}));
  EXPECT_TRUE(system.contains(b));
  EXPECT_FALSE(system.contains(BodyId{}));
  EXPECT_FALSE(system.contains(ground));
  EXPECT_FALSE(system.has_orientation(a));
  EXPECT_TRUE(system.has_orientation(b));
  EXPECT_FALSE(system.has_orientation(ground));
}

TEST(System, NamesPartsByNameOrNumber) {
  System system;
  const BodyId upper = system.add(particle(), "upper");
  const BodyId other = system.add(particle());
  const ElementId spring = system.add(SpringDamper{.from = upper, .to = other}, "upper");  // another role
  const ObstacleId floor = system.add(HalfPlane{.normal = {0, 1}}, smooth, "floor");
  const BodyId plate = system.add(RigidBody{.mass = disc(1.0, 1.0)});
  const ShapeId rim = system.add(Disc{.body = plate, .radius = 1.0}, "rim");
  EXPECT_EQ(system.body("upper"), upper);
  EXPECT_EQ(system.element("upper"), spring);
  EXPECT_EQ(system.obstacle("floor"), floor);
  EXPECT_EQ(system.shape("rim"), rim);
  EXPECT_EQ(system.name(upper), "particle 'upper'");
  EXPECT_EQ(system.name(other), "particle #1");
  EXPECT_EQ(system.name(spring), "spring-damper 'upper'");
  EXPECT_EQ(system.name(floor), "half-plane 'floor'");
  EXPECT_EQ(system.name(rim), "disc 'rim'");
  EXPECT_EQ(system.name(ground), "ground");
  EXPECT_EQ(system.given_name(upper), "upper");
  EXPECT_EQ(system.given_name(other), "");
  EXPECT_EQ(system.name(BodyId{}), "part that was never given");
  EXPECT_EQ(System().name(upper), "part of another system");
  system.remove(rim);
  EXPECT_EQ(system.name(rim), "disc 'rim'");
  EXPECT_EQ(system.name(ShapeId{7, system.token()}), "part that was never given");
}

TEST(System, UnknownNamesAreRefused) {
  System system;
  system.add(particle(), "upper");
  EXPECT_MODEL_ERROR(system.body("lower"), "body 'lower'", "there is none",
                     "the name of a body of this system");
  EXPECT_MODEL_ERROR(system.element("upper"), "element 'upper'", "there is none", "allowed");
  EXPECT_MODEL_ERROR(system.shape("upper"), "shape 'upper'", "there is none");
  EXPECT_MODEL_ERROR(system.obstacle(""), "obstacle ''", "there is none");
}

TEST(System, NamesAreUniqueAndFreeAfterRemoval) {
  System system;
  const BodyId first = system.add(particle(), "a");
  EXPECT_MODEL_ERROR(system.add(particle(), "a"), "particle 'a'", "name is taken", "a name no other part");
  EXPECT_MODEL_ERROR(system.add(RigidBody{.mass = disc(1.0, 1.0)}, "a"), "rigid body 'a'", "name is taken");
  EXPECT_EQ(system.bodies().size(), 1U);
  system.remove(first);
  const BodyId second = system.add(particle(), "a");
  EXPECT_EQ(system.body("a"), second);
  EXPECT_NE(first, second);
}

TEST(System, IdentitiesAreNeverReused) {
  System system;
  const BodyId first = system.add(particle());
  system.remove(first);
  const BodyId second = system.add(particle());
  EXPECT_NE(first, second);
  EXPECT_FALSE(system.contains(first));
  EXPECT_TRUE(system.contains(second));
  EXPECT_MODEL_ERROR(system.add(SpringDamper{.from = first, .to = second}),
                     "from is a body that was removed");
  EXPECT_MODEL_ERROR(system.remove(first), "removal of body #0", "not in this system", "allowed");
}

TEST(System, RandomAdditionsAndRemovalsKeepEveryPartAtItsIdentity) {
  carom_test::Random random(101);
  System system;
  std::map<BodyId, std::pair<double, std::string>> expected;  // mass, name
  std::vector<BodyId> removed;
  int next_name = 0;
  for (int repeat = 0; repeat < 2000; ++repeat) {
    if (expected.empty() || random.below(5) < 3) {
      const double mass = random.uniform(0.1, 10.0);
      const std::string name = random.below(2) == 0 ? "" : std::to_string(next_name++);
      const bool rigid = random.below(3) == 0;
      const BodyId id =
          rigid ? system.add(RigidBody{.mass = disc(mass, 1.0)}, name) : system.add(particle(mass), name);
      ASSERT_FALSE(expected.contains(id));
      ASSERT_TRUE(std::find(removed.begin(), removed.end(), id) == removed.end());
      expected[id] = {mass, name};
    } else {
      auto victim = expected.begin();
      std::advance(victim, random.below(static_cast<unsigned>(expected.size())));
      system.remove(victim->first);
      removed.push_back(victim->first);
      expected.erase(victim);
    }
  }
  std::vector<BodyId> ids;
  for (const auto& [id, what] : expected) {
    ids.push_back(id);
    EXPECT_EQ(mass_of(system, id), what.first);
    EXPECT_EQ(system.given_name(id), what.second);
    if (!what.second.empty()) {
      EXPECT_EQ(system.body(what.second), id);
    }
  }
  EXPECT_EQ(system.bodies(), ids);
  for (const BodyId id : removed) EXPECT_FALSE(system.contains(id));
}

TEST(System, ForeignPartsAreRefused) {
  System system, other;
  const BodyId own = system.add(particle());
  const BodyId foreign = other.add(particle());  // the same serial number
  EXPECT_EQ(own.serial, foreign.serial);
  EXPECT_FALSE(system.contains(foreign));
  EXPECT_MODEL_ERROR((void)system.has_orientation(foreign), "body is a body of another system");
  EXPECT_MODEL_ERROR(system.remove(foreign), "removal of body #0", "not in this system");
  EXPECT_MODEL_ERROR(system.add(SpringDamper{.from = own, .to = foreign}), "spring-damper #0",
                     "to is a body of another system", "a body of this system");
  const ObstacleId foreign_floor = other.add(HalfPlane{.normal = {0, 1}}, smooth);
  EXPECT_MODEL_ERROR(system.remove(foreign_floor), "removal of obstacle #0");
  EXPECT_MODEL_ERROR(system.law({}, foreign_floor), "obstacle is part of another system",
                     "one of this system");
  const MaterialId steel = system.material("steel"), rubber = other.material("rubber");
  EXPECT_MODEL_ERROR(system.between(steel, rubber, smooth), "material is unknown",
                     "a material of this system");
  const ObstacleId floor = system.add(HalfPlane{.normal = {0, 1}}, smooth);
  EXPECT_MODEL_ERROR(system.law(rubber, floor), "law of contact", "material is unknown");
}

TEST(System, CopiesKeepIdentitiesAndAreIndependent) {
  System original;
  const BodyId a = original.add(particle(1.0), "a");
  const ObstacleId floor = original.add(HalfPlane{.normal = {0, 1}}, smooth);
  System copy = original;
  EXPECT_TRUE(copy.contains(a));
  EXPECT_EQ(copy.body("a"), a);
  EXPECT_EQ(copy.fingerprint(), original.fingerprint());
  EXPECT_TRUE(copy.law({}, floor).has_value());
  const BodyId b = copy.add(particle(2.0));
  copy.remove(a);
  EXPECT_TRUE(original.contains(a));
  EXPECT_FALSE(original.contains(b));
  EXPECT_EQ(original.body("a"), a);
  EXPECT_EQ(mass_of(original, a), 1.0);
  copy = original;
  EXPECT_TRUE(copy.contains(a));
  EXPECT_FALSE(copy.contains(b));
  const System moved = std::move(copy);
  EXPECT_EQ(moved.name(a), "particle 'a'");
}

TEST(System, DimensionsDoNotMix) {
  System plane;
  EXPECT_NO_THROW(plane.add(Gravity{{0.0, -9.81}}));
  EXPECT_EQ(plane.dimension(), 2);
  EXPECT_MODEL_ERROR(plane.add(spatial::Particle{.mass = 1.0}), "particle: dimension is 3", "allowed: 2");
  EXPECT_MODEL_ERROR(plane.add(spatial::HalfSpace{.normal = {0, 0, 1}}), "half-space: dimension is 3");
  EXPECT_MODEL_ERROR(plane.add(spatial::Gravity{{0, 0, -1}}), "gravity: dimension is 3");
  System space;
  space.add(spatial::Particle{.mass = 1.0});
  EXPECT_EQ(space.dimension(), 3);
  EXPECT_MODEL_ERROR(space.add(particle()), "particle: dimension is 2", "allowed: 3");
  EXPECT_MODEL_ERROR(space.add(HalfPlane{.normal = {0, 1}}, smooth), "half-plane: dimension is 2");
}

TEST(System, ARefusedPartChangesNothing) {
  System system;
  const BodyId a = system.add(particle());
  const std::uint64_t before = system.fingerprint();
  EXPECT_ANY_THROW(system.add(particle(-1.0), "name"));
  EXPECT_ANY_THROW(system.add(RigidBody{}, "name"));
  EXPECT_ANY_THROW(system.add(SpringDamper{.from = a, .to = a}, "name"));
  EXPECT_ANY_THROW(system.add(Disc{.body = a}, "name"));
  EXPECT_ANY_THROW(system.add(HalfPlane{}, smooth, "name"));
  EXPECT_ANY_THROW(system.add(HalfPlane{.normal = {0, 1}}, Surface{}, "name"));
  EXPECT_EQ(system.fingerprint(), before);
  EXPECT_EQ(system.body_kinds().entries().size(), 1U);
  EXPECT_TRUE(system.force_kinds().entries().empty());
  EXPECT_TRUE(system.shape_kinds().entries().empty());
  EXPECT_TRUE(system.ground_shape_kinds().entries().empty());
  EXPECT_EQ(system.add(particle(), "name").serial, a.serial + 1);

  System empty;
  EXPECT_ANY_THROW(empty.add(particle(nan)));
  EXPECT_EQ(empty.dimension(), 0) << "a refused part decided on the dimension";
}

TEST(System, ABodyInUseIsNotRemoved) {
  System system;
  const BodyId a = system.add(particle(), "a"), b = system.add(particle());
  const BodyId plate = system.add(RigidBody{.mass = disc(1.0, 1.0)}, "plate");
  const ElementId spring = system.add(SpringDamper{.from = a, .to = b}, "link");
  const ElementId anchor = system.add(SpringDamper{.from = ground, .to = b});
  const ShapeId rim = system.add(Disc{.body = plate, .radius = 1.0});
  EXPECT_MODEL_ERROR(system.remove(a), "particle 'a'", "spring-damper 'link' acts on it",
                     "without force elements");
  EXPECT_MODEL_ERROR(system.remove(plate), "rigid body 'plate'", "disc #0 is fixed to it", "without shapes");
  EXPECT_MODEL_ERROR(system.remove(ground), "ground", "cannot be removed", "allowed");
  EXPECT_MODEL_ERROR(system.remove(BodyId{}), "removal of body that was never given", "allowed");
  EXPECT_EQ(system.bodies().size(), 3U);
  system.remove(spring);
  EXPECT_NO_THROW(system.remove(a));
  EXPECT_ANY_THROW(system.remove(b));
  system.remove(anchor);
  system.remove(rim);
  EXPECT_NO_THROW(system.remove(b));
  EXPECT_NO_THROW(system.remove(plate));
  EXPECT_TRUE(system.bodies().empty());
  EXPECT_MODEL_ERROR(system.remove(spring), "removal of element #0", "not in this system");
  EXPECT_MODEL_ERROR(system.remove(rim), "removal of shape #0", "not in this system");
}

TEST(System, MaterialsAreKnownByName) {
  System system;
  const MaterialId steel = system.material("steel"), rubber = system.material("rubber");
  EXPECT_NE(steel, rubber);
  EXPECT_EQ(system.material("steel"), steel);
  EXPECT_TRUE(system.contains(rubber));
  EXPECT_FALSE(system.contains(MaterialId{}));
  EXPECT_MODEL_ERROR(system.material(""), "material: name is empty", "allowed: a name");
}

TEST(System, LawBetweenMaterialsComesBeforeTheSurfaceOfTheObstacle) {
  System system;
  const MaterialId steel = system.material("steel"), rubber = system.material("rubber");
  const ObstacleId plain =
      system.add(HalfPlane{.normal = {0, 1}}, Surface{.friction = 0.1, .normal_restitution = 1.0});
  const ObstacleId both = system.add(HalfPlane{.normal = {0, 1}, .material = steel},
                                     Surface{.friction = 0.2, .normal_restitution = 1.0});
  const ObstacleId bare = system.add(HalfPlane{.normal = {0, 1}, .material = steel});
  const ObstacleId nothing = system.add(HalfPlane{.normal = {0, 1}});
  const auto friction = [&](MaterialId a, ObstacleId obstacle) {
    const auto law = system.law(a, obstacle);
    return law ? law->friction : -1.0;
  };
  EXPECT_EQ(friction(rubber, both), 0.2);
  EXPECT_EQ(friction(rubber, bare), -1.0);
  system.between(rubber, steel, {.friction = 0.9, .normal_restitution = 0.0});
  EXPECT_EQ(friction(rubber, plain), 0.1);
  EXPECT_EQ(friction(rubber, both), 0.9);
  EXPECT_EQ(friction(rubber, bare), 0.9);
  EXPECT_EQ(friction(rubber, nothing), -1.0);
  EXPECT_EQ(friction(steel, both), 0.2);  // no law of steel on steel
  EXPECT_EQ(friction({}, both), 0.2);     // no material
  EXPECT_EQ(friction({}, bare), -1.0);
  system.between(steel, rubber,
                 {.friction = 0.8, .normal_restitution = 0.0});  // either order, the last holds
  EXPECT_EQ(friction(rubber, both), 0.8);
  system.between(steel, steel, {.friction = 0.4, .normal_restitution = 0.0});
  EXPECT_EQ(friction(steel, bare), 0.4);
  system.remove(plain);
  EXPECT_MODEL_ERROR(system.law(rubber, plain), "obstacle is half-plane #0, which was removed",
                     "one of this system");
}

TEST(System, ImpossibleSurfacesAreRefusedByName) {
  System system;
  const MaterialId steel = system.material("steel"), ice = system.material("ice");
  EXPECT_MODEL_ERROR(system.between(steel, ice, {.friction = -0.5, .normal_restitution = 0.5}),
                     "surface between 'steel' and 'ice'", "friction is -0.5", ">= 0");
  EXPECT_MODEL_ERROR(
      system.add(HalfPlane{.normal = {0, 1}}, Surface{.friction = 0.1, .normal_restitution = 1.5}, "floor"),
      "half-plane 'floor'", "normal_restitution is 1.5", "[0, 1]");
  EXPECT_MODEL_ERROR(system.add(HalfPlane{.normal = {0, 1}}, Surface{.normal_restitution = 0.5}),
                     "half-plane #0", "friction is nan");
  EXPECT_FALSE(system.law(steel, system.add(HalfPlane{.normal = {0, 1}, .material = ice})).has_value());
}

}  // namespace
