#include "tests/constraint_sets.h"
#include <carom/contact/detection/outlines.h>
#include <carom/contact/detection/point_contacts.h>

#include "tests/contact/detection/placed_model.h"
#include "tests/random.h"

#include <carom/carom.h>
#include <carom/core/constraint_set.h>

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;

constexpr double infinity = std::numeric_limits<double>::infinity();
const Surface law{.friction = 0.5, .normal_restitution = 0.5};

enum class Joined { to_a_chain, not_at_all };

/// Particles and rigid bodies at random places over a floor and beside a wall.
System random_bodies(carom_test::Random& random, int bodies, Joined joined) {
  System system;
  system.add(HalfPlane{.normal = {0, 1}}, law);
  system.add(HalfPlane{.normal = {1, 0.2}}, law);
  BodyId last = ground;
  for (int i = 0; i < bodies; ++i) {
    BodyId next;
    if (i % 7 == 3) {
      next = system.add(RigidBody{.mass = box(1.0, 0.2, 0.1), .position = random.vec<2>(), .angle = 0.1 * i});
      system.add(Segment{.body = next, .from = {-0.1, 0.0}, .to = {0.1, 0.05}});
    } else if (i > bodies / 2) {
      next = system.add(RigidBody{.mass = disc(1.0, 0.1), .position = random.vec<2>()});
      system.add(Disc{.body = next, .radius = 0.01 * (i % 10 + 1)});
    } else {
      next = system.add(Particle{.mass = 1.0, .position = random.vec<2>(), .contact = i % 11 != 5});
    }
    if (i > 0 && joined == Joined::to_a_chain)
      system.add(SpringDamper{.from = last, .to = next, .stiffness = 1.0});
    last = next;
  }
  return system;
}

// The search by parts finds what a look at each pair finds, in the same order and to the bit.
TEST(PointContacts, FindAllPairsThatTouch) {
  carom_test::Random random(4201);
  for (int repeat = 0; repeat < 20; ++repeat) {
    const Joined joined = repeat % 2 == 0 ? Joined::to_a_chain : Joined::not_at_all;
    const carom_test::PlacedModel model(random_bodies(random, 90, joined));
    const auto components = static_cast<Index>(model.assembly.components().size());
    ASSERT_EQ(components, joined == Joined::to_a_chain ? 1U : 90U);
    const Outlines outlines(model.assembly);
    const PointContacts contacts(model.assembly, outlines.shapes(), outlines.laws());
    EXPECT_TRUE(contacts.needs_rotations());
    std::vector<ContactPair> pairs;
    for (Index component = 0; component < components; ++component) contacts.append_pairs(component, pairs);
    const GroundPlaces places;
    for (const double margin : {-0.9, 0.0, 0.1, infinity}) {
      ConstraintSet found;
      contacts.find({0, components}, {model.state.view(), model.evaluation, places, nullptr, margin, nullptr},
                    found);
      std::size_t next = 0;
      for (const ContactPair& pair : pairs) {
        SingleConstraint at;
        contacts.contact(pair, model.state.view(), model.evaluation, nullptr, at);
        if (at.gap > margin) continue;
        ASSERT_LT(next, found.size());
        EXPECT_EQ(found[next].key, at.key);
        EXPECT_EQ(found[next].gap, at.gap);
        EXPECT_EQ(carom_test::numbers_of(found[next]), carom_test::numbers_of(at));
        ++next;
      }
      EXPECT_EQ(next, found.size());
    }
  }
}

// Of many bodies those shapes are looked at that are near some of them; of one body each.
TEST(PointContacts, FindThoseThatLastAmongManyAsOneByOne) {
  carom_test::Random random(4203);
  std::size_t opened = 0;
  for (int repeat = 0; repeat < 20; ++repeat) {
    carom_test::PlacedModel model(random_bodies(random, 90, Joined::not_at_all));
    for (double& v : model.state.v) v = random.uniform(-5.0, 5.0);
    const Outlines outlines(model.assembly);
    const PointContacts contacts(model.assembly, outlines.shapes(), outlines.laws());
    const auto components = static_cast<Index>(model.assembly.components().size());
    std::vector<ContactPair> pairs;
    for (Index component = 0; component < components; ++component) contacts.append_pairs(component, pairs);
    LastingContacts lasting;
    lasting.start(0.1);
    for (const ContactPair& pair : pairs) {
      SingleConstraint at;
      contacts.contact(pair, model.state.view(), model.evaluation, nullptr, at);
      lasting.add(at.key);
    }
    lasting.finish();
    const GroundPlaces places;
    const ContactQuery query{model.state.view(), model.evaluation, places, nullptr, 0.0, &lasting};
    ConstraintSet together, one_by_one;
    contacts.find({0, components}, query, together);
    for (Index component = 0; component < components; ++component) {
      contacts.find({component, component + 1}, query, one_by_one);
    }
    ASSERT_EQ(together.size(), one_by_one.size());
    for (std::size_t i = 0; i < together.size(); ++i) {
      EXPECT_EQ(together[i].key, one_by_one[i].key);
      EXPECT_EQ(together[i].gap, one_by_one[i].gap);
      EXPECT_EQ(carom_test::numbers_of(together[i]), carom_test::numbers_of(one_by_one[i]));
      EXPECT_EQ(together[i].allowed_approach, one_by_one[i].allowed_approach);
      if (together[i].gap > 0.0) ++opened;
    }
  }
  EXPECT_GT(opened, 10U);
}

