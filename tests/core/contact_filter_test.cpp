// Filters of contacts in the description of a model: fingerprint, findings, decisions about two bodies.

#include <carom/core/contact_filter.h>

#include "tests/model_error.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <cstdint>
#include <set>
#include <string>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;

const Surface rough{.friction = 0.3, .normal_restitution = 0.5};

TEST(ContactFilter, TwoMeetWhereEachTouchesAGroupOfTheOther) {
  const ContactFilter usual{}, second{.groups = 2}, only_first{.touches = 1}, both{.groups = 3, .touches = 2};
  EXPECT_TRUE(may_touch(usual, usual));
  EXPECT_TRUE(may_touch(usual, second));
  EXPECT_TRUE(may_touch(usual, only_first));
  EXPECT_FALSE(may_touch(second, only_first));  // the one touches the other, but not the other the one
  EXPECT_FALSE(may_touch(usual, both));
  EXPECT_TRUE(may_touch(second, both));
  const ContactFilter all[] = {usual, second, only_first, both, {.groups = 0}, {.touches = 0}};
  for (const ContactFilter& a : all) {
    for (const ContactFilter& b : all) EXPECT_EQ(may_touch(a, b), may_touch(b, a));
    EXPECT_FALSE(may_touch(a, {.groups = 0}));
    EXPECT_FALSE(may_touch(a, {.touches = 0}));
  }
}

// Everything that can have a filter, one of which has it.
std::uint64_t print_with(int which, const ContactFilter& filter) {
  const auto of = [&](int part) { return part == which ? filter : ContactFilter{}; };
  System system;
  system.add(Particle{.mass = 1.0, .filter = of(1)});
  const BodyId body = system.add(RigidBody{.mass = disc(1.0, 1.0)});
  system.add(Disc{.body = body, .radius = 0.5, .filter = of(2)});
  system.add(Disc{.body = body, .radius = 0.5, .filter = of(3)});
  system.add(Point{.body = body, .filter = of(4)});
  system.add(Segment{.body = body, .from = {0, 0}, .to = {1, 0}, .filter = of(5)});
  system.add(Polygon{.body = body, .vertices = {{0, 0}, {1, 0}, {0, 1}}, .filter = of(6)});
  system.add(HalfPlane{.normal = {0, 1}, .filter = of(7)}, rough);
  return system.fingerprint();
}

TEST(ContactFilter, ChangesTheFingerprintWhereItIsSet) {
  std::set<std::uint64_t> prints{print_with(0, {})};
  for (int part = 1; part <= 7; ++part) {
    EXPECT_EQ(print_with(part, {}), print_with(0, {}));
    prints.insert(print_with(part, {.groups = 2}));
    prints.insert(print_with(part, {.touches = 2}));
  }
  EXPECT_EQ(prints.size(), 15U);
  const auto in_space = [](const ContactFilter& filter) {
    System system;
    system.add(spatial::HalfSpace{.normal = {0, 0, 1}, .filter = filter}, rough);
    return system.fingerprint();
  };
  EXPECT_NE(in_space({}), in_space({.groups = 2}));
}

TEST(ContactFilter, PartsThatAreHiddenAreFound) {
  System system;
  system.add(HalfPlane{.normal = {0, 1}, .filter = {.groups = 2}}, rough, "floor");
  const BodyId body = system.add(RigidBody{.mass = disc(1.0, 1.0)});
  system.add(Disc{.body = body, .radius = 1.0}, "rim");
  EXPECT_TRUE(system.check().empty());
  system.add(Point{.body = body, .filter = {.touches = 16}}, "ghost");
  system.add(Point{.body = body, .filter = {.groups = 16, .touches = 16}}, "nobody");
  system.add(Point{.body = body, .filter = {.touches = 1}}, "other");
  system.add(Particle{.mass = 1.0, .filter = {.touches = 4}}, "dust");
  system.add(Particle{.mass = 1.0, .contact = false, .filter = {.touches = 4}}, "pivot");
  const auto found = system.check();
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].kind, FindingKind::hidden_by_filter);
  EXPECT_EQ(to_string(found[0].kind), "hidden by a filter");
  EXPECT_EQ(found[0].parts, (std::vector<std::string>{"particle 'dust'", "point 'ghost'", "point 'nobody'",
                                                      "point 'other'"}));
  EXPECT_NE(found[0].text.find("particle 'dust'"), std::string::npos) << found[0].text;
  // An obstacle that nothing may touch.
  system.add(HalfPlane{.normal = {1, 0}, .filter = {.touches = 8}}, rough, "wall");
  const auto more = system.check();
  ASSERT_EQ(more.size(), 2U);
  EXPECT_EQ(more[1].kind, FindingKind::hidden_by_filter);
  EXPECT_EQ(more[1].parts, std::vector<std::string>{"half-plane 'wall'"});
}

