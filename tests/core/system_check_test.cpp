// Findings of System::check(); models that are as they should be have none.

#include "tests/random.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;

const Surface rough{.friction = 0.3, .normal_restitution = 0.5};

std::vector<FindingKind> kinds_of(const System& system) {
  std::vector<FindingKind> kinds;
  for (const ModelFinding& finding : system.check()) kinds.push_back(finding.kind);
  return kinds;
}

bool says(const ModelFinding& finding, const std::string& text) {
  return finding.text.find(text) != std::string::npos;
}

BodyId disc_of(System& system, MaterialId material, const Vec<2>& place) {
  const BodyId body = system.add(RigidBody{.mass = disc(1.0, 0.1), .position = place});
  system.add(Disc{.body = body, .radius = 0.1, .material = material});
  return body;
}

TEST(SystemCheck, ShapesOfBodiesNeedALawToTouchEachOther) {
  System system;
  const MaterialId steel = system.material("steel"), ice = system.material("ice");
  disc_of(system, steel, {0.0, 0.0});
  disc_of(system, steel, {1.0, 0.0});
  system.between(steel, ice, rough);
  const auto found = system.check();
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].kind, FindingKind::law_without_effect);
  EXPECT_EQ(found[0].parts, (std::vector<std::string>{"steel", "ice"}));
  EXPECT_TRUE(
      says(found[0], "no obstacle is of 'steel' or 'ice', and no two bodies that can touch each other"))
      << found[0].text;
  EXPECT_EQ(found[1].kind, FindingKind::touches_nothing);
  EXPECT_EQ(found[1].parts, (std::vector<std::string>{"disc #0", "disc #1"}));
  EXPECT_TRUE(says(found[1], "there is no obstacle to touch")) << found[1].text;
  // A body of ice can touch, and steel touches it.
  disc_of(system, ice, {2.0, 0.0});
  const auto rest = system.check();
  ASSERT_EQ(rest.size(), 1U);  // steel passes through steel
  EXPECT_EQ(rest[0].kind, FindingKind::contact_without_law);
  EXPECT_EQ(rest[0].parts, std::vector<std::string>{"disc #0 and another one of its material"});
  EXPECT_TRUE(says(rest[0], "disc #0 and another one of its material (material 'steel')")) << rest[0].text;
  system.between(steel, steel, rough);
  EXPECT_TRUE(system.check().empty());
}

TEST(SystemCheck, LawsOfMaterialsThatNeverMeet) {
  System system;
  const MaterialId ice = system.material("ice"), steel = system.material("steel"),
                   steal = system.material("steal");
  system.add(HalfPlane{.normal = {0.0, 1.0}, .material = ice}, rough);
  disc_of(system, steel, {0.0, 1.0});
  system.between(steel, ice, rough);
  EXPECT_TRUE(system.check().empty());
  system.between(steal, ice, rough);
  const auto found = system.check();
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].kind, FindingKind::law_without_effect);
  EXPECT_TRUE(says(found[0], "an obstacle is of 'ice', but nothing that can touch it is of 'steal'"))
      << found[0].text;
  system.between(steal, steel, rough);
  EXPECT_EQ(system.check().size(), 2U);
  disc_of(system, steel, {1.0, 1.0});
  system.between(steel, steel, rough);  // of two bodies
  EXPECT_EQ(system.check().size(), 2U);
}

