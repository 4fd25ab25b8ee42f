// The page docs/joints.md: the systems it shows, and what it says of them.

#include <carom/carom.h>

#include "tests/joints/joint_model.h"
#include "tests/page_blocks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

using namespace carom;
using namespace carom::planar;

namespace {

// The page shows these.
System pendulum() {
  System system;
  system.add(Gravity{{0.0, -9.81}});
  const BodyId bar = system.add(RigidBody{.mass = rod(2.0, 1.0), .position = {0.5, 0.0}}, "bar");
  const JointId pin = system.add(Revolute{.from = ground, .to = {bar, {-0.5, 0.0}}}, "pin");
  const auto brake = [](double, double, double rate) { return -0.1 * rate; };
  system.add(Motor{.joint = pin, .torque = brake});  // on the bar, against its turning
  return system;
}

System gallows() {
  System system;
  const BodyId post = system.add(RigidBody{.mass = rod(5.0, 2.0), .angle = std::numbers::pi / 2.0});
  const BodyId arm = system.add(RigidBody{.mass = rod(2.0, 1.0), .position = {0.5, 1.0}});
  system.add(Weld{.from = {ground, {0.0, -1.0}}, .to = {post, {-1.0, 0.0}}}, "foot");
  system.add(Weld{.from = {post, {1.0, 0.0}}, .to = {arm, {-0.5, 0.0}}}, "corner");
  return system;
}

System lift() {
  System system;
  const BodyId cabin = system.add(RigidBody{.mass = box(800.0, 1.5, 2.0)}, "cabin");
  const JointId rails = system.add(Prismatic{.from = ground, .to = cabin, .axis = {0.0, 1.0}}, "rails");
  system.add(Driver{.joint = rails,
                    .position = [](double t) { return 1.0 - std::cos(t); },  // up 2 m and back again
                    .velocity = [](double t) { return std::sin(t); },
                    .acceleration = [](double t) { return std::cos(t); }},
             "hoist");
  return system;
}

System yoke() {
  System system;
  const BodyId crank = system.add(RigidBody{.mass = disc(1.0, 0.2), .spin = 6.0}, "crank");
  const BodyId slider = system.add(RigidBody{.mass = box(0.5, 0.1, 0.6), .position = {0.2, 0.0}}, "slider");
  system.add(Revolute{.from = ground, .to = crank});
  system.add(Prismatic{.from = ground, .to = slider, .axis = {1.0, 0.0}}, "guide");
  // The pin of the crank runs in an upright slot of the slider.
  system.add(PointOnLine{.from = slider, .to = {crank, {0.2, 0.0}}, .axis = {0.0, 1.0}}, "slot");
  return system;
}

System wheel() {
  System system;
  const BodyId rim = system.add(RigidBody{.mass = ring(1.0, 0.3), .position = {0.0, 0.3}}, "rim");
  system.add(Rolling{.from = ground, .to = rim, .normal = {0.0, 1.0}, .radius = 0.3}, "road");
  return system;
}

System double_pendulum() {
  System system;
  const BodyId upper = system.add(Particle{.mass = 1.0, .position = {1.0, 0.0}});
  const BodyId lower = system.add(Particle{.mass = 1.0, .position = {1.0, -1.0}});
  system.add(Rod{.from = ground, .to = upper});
  system.add(Rod{.from = upper, .to = lower}, "lower rod");
  return system;
}

System planet_gear() {
  System system;
  const BodyId sun = system.add(RigidBody{.mass = disc(1.0, 0.2)}, "sun");
  const BodyId planet = system.add(RigidBody{.mass = disc(0.2, 0.1), .position = {0.3, 0.0}}, "planet");
  const BodyId arm = system.add(RigidBody{.mass = rod(0.5, 0.6)}, "arm");
  system.add(Revolute{.from = ground, .to = sun});
  system.add(Revolute{.from = ground, .to = arm});
  system.add(Revolute{.from = {arm, {0.3, 0.0}}, .to = planet});
  system.add(Gear{.from = sun, .to = planet, .ratio = 2.0, .carrier = arm}, "mesh");
  return system;
}

System buffer() {
  System system;
  system.add(Gravity{{0.0, -9.81}});
  const BodyId block = system.add(RigidBody{.mass = box(1.0, 0.2, 0.2), .position = {0.0, 1.0}}, "block");
  const JointId guide = system.add(Prismatic{.from = ground, .to = block, .axis = {0.0, 1.0}}, "guide");
  system.add(Stop{.joint = guide, .lower = -0.9, .restitution = 0.5}, "buffer");
  return system;
}

System swing_door() {
  System system;
  const BodyId door =
      system.add(RigidBody{.mass = box(20.0, 0.9, 0.04), .position = {0.45, 0.0}, .spin = 1.0}, "door");
  const JointId hinge = system.add(Revolute{.from = ground, .to = {door, {-0.45, 0.0}}}, "hinge");
  // 2 N m, half as much again to get it going, and mu r |R| of a pin of 8 mm with mu = 0.2.
  system.add(JointFriction{.joint = hinge, .bound = 2.0, .coefficient = 0.2 * 0.008, .static_factor = 1.5},
             "rust");
  return system;
}

using carom_test::JointModel;
using carom_test::text_of;

TEST(JointsPage, ShowsWhatIsTestedHere) {
  const std::string source = text_of("tests/joints/joints_page_test.cpp");
  const auto blocks = carom_test::code_blocks("docs/joints.md", "cpp");
  for (const std::string& block : blocks) EXPECT_NE(source.find(block), std::string::npos) << block;
  EXPECT_EQ(blocks.size(), 9u);
}

TEST(JointsPage, NamesEveryJoint) {
  const std::string page = text_of("docs/joints.md");
  for (const char* name : {"Revolute", "Weld", "Prismatic", "PointOnLine", "Rolling", "Rod", "Gear", "Driver",
                           "Motor", "Stop", "JointFriction", "JointReaction"}) {
    EXPECT_NE(page.find("`" + std::string(name) + "`"), std::string::npos) << name;
  }
}

TEST(JointsPage, ItsSystemsHangTogetherAsDescribed) {
  const std::vector<System> systems{pendulum(),        gallows(),     lift(),   yoke(),      wheel(),
                                    double_pendulum(), planet_gear(), buffer(), swing_door()};
  for (const System& system : systems) {
    const JointModel model(system);
    for (const JointId joint : system.joints()) {
      for (const JointRow& row : model.rows(joint)) EXPECT_NEAR(row.gap, 0.0, 1e-15) << system.name(joint);
    }
  }
}

TEST(JointsPage, WhatItSaysOfThem) {
  JointModel rolling(wheel());
  const BodyId rim = rolling.assembly.system().body("rim");
  rolling.state.velocity(rim) = Vec<2>(1.5, 0.0);
  rolling.state.spin(rim) = -5.0;  // clockwise, to the right
  const JointId road = rolling.assembly.system().joint("road");
  EXPECT_NEAR(rolling.state.rate(road), 1.5, 1e-15);
  const std::vector<JointRow> rows = rolling.rows(road);
  EXPECT_NEAR(rows[0].times(rolling.state.v.data()), 0.0, 1e-15);
  EXPECT_NEAR(rows[1].times(rolling.state.v.data()), 0.0, 1e-15);
  // The arm goes round once while the sun stands: the planet turns 1 + 2 times.
  JointModel gears(planet_gear());
  const System& system = gears.assembly.system();
  gears.state.angle(system.body("arm")) = 1.0;
  gears.state.angle(system.body("planet")) = 3.0;
  EXPECT_NEAR(gears.rows(system.joint("mesh"))[0].gap, 0.0, 1e-15);
  // The hoist carries the cabin.
  JointModel hoisted(lift());
  const JointId hoist = hoisted.assembly.system().joint("hoist");
  static_cast<void>(hoisted.acceleration());
  EXPECT_NEAR(hoisted.reaction(hoist).moment, 800.0, 1e-9);  // the weight is not in the system
}

}  // namespace