// A list that is kept holds contacts of other bodies, with other rows, before.
TEST(PointContacts, FindIntoASetThatHeldOthersWhatTheyFindAnew) {
  carom_test::Random random(4205);
  ConstraintSet kept;
  int nothing_near = 0, several = 0;
  for (int repeat = 0; repeat < 20; ++repeat) {
    const carom_test::PlacedModel model(random_bodies(random, 90, Joined::not_at_all));
    const Outlines outlines(model.assembly);
    const PointContacts contacts(model.assembly, outlines.shapes(), outlines.laws());
    const GroundPlaces places;
    for (const double margin : {-0.9, 0.0, infinity}) {
      const ContactQuery query{model.state.view(), model.evaluation, places, nullptr, margin, nullptr};
      for (Index first = 0; first < 90; first += 3) {
        ConstraintSet anew;
        contacts.find({first, first + 3}, query, anew);
        kept.clear();
        contacts.find({first, first + 3}, query, kept);
        if (!contacts.any_near({first, first + 3}, query)) {
          EXPECT_TRUE(anew.empty());
          ++nothing_near;
        }
        several += anew.size() > 1 ? 1 : 0;
        ASSERT_EQ(kept.size(), anew.size());
        for (std::size_t i = 0; i < anew.size(); ++i) {
          const Constraint &a = kept[i], &b = anew[i];
          EXPECT_EQ(a.key, b.key);
          EXPECT_EQ(a.gap, b.gap);
          EXPECT_EQ(a.rows, b.rows);
          EXPECT_EQ(a.body(), b.body());
          ASSERT_EQ(a.columns(), b.columns());
          for (int k = 0; k < a.rows * a.columns(); ++k) EXPECT_EQ(a.row(0)[k], b.row(0)[k]);
          EXPECT_EQ(a.drift, b.drift);
          EXPECT_EQ(a.friction, b.friction);
          EXPECT_EQ(a.law.normal_restitution, b.law.normal_restitution);
        }
      }
    }
  }
  EXPECT_GT(nothing_near, 10);
  EXPECT_GT(several, 100);
}

TEST(PointContacts, WithoutGroundNothingTouches) {
  System system;
  system.add(Particle{.mass = 1.0});
  const carom_test::PlacedModel model(system);
  const Outlines outlines(model.assembly);
  const PointContacts contacts(model.assembly, outlines.shapes(), outlines.laws());
  EXPECT_FALSE(contacts.needs_rotations());
  EXPECT_FALSE(contacts.law_facts().static_friction);
  std::vector<ContactPair> pairs;
  contacts.append_pairs(0, pairs);
  EXPECT_TRUE(pairs.empty());
}

TEST(PointContacts, FrictionActsAtTheSpeedOfSliding) {
  System system;
  const Surface curve{
      .friction = 0.2, .normal_restitution = 0.0, .static_friction = 0.6, .stribeck_speed = 0.5};
  system.add(HalfPlane{.normal = {0, 1}}, curve);
  system.add(Particle{.mass = 1.0, .velocity = {0.3, 0.0}});
  const carom_test::PlacedModel model(system);
  const Outlines outlines(model.assembly);
  const PointContacts contacts(model.assembly, outlines.shapes(), outlines.laws());
  EXPECT_TRUE(contacts.law_facts().static_friction);
  const GroundPlaces places;
  ConstraintSet found;
  contacts.find({0, 1}, {model.state.view(), model.evaluation, places, nullptr, 0.0, nullptr}, found);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].friction, curve.friction_at(0.3));
}

// In space: three rows, the tangents in the plane.
TEST(PointContacts, InSpaceRowsAreAFrame) {
  System system;
  system.add(spatial::HalfSpace{.normal = {0.0, 0.6, 0.8}}, law);
  system.add(spatial::Particle{.mass = 1.0, .position = {1.0, 2.0, 3.0}});
  const carom_test::PlacedModel model(system);
  const Outlines outlines(model.assembly);
  const PointContacts contacts(model.assembly, outlines.shapes(), outlines.laws());
  const GroundPlaces places;
  ConstraintSet found;
  contacts.find({0, 1}, {model.state.view(), model.evaluation, places, nullptr, infinity, nullptr}, found);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].rows, 3);
  EXPECT_NEAR(found[0].gap, 3.6, 1e-14);
  const auto row = [&](int i) { return Vec<3>(found[0].row(i)); };
  EXPECT_NEAR((row(0) - Vec<3>(0.0, 0.6, 0.8)).norm(), 0.0, 1e-15);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(row(i).norm(), 1.0, 1e-15);
    EXPECT_NEAR(row(i).dot(row((i + 1) % 3)), 0.0, 1e-15);
  }
}

}  // namespace