TEST(SystemCheck, WhatCanTouchNothing) {
  System system;
  const BodyId wheel = system.add(RigidBody{.mass = disc(1.0, 1.0)}, "wheel");
  EXPECT_TRUE(system.check().empty());  // nothing is there to touch
  system.add(HalfPlane{.normal = {0.0, 1.0}}, rough, "floor");
  system.add(Gravity{{0.0, -9.81}});
  const auto found = system.check();
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].kind, FindingKind::untouched_obstacle);
  EXPECT_EQ(found[0].parts, std::vector<std::string>{"half-plane 'floor'"});
  EXPECT_EQ(found[1].kind, FindingKind::body_without_shape);
  EXPECT_EQ(found[1].parts, std::vector<std::string>{"rigid body 'wheel'"});
  system.add(Disc{.body = wheel, .radius = 1.0});
  EXPECT_TRUE(system.check().empty());
  // Links of mechanisms have no shapes, nor have bodies on springs; particles are asked.
  const BodyId link = system.add(RigidBody{.mass = rod(1.0, 1.0)}),
               hung = system.add(RigidBody{.mass = disc(1.0, 1.0)});
  system.add(Revolute{.from = ground, .to = link});
  system.add(SpringDamper{.from = ground, .to = hung, .stiffness = 1.0});
  system.add(Particle{.mass = 1.0, .contact = false});
  EXPECT_TRUE(system.check().empty());
}

TEST(SystemCheck, ContactsWithoutALaw) {
  System system;
  system.add(HalfPlane{.normal = {0.0, 1.0}}, "floor");
  system.add(HalfPlane{.normal = {1.0, 0.0}}, rough, "wall");
  system.add(Particle{.mass = 1.0}, "ball");
  disc_of(system, system.material("steel"), {0.0, 1.0});
  const auto all = system.check();
  ASSERT_EQ(all.size(), 3U);
  EXPECT_EQ(all[0].parts, std::vector<std::string>{"particle 'ball' and disc #0"});
  const std::vector<ModelFinding> found(all.begin() + 1, all.end());  // a material each
  for (const ModelFinding& finding : found) {
    EXPECT_EQ(finding.kind, FindingKind::contact_without_law);
    EXPECT_EQ(finding.parts.back(), "half-plane 'floor'");
  }
  EXPECT_EQ(found[0].parts.front(), "particle 'ball'");
  EXPECT_EQ(found[1].parts.front(), "disc #0");
  EXPECT_TRUE(says(found[0], "law is not given between no material and no material")) << found[0].text;
  EXPECT_TRUE(says(found[1], "law is not given between material 'steel' and no material")) << found[1].text;
}

TEST(SystemCheck, BodiesThatPassThroughEachOtherAboveAFloorWithItsOwnLaw) {
  System system;
  system.add(HalfPlane{.normal = {0.0, 1.0}}, rough);
  const BodyId one = disc_of(system, {}, {0.0, 0.1});
  EXPECT_TRUE(system.check().empty());  // alone it meets the floor only
  const BodyId other = disc_of(system, {}, {0.0, 0.4});
  const auto found = system.check();
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].kind, FindingKind::contact_without_law);
  EXPECT_TRUE(says(found[0], "disc #0 and another one of its material (no material)")) << found[0].text;
  EXPECT_TRUE(says(found[0], "pass through each other")) << found[0].text;
  EXPECT_TRUE(says(found[0], "System::set_default_law()")) << found[0].text;

  System with_law = system;
  with_law.set_default_law(rough);
  EXPECT_TRUE(with_law.check().empty());
  // Two bodies that a joint binds do not touch each other, nor do those of which that was decided.
  System bound = system;
  bound.add(Rod{.from = one, .to = other});
  EXPECT_TRUE(bound.check().empty());
  bound.allow_contact(one, other, true);
  EXPECT_EQ(bound.check().size(), 1U);
  System decided = system;
  decided.allow_contact(one, other, false);
  EXPECT_TRUE(decided.check().empty());
  disc_of(decided, {}, {0.0, 0.7});
  EXPECT_EQ(decided.check().size(), 1U);
  // A particle passes through a disc; particles never meet.
  System particles;
  particles.add(HalfPlane{.normal = {0.0, 1.0}}, rough);
  particles.add(Particle{.mass = 1.0, .position = {0.0, 1.0}});
  particles.add(Particle{.mass = 1.0, .position = {0.0, 2.0}});
  EXPECT_TRUE(particles.check().empty());
  disc_of(particles, {}, {0.0, 3.0});
  EXPECT_EQ(particles.check().size(), 1U);
  // Filters say that bodies are to pass.
  System filtered;
  const ContactFilter ground_only{.groups = 2, .touches = 1};
  filtered.add(HalfPlane{.normal = {0.0, 1.0}}, rough);
  for (const double height : {1.0, 2.0}) {
    const BodyId body = filtered.add(RigidBody{.mass = disc(1.0, 0.1), .position = {0.0, height}});
    filtered.add(Disc{.body = body, .radius = 0.1, .filter = ground_only});
  }
  EXPECT_TRUE(filtered.check().empty());
}

