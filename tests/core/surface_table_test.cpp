#include <carom/bodies/particle.h>
#include <carom/contact/detection/half_space.h>
#include <carom/core/surface_table.h>
#include <carom/core/system.h>

#include "tests/model_error.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <vector>

namespace {

using namespace carom;
using planar::HalfPlane;

Surface law_of(double friction) { return {.friction = friction, .normal_restitution = 0.0}; }

/// Friction of a pair, -1 without a law; the same in either order.
double friction(const SurfaceTable& table, const ContactSide& a, const ContactSide& b) {
  const Surface *const found = table.find(a, b), *const turned = table.find(b, a);
  EXPECT_EQ(found, turned);
  return found == nullptr ? -1.0 : found->friction;
}

std::uint64_t fingerprint(const SurfaceTable& table) {
  Fingerprint print;
  table.fingerprint(print);
  return print.value();
}

TEST(SurfaceTable, MaterialsHaveNumbersByName) {
  SurfaceTable table;
  EXPECT_EQ(table.size(), 0U);
  EXPECT_EQ(table.material("steel"), 0U);
  EXPECT_EQ(table.material("ice"), 1U);
  EXPECT_EQ(table.material("steel"), 0U);
  EXPECT_EQ(table.size(), 2U);
  EXPECT_EQ(table.name(1), "ice");
}

TEST(SurfaceTable, PairsComeBeforeOwnLawsAndTheDefaultLast) {
  SurfaceTable table;
  const Index steel = table.material("steel"), ice = table.material("ice");
  const ContactSide bare{}, of_steel{.material = steel}, of_ice{.material = ice};
  const ContactSide floor{.own = 7}, icy_floor{.material = ice, .own = 7}, wall{.own = 8};
  EXPECT_EQ(friction(table, bare, bare), -1.0);
  table.set(ice, steel, law_of(0.1));
  EXPECT_EQ(friction(table, of_steel, of_ice), 0.1);
  EXPECT_EQ(friction(table, of_steel, of_steel), -1.0);
  EXPECT_EQ(friction(table, of_steel, icy_floor), 0.1);
  EXPECT_EQ(friction(table, bare, icy_floor), -1.0);
  table.set_own(7, law_of(0.2));
  EXPECT_EQ(friction(table, of_steel, icy_floor), 0.1);
  EXPECT_EQ(friction(table, of_steel, floor), 0.2);
  EXPECT_EQ(friction(table, bare, icy_floor), 0.2);
  EXPECT_EQ(friction(table, bare, wall), -1.0);
  table.set_default(law_of(0.3));
  EXPECT_EQ(friction(table, of_steel, icy_floor), 0.1);
  EXPECT_EQ(friction(table, bare, floor), 0.2);
  EXPECT_EQ(friction(table, bare, wall), 0.3);
  EXPECT_EQ(friction(table, of_steel, of_steel), 0.3);
  table.remove_own(7);
  EXPECT_EQ(friction(table, bare, floor), 0.3);
  table.set(steel, ice, law_of(0.4));  // either order, the last holds
  EXPECT_EQ(friction(table, of_ice, of_steel), 0.4);
  EXPECT_EQ(table.pairs().size(), 1U);
}

TEST(SurfaceTable, FingerprintsTellLawsApart) {
  SurfaceTable table;
  std::set<std::uint64_t> prints{fingerprint(table)};
  const Index steel = table.material("steel"), ice = table.material("ice");
  EXPECT_TRUE(prints.contains(fingerprint(table)));  // names do not count
  const std::vector<std::function<void()>> changes{
      [&] { table.set(steel, ice, law_of(0.1)); },
      [&] { table.set(steel, ice, law_of(0.2)); },
      [&] { table.set(steel, steel, law_of(0.1)); },
      [&] { table.set_own(0, law_of(0.1)); },
      [&] { table.set_own(1, law_of(0.1)); },
      [&] { table.set_default(law_of(0.1)); },
      [&] { table.set_default(law_of(0.2)); },
      [&] { table.set_default({.friction = 0.2, .normal_restitution = 0.0, .static_friction = 0.3}); }};
  for (std::size_t i = 0; i < changes.size(); ++i) {
    changes[i]();
    EXPECT_TRUE(prints.insert(fingerprint(table)).second) << i;
  }
}

// Written by an earlier version: checkpoints of such models are still accepted.
TEST(SurfaceTable, FingerprintsOfEarlierVersionsHold) {
  SurfaceTable table;
  const Index steel = table.material("steel"), ice = table.material("ice");
  table.set(ice, steel, {.friction = 0.4, .normal_restitution = 0.5, .tangential_restitution = 0.6});
  table.set_own(3,
                {.friction = 0.1, .normal_restitution = 0.2, .static_friction = 0.5, .stribeck_speed = 2.0});
  Fingerprint print;
  for (const std::uint64_t number : {0U, 1U}) print.add(number);
  for (const double number : {0.4, 0.5, 0.6}) print.add(number);
  print.add(std::uint64_t{3});
  for (const double number : {0.1, 0.2, 0.0, 0.5, 2.0}) print.add(number);
  EXPECT_EQ(fingerprint(table), print.value());
}

TEST(SystemLaws, TheDefaultHoldsWhereNoOtherIsSet) {
  System system;
  const MaterialId steel = system.material("steel"), ice = system.material("ice");
  const ObstacleId plain = system.add(HalfPlane{.normal = {0, 1}}),
                   given = system.add(HalfPlane{.normal = {0, 1}}, law_of(0.2)),
                   icy = system.add(HalfPlane{.normal = {0, 1}, .material = ice});
  const std::uint64_t before = system.fingerprint();
  EXPECT_EQ(system.law(steel, plain), std::nullopt);
  EXPECT_EQ(system.law(steel, ice), std::nullopt);
  system.add(planar::Particle{.mass = 1.0, .material = steel}, "ball");
  EXPECT_EQ(system.check().size(), 2U);
  system.set_default_law(law_of(0.3));
  system.between(ice, steel, law_of(0.1));
  EXPECT_TRUE(system.check().empty());
  EXPECT_EQ(system.law({}, plain)->friction, 0.3);
  EXPECT_EQ(system.law(steel, plain)->friction, 0.3);
  EXPECT_EQ(system.law(steel, given)->friction, 0.2);
  EXPECT_EQ(system.law(steel, icy)->friction, 0.1);
  EXPECT_EQ(system.law(steel, ice)->friction, 0.1);
  EXPECT_EQ(system.law(ice, steel)->friction, 0.1);
  EXPECT_EQ(system.law(ice, MaterialId{})->friction, 0.3);
  EXPECT_NE(system.fingerprint(), before);
  const System copy = system;
  EXPECT_EQ(copy.law({}, plain)->friction, 0.3);
}

TEST(SystemLaws, ImpossibleOnesAreRefused) {
  System system, other;
  const MaterialId steel = system.material("steel"), foreign = other.material("steel");
  EXPECT_MODEL_ERROR(system.set_default_law({.friction = -0.5, .normal_restitution = 0.5}),
                     "default law of contact", "friction is -0.5", ">= 0");
  EXPECT_EQ(system.law(steel, steel), std::nullopt);
  EXPECT_MODEL_ERROR(system.law(steel, foreign), "law of contact", "material is unknown", "of this system");
  EXPECT_MODEL_ERROR(system.law(foreign, steel), "law of contact", "material is unknown", "of this system");
}

}  // namespace
