// Names of parts outlive the parts: events, reports and keys from before an edit are named as before. Every
// function that takes an identity answers, or refuses by name, one of a removed part, of another system, or
// made by default.

#include "tests/model_error.h"
#include "tests/temporary_folder.h"

#include <carom/carom.h>
#include <carom/contact/detection/contact_name.h>
#include <carom/core/assembly.h>
#include <carom/joints/on_coordinate.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;

const Surface rough{.friction = 0.3, .normal_restitution = 0.5};

/// A ball, a disc and a pendulum with a stop and friction over a floor; a cable that goes taut.
System scene() {
  System system;
  system.add(Gravity{{0.0, -9.81}}, "gravity");
  system.add(HalfPlane{.normal = {0.0, 1.0}}, rough, "floor");
  const BodyId ball = system.add(Particle{.mass = 1.0, .position = {0.0, 0.2}}, "ball");
  const BodyId wheel = system.add(RigidBody{.mass = disc(1.0, 0.1), .position = {1.0, 0.3}}, "wheel");
  system.add(Disc{.body = wheel, .radius = 0.1}, "rim");
  const BodyId rod_body = system.add(RigidBody{.mass = rod(1.0, 0.2), .position = {3.1, 1.0}}, "rod");
  const JointId pin =
      system.add(Revolute{.from = End<2>(ground, {3.0, 1.0}), .to = End<2>(rod_body, {-0.1, 0.0})}, "pin");
  system.add(Stop{.joint = pin, .lower = -0.3, .restitution = 0.5}, "stop");
  system.add(JointFriction{.joint = pin, .bound = 0.01}, "bearing");
  system.add(Cable{.from = End<2>(ground, {0.0, 0.3}), .to = ball, .stiffness = 100.0, .free_length = 0.2},
             "rope");
  return system;
}

void remove_all(System& system) {
  for (const ElementId id : system.elements()) system.remove(id);
  for (const char* const name : {"stop", "bearing", "pin"}) system.remove(system.joint(name));
  for (const ShapeId id : system.shapes()) system.remove(id);
  for (const ObstacleId id : system.obstacles()) system.remove(id);
  for (const BodyId id : system.bodies()) system.remove(id);
  // Names are free for others.
  system.add(Particle{.mass = 1.0, .contact = false}, "wheel");
}

std::vector<std::string> names_of_events(const Simulation& simulation) {
  std::vector<std::string> names;
  for (const EventRecord& event : simulation.events()) {
    names.push_back(event.element.valid() ? simulation.system().name(event.element)
                                          : simulation.name(event.contact));
    if (event.body.valid()) names.push_back(simulation.system().name(event.body));
    if (event.obstacle.valid()) names.push_back(simulation.system().name(event.obstacle));
  }
  return names;
}