TEST(SystemCheck, PlacesKeptInVain) {
  System system;
  const BodyId a = system.add(RigidBody{.mass = rod(1.0, 1.0)}, "a"),
               b = system.add(RigidBody{.mass = rod(1.0, 1.0)}, "b");
  system.keep_place(a);
  EXPECT_EQ(kinds_of(system), std::vector{FindingKind::keep_without_joint});
  system.add(Revolute{.from = a, .to = b});
  EXPECT_TRUE(system.check().empty());
  system.keep_place(b, false);
  EXPECT_TRUE(system.check().empty());
}

TEST(SystemCheck, ManyPartsAreOneFinding) {
  System system;
  for (int i = 0; i < 10; ++i) disc_of(system, {}, {0.3 * i, 0.0});
  const auto found = system.check();
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].parts.size(), 10U);
  EXPECT_TRUE(says(found[0], "disc #0, disc #1, disc #2 and 7 more:")) << found[0].text;
}

TEST(SystemCheck, LawsActWhereAndOnlyWhereTheyAreNotListed) {
  // Random materials, obstacles and touching parts, against what law() gives for each pair.
  carom_test::Random random(1706);
  for (int repeat = 0; repeat < 200; ++repeat) {
    System system;
    std::vector<MaterialId> materials;
    for (const char* const name : {"a", "b", "c", "d"}) materials.push_back(system.material(name));
    const auto any = [&] { return materials[random.below(4)]; };
    for (unsigned i = random.below(3); i > 0; --i) {
      system.add(HalfPlane{.normal = {0.0, 1.0}, .material = any()}, rough);
    }
    std::vector<MaterialId> touching;
    for (unsigned i = random.below(3); i > 0; --i) {
      touching.push_back(any());
      system.add(Particle{.mass = 1.0, .material = touching.back()});
    }
    std::vector<std::pair<unsigned, unsigned>> pairs;
    for (unsigned i = 0; i < 4; ++i) {
      for (unsigned j = i; j < 4; ++j) {
        if (random.below(2) != 0) continue;
        // A coefficient of its own tells which law acts.
        system.between(materials[i], materials[j],
                       {.friction = 1.0 + i + 10.0 * j, .normal_restitution = 0.0});
        pairs.emplace_back(i, j);
      }
    }
    std::size_t idle = 0;
    for (const auto& [i, j] : pairs) {
      bool acts = false;
      for (const ObstacleId obstacle : system.obstacles()) {
        for (const MaterialId material : touching)
          acts = acts || system.law(material, obstacle)->friction == 1.0 + i + 10.0 * j;
      }
      if (!acts) ++idle;
    }
    const auto kinds = kinds_of(system);
    EXPECT_EQ(
        static_cast<std::size_t>(std::count(kinds.begin(), kinds.end(), FindingKind::law_without_effect)),
        idle);
  }
}

TEST(SystemCheck, NamesOfKinds) {
  EXPECT_EQ(to_string(FindingKind::law_without_effect), "law without effect");
  EXPECT_EQ(to_string(FindingKind::keep_without_joint), "kept without a joint");
  EXPECT_EQ(to_string(static_cast<FindingKind>(77)), "unknown");
}

}  // namespace