TEST(ContactFilter, OneThatHidesEverythingIsRefusedByName) {
  for (const bool groups : {true, false}) {
    const ContactFilter none = groups ? ContactFilter{.groups = 0} : ContactFilter{.touches = 0};
    const std::string what = groups ? "filter.groups is 0" : "filter.touches is 0";
    const auto expect_refused = [&](const char* name, const auto& add) {
      System system;
      const BodyId body = system.add(RigidBody{.mass = disc(1.0, 1.0)});
      try {
        add(system, body);
        ADD_FAILURE() << name;
      } catch (const ModelError& error) {
        const std::string text = error.what();
        EXPECT_NE(text.find(name), std::string::npos) << text;
        EXPECT_NE(text.find(what), std::string::npos) << text;
        EXPECT_NE(text.find("allowed: at least one group"), std::string::npos) << text;
      }
    };
    expect_refused("disc 'rim'", [&](System& system, BodyId body) {
      system.add(Disc{.body = body, .radius = 1.0, .filter = none}, "rim");
    });
    expect_refused("half-plane 'floor'", [&](System& system, BodyId) {
      system.add(HalfPlane{.normal = {0, 1}, .filter = none}, rough, "floor");
    });
    expect_refused("peg 'pin'", [&](System& system, BodyId) {
      system.add(Peg{.centre = {0, 0}, .radius = 1.0, .filter = none}, rough, "pin");
    });
    expect_refused("particle 'dust'", [&](System& system, BodyId) {
      system.add(Particle{.mass = 1.0, .filter = none}, "dust");
    });
    System system;  // what touches nothing anyway may have any
    EXPECT_NO_THROW(system.add(Particle{.mass = 1.0, .contact = false, .filter = none}));
  }
}

TEST(ContactFilter, APairThatIsFilteredNeedsNoLaw) {
  System system;
  system.add(HalfPlane{.normal = {0, 1}, .filter = {.groups = 2}}, "floor");
  system.add(HalfPlane{.normal = {1, 0}}, rough, "wall");
  system.add(Particle{.mass = 1.0, .filter = {.touches = 1}}, "ball");
  const auto found = system.check();
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].parts, std::vector<std::string>{"half-plane 'floor'"});
  const std::string text = to_dot(system);
  EXPECT_NE(text.find("body0 -- obstacle1"), std::string::npos) << text;
  EXPECT_EQ(text.find("body0 -- obstacle0"), std::string::npos) << text;
}

TEST(ContactDecisions, AreCheckedKeptAndRemovedWithTheirBodies) {
  System system;
  const BodyId a = system.add(Particle{.mass = 1.0}), b = system.add(Particle{.mass = 1.0}),
               c = system.add(Particle{.mass = 1.0});
  const std::uint64_t print = system.fingerprint();
  EXPECT_FALSE(system.is_contact_allowed(a, b).has_value());
  system.allow_contact(a, b);
  system.allow_contact(c, a, false);
  EXPECT_EQ(system.is_contact_allowed(b, a), true);
  EXPECT_EQ(system.is_contact_allowed(a, c), false);
  EXPECT_NE(system.fingerprint(), print);
  const System copy = system;
  EXPECT_EQ(copy.fingerprint(), system.fingerprint());
  EXPECT_EQ(copy.is_contact_allowed(a, b), true);
  system.allow_contact(b, a, std::nullopt);
  EXPECT_FALSE(system.is_contact_allowed(a, b).has_value());
  system.allow_contact(a, c, {});
  EXPECT_EQ(system.fingerprint(), print);
  system.allow_contact(a, c);
  system.allow_contact(a, b);
  system.remove(c);
  const std::vector<ContactDecision> decisions = system.contact_decisions();
  ASSERT_EQ(decisions.size(), 1U);
  EXPECT_EQ(decisions[0].a, a);
  EXPECT_EQ(decisions[0].b, b);
  EXPECT_TRUE(decisions[0].allowed);
  EXPECT_MODEL_ERROR(system.allow_contact(a, c), "contact of two bodies", "a body that was removed");
  EXPECT_MODEL_ERROR(system.allow_contact(a, a), "second body is particle #0, the first", "another body");
  EXPECT_MODEL_ERROR(system.allow_contact(a, ground), "ground", "a body of this system");
  EXPECT_MODEL_ERROR(system.is_contact_allowed(BodyId{}, a), "not given");
}

}  // namespace