std::string text_of(const std::string& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

TEST(NamesOutlive, EventsOfRemovedParts) {
  const carom_test::TemporaryFolder folder;
  Simulation simulation(scene(), EventDriven{});
  simulation.run_until(1.0);
  const std::vector<std::string> before = names_of_events(simulation);
  for (const char* const part :
       {"particle 'ball' on half-plane 'floor'",
        "disc 'rim' (feature 0) of rigid body 'wheel' on half-plane 'floor'", "stop 'stop' (lower)"}) {
    EXPECT_NE(std::find(before.begin(), before.end(), part), before.end()) << part;
  }
  const std::string file = folder / "events.csv";
  simulation.write_events(file);
  const std::string written = text_of(file);
  simulation.edit(remove_all);
  EXPECT_EQ(names_of_events(simulation), before);
  simulation.write_events(file);
  EXPECT_GT(text_of(file).size(), 1000U);
  simulation.step();
  EXPECT_EQ(names_of_events(simulation), before);
  // Those of elements may tell fewer of the bodies they acted on.
  EXPECT_EQ(written.find("rope") != std::string::npos, text_of(file).find("rope") != std::string::npos);
  // A second edit, a change of mode, a checkpoint: still the same.
  simulation.edit([](System& system) { system.add(Particle{.mass = 1.0, .contact = false}); });
  simulation.switch_to(TimeStepping{});
  simulation.step();
  const std::string checkpoint = folder / "run";
  simulation.save(checkpoint);
  simulation.load(checkpoint);
  EXPECT_EQ(names_of_events(simulation), before);
}

TEST(NamesOutlive, ReportsAndStatesOfTimeStepping) {
  Simulation simulation(scene(), TimeStepping{.step = 1e-3});
  std::vector<ConstraintKey> keys;
  std::vector<std::string> names;
  simulation.observe([&](const Simulation& now) {
    for (const ContactRecord& contact : now.report().contacts) {
      keys.push_back(contact.key);
      names.push_back(now.name(contact.key));
    }
  });
  simulation.run_until(0.5);
  ASSERT_GT(keys.size(), 10U);
  const State before = simulation.state();
  const JointId pin = simulation.system().joint("pin");
  const double angle = before.coordinate(pin);
  simulation.edit(remove_all);
  for (std::size_t i = 0; i < keys.size(); ++i) EXPECT_EQ(simulation.name(keys[i]), names[i]);
  EXPECT_EQ(before.coordinate(pin), angle);  // a state keeps what it needs
  EXPECT_MODEL_ERROR(simulation.state().coordinate(pin), "not in this model");
  EXPECT_MODEL_ERROR(simulation.reaction(pin), "revolute joint 'pin'", "removed");
  EXPECT_MODEL_ERROR(simulation.set_state(before), "state");
  EXPECT_MODEL_ERROR((void)total_momentum(simulation.assembly(), before), "state");
  EXPECT_MODEL_ERROR((void)mobility(simulation.assembly(), before), "state");
}

TEST(NamesOutlive, IdentitiesThatAreNoParts) {
  System system = scene(), other = scene();
  const BodyId gone = system.add(Particle{.mass = 1.0}, "gone");
  system.remove(gone);
  const JointId pin = system.joint("pin");
  const ObstacleId wall = system.add(HalfPlane{.normal = {1.0, 0.0}}, rough, "wall");
  system.remove(wall);
  const ShapeId tip = system.add(Point{.body = system.body("wheel")}, "tip");
  system.remove(tip);
  Simulation simulation(system, EventDriven{});
  const State& state = simulation.state();

  EXPECT_EQ(system.name(gone), "particle 'gone'");
  EXPECT_EQ(system.given_name(gone), "gone");
  EXPECT_EQ(system.name(wall), "half-plane 'wall'");
  EXPECT_EQ(system.body_of(tip), system.body("wheel"));
  EXPECT_EQ(system.name(BodyId{1000, system.token()}), "part that was never given");
  for (const BodyId bad : {gone, BodyId{}, other.body("ball"), BodyId{1000, system.token()}}) {
    EXPECT_MODEL_ERROR((void)system.keeps_place(bad), "body", "allowed");
    EXPECT_MODEL_ERROR(system.keep_place(bad), "body", "allowed");
    EXPECT_MODEL_ERROR((void)system.has_orientation(bad), "body", "allowed");
    EXPECT_MODEL_ERROR(system.remove(bad), "body", "allowed");
    if (bad != gone) {
      EXPECT_MODEL_ERROR((void)system.given_name(bad), "body", "allowed");
    }
    EXPECT_MODEL_ERROR((void)state.position(bad), "body", "allowed");
    EXPECT_MODEL_ERROR((void)state.velocity(bad), "body", "allowed");
    EXPECT_MODEL_ERROR((void)state.angle(bad), "body", "allowed");
    EXPECT_MODEL_ERROR((void)state.spin(bad), "body", "allowed");
    EXPECT_MODEL_ERROR(system.add(Disc{.body = bad, .radius = 1.0}), "body", "allowed");
    EXPECT_MODEL_ERROR(system.add(SpringDamper{.from = ground, .to = bad}), "to is", "allowed");
  }
  EXPECT_MODEL_ERROR((void)system.keeps_place(ground), "ground", "allowed");
  EXPECT_FALSE(system.has_orientation(ground));
  EXPECT_EQ(system.given_name(ground), "");
  for (const JointId bad : {JointId{}, other.joint("pin"), JointId{1000, system.token()}}) {
    EXPECT_MODEL_ERROR((void)state.coordinate(bad), "joint", "allowed");
    EXPECT_MODEL_ERROR((void)state.rate(bad), "joint", "allowed");
    EXPECT_MODEL_ERROR((void)simulation.reaction(bad), "joint", "allowed");
    EXPECT_MODEL_ERROR((void)bodies_of(system, bad), "joint", "allowed");
    EXPECT_MODEL_ERROR((void)coordinate_row(*state.layout(), bad, {state.view(), nullptr}), "joint",
                       "allowed");
    EXPECT_MODEL_ERROR(system.add(Stop{.joint = bad, .lower = 0.0}), "joint", "allowed");
    EXPECT_MODEL_ERROR(system.remove(bad), "joint", "allowed");
  }
  EXPECT_EQ(bodies_of(system, pin).size(), 2U);
  for (const ObstacleId bad : {wall, ObstacleId{}, other.obstacle("floor")}) {
    EXPECT_MODEL_ERROR((void)system.law({}, bad), "obstacle", "allowed");
    EXPECT_MODEL_ERROR(system.remove(bad), "obstacle", "allowed");
  }
  for (const ShapeId bad : {ShapeId{}, other.shape("rim"), ShapeId{1000, system.token()}}) {
    EXPECT_MODEL_ERROR((void)system.body_of(bad), "shape", "allowed");
    EXPECT_MODEL_ERROR(system.remove(bad), "shape", "allowed");
  }
  for (const ElementId bad : {ElementId{}, other.element("rope"), system.element("rope")}) {
    EXPECT_MODEL_ERROR((void)state.internal(bad), "element", "allowed");
  }
}

TEST(NamesOutlive, KeysMadeByHand) {
  Simulation simulation(scene(), EventDriven{});
  using Owner = FeatureKey::Owner;
  const FeatureKey floor{Owner::obstacle, 0, 0};
  EXPECT_EQ(simulation.name(ConstraintKey{}), "no contact");
  EXPECT_EQ(simulation.name({{Owner::body, 0, 0}, floor}), "particle 'ball' on half-plane 'floor'");
  const std::vector<ConstraintKey> bad{{{Owner::body, 99, 0}, floor},
                                       {{Owner::shape, 99, 0}, floor},
                                       {{Owner::shape, 0, 7}, floor},
                                       {{Owner::joint, 99, 0}, {Owner::joint, 99, 0}},
                                       {{Owner::joint, 0, 5}, {Owner::joint, 0, 5}},
                                       {{Owner::joint, 1, 2}, {Owner::joint, 1, 2}},
                                       {{Owner::obstacle, 0, 0}, floor},
                                       {{static_cast<Owner>(77), 0, 0}, floor},
                                       {{Owner::body, 0, 0}, {Owner::obstacle, 99, 0}},
                                       {{Owner::body, 0, 0}, {Owner::body, 0, 0}},
                                       {{Owner::body, 0, 0}, {static_cast<Owner>(77), 0, 0}},
                                       {{Owner::body, 0, 0}, {}},
                                       {{Owner::body, none, 0}, floor}};
  for (const ConstraintKey& key : bad) {
    EXPECT_MODEL_ERROR((void)simulation.name(key), "contact:", "allowed");
    EXPECT_MODEL_ERROR((void)contact_name(System(), key), "contact:", "allowed");
  }
}

}  // namespace
