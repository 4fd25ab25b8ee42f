#include <carom/carom.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "tests/allocation_counter.h"
#include "tests/integrators/throws.h"
#include "tests/temporary_folder.h"

namespace {

using namespace carom;
using namespace carom::planar;

System bouncing_disc(double restitution) {
  System system;
  system.add(Gravity{{0.0, -9.81}});
  system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = 0.3, .normal_restitution = restitution},
             "the \"floor\"");
  const BodyId disc_body =
      system.add(RigidBody{.mass = disc(1.0, 0.1), .position = {0.0, 1.1}, .velocity = {1.0, 0.0}}, "disc");
  system.add(Disc{.body = disc_body, .radius = 0.1});
  return system;
}

TEST(EventLog, EveryImpactIsToldWithItsNumbers) {
  Simulation simulation(bouncing_disc(0.5), EventDriven{});
  simulation.run_until(1.0);
  ASSERT_GE(simulation.events().size(), 2U);
  const EventRecord& first = simulation.events().front();
  EXPECT_EQ(first.kind, EventKind::impact);
  EXPECT_EQ(simulation.system().name(first.obstacle), "half-plane 'the \"floor\"'");
  EXPECT_NEAR(first.velocity_after[0], -0.5 * first.velocity_before[0], 1e-14);
  EXPECT_NEAR(first.impulse[0], 1.5 * -first.velocity_before[0], 1e-13);  // 1 kg
  EXPECT_EQ(first.outcome, Outcome::solved);
  EXPECT_LE(first.residual, 1e-12);
  EXPECT_EQ(first.solver, "single contact");
  EXPECT_LT(first.energy_after, first.energy_before);
  const std::int64_t impacts = simulation.statistics().events[static_cast<std::size_t>(EventKind::impact)];
  EXPECT_EQ(impacts, simulation.statistics().impacts);
  EXPECT_GT(simulation.statistics().flow_restarts, impacts);
  simulation.clear_events();
  EXPECT_TRUE(simulation.events().empty());
}

TEST(EventLog, AnImpactHasTheMotionOfItsBody) {
  Simulation simulation(bouncing_disc(0.5), EventDriven{});
  simulation.run_until(1.0);
  const EventRecord& first = simulation.events().front();
  const EventMotion& motion = first.motions[0];
  EXPECT_EQ(motion.body, first.body);
  EXPECT_FALSE(first.motions[1].body.valid());
  const double time = std::sqrt(2.0 * 1.0 / 9.81);
  EXPECT_NEAR(motion.position[0], time, 1e-9);  // at 1 m/s
  EXPECT_NEAR(motion.position[1], 0.1, 1e-12);
  EXPECT_EQ(motion.position[2], 0.0);
  EXPECT_EQ(motion.velocity_before[0], 1.0);
  EXPECT_EQ(motion.velocity_before[1], first.velocity_before[0]);
  EXPECT_EQ(motion.velocity_before[2], 0.0);
  EXPECT_EQ(motion.velocity_after[1], first.velocity_after[0]);
  // The impulse changes momentum and spin: 1 kg, 0.005 kg m^2, the tangent to the right, 0.1 m above it.
  EXPECT_NEAR(motion.velocity_after[0] - 1.0, first.impulse[1], 1e-14);
  EXPECT_NEAR(0.005 * motion.velocity_after[2], 0.1 * first.impulse[1], 1e-14);
}

TEST(EventLog, RecordsOfAnInstantHaveItsNumber) {
  // Two boxes that land flat, on two corners each, one after the other.
  System system;
  system.add(Gravity{{0.0, -9.81}});
  system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = 0.0, .normal_restitution = 0.5});
  for (const double x : {0.0, 1.0}) {
    const BodyId body = system.add(RigidBody{.mass = box(1.0, 0.2, 0.2), .position = {x, 0.6 - 0.1 * x}});
    system.add(Segment{.body = body, .from = {-0.1, -0.1}, .to = {0.1, -0.1}});
  }
  Simulation simulation(system, EventDriven{});
  simulation.run_until(0.4);
  simulation.run_until(0.8);
  const std::vector<EventRecord>& events = simulation.events();
  ASSERT_GE(events.size(), 8U);
  EXPECT_EQ(events.front().instant, 0);
  for (std::size_t i = 1; i < events.size(); ++i) {
    const bool same = events[i].time == events[i - 1].time && events[i].body == events[i - 1].body;
    EXPECT_EQ(events[i].instant - events[i - 1].instant, same ? 0 : 1) << i;
  }
  EXPECT_EQ(events[1].instant, 0);
  EXPECT_EQ(events[2].instant, 1);
  simulation.clear_events();
  simulation.run_until(1.2);
  ASSERT_FALSE(events.empty());
  EXPECT_EQ(events.front().instant, 0);
}

/// A particle that slides along a floor and hits a wall: the floor gives no impulse.
System sliding_against_a_wall() {
  System system;
  system.add(Gravity{{0.0, -9.81}});
  system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = 0.1, .normal_restitution = 0.5}, "floor");
  system.add(HalfPlane{.point = {1.0, 0.0}, .normal = {-1.0, 0.0}},
             Surface{.friction = 0.0, .normal_restitution = 0.5}, "wall");
  system.add(Particle{.mass = 1.0, .velocity = {3.0, 0.0}});
  return system;
}

TEST(EventLog, ContactsWithoutAnImpulseAreRecordedWhereAsked) {
  Simulation usual(sliding_against_a_wall(), EventDriven{.record_events = EventRecords::with_impulse});
  Simulation all(sliding_against_a_wall(), EventDriven{});
  for (Simulation* simulation : {&usual, &all}) simulation->run_until(1.0);
  const auto impacts_on = [](const Simulation& simulation, const char* name) {
    const ObstacleId obstacle = simulation.system().obstacle(name);
    std::vector<EventRecord> found;
    for (const EventRecord& event : simulation.events()) {
      if (event.kind == EventKind::impact && event.obstacle == obstacle) found.push_back(event);
    }
    return found;
  };
  EXPECT_EQ(impacts_on(usual, "wall").size(), 1U);
  EXPECT_TRUE(impacts_on(usual, "floor").empty());
  EXPECT_EQ(impacts_on(all, "wall").size(), 1U);
  ASSERT_EQ(impacts_on(all, "floor").size(), 1U);
  const EventRecord floor = impacts_on(all, "floor").front(), wall = impacts_on(all, "wall").front();
  EXPECT_EQ(floor.impulse, (std::array<double, 3>{}));
  EXPECT_EQ(floor.instant, wall.instant);
  EXPECT_EQ(floor.time, wall.time);
  // The motion is the same, and so is what is counted.
  EXPECT_EQ(usual.state().q, all.state().q);
  EXPECT_EQ(usual.statistics().events, all.statistics().events);
  EXPECT_EQ(usual.statistics().impacts, 1);
}

TEST(EventLog, WritesALineForEveryEvent) {
  const carom_test::TemporaryFolder folder;
  const std::string path = folder / "events.csv";
  Simulation simulation(bouncing_disc(0.5), EventDriven{});
  simulation.run_until(3.0);
  simulation.write_events(path);
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  EXPECT_EQ(line.substr(0, 30), "time [s],kind,part,normal velo");
  std::size_t lines = 0;
  while (std::getline(file, line)) {
    EXPECT_NE(line.find("\"disc #0 (feature 0) of rigid body 'disc' on half-plane 'the \"\"floor\"\"'\""),
              std::string::npos)
        << line;
    ++lines;
  }
  EXPECT_EQ(lines, simulation.events().size());
  EXPECT_THROW(simulation.write_events(folder / "missing/events.csv"), FileError);
}

// Events without a contact are named by the part whose loads or motion switched, with the bodies it acts on.
TEST(EventLog, NamesThePartOfEveryEvent) {
  System system;
  const BodyId ball = system.add(Particle{.mass = 1.0, .velocity = {1.0, 0.0}}, "ball");
  system.add(Cable{.from = {ground, {-0.5, 0.0}}, .to = ball, .stiffness = 100.0, .free_length = 0.7},
             "rope");
  const std::vector<double> both{0.3};
  system.add(AppliedForce{.on = ball, .force = [](double) { return Vec<2>(0.0, 0.0); }, .breaks = both},
             "wind");
  const BodyId bar = system.add(
      RigidBody{.mass = rod(1.0, 1.0), .position = {0.5, 5.0}, .velocity = {0.0, 0.05}, .spin = 0.1}, "bar");
  const JointId pin = system.add(Revolute{.from = {ground, {0.0, 5.0}}, .to = {bar, {-0.5, 0.0}}}, "pin");
  system.add(Driver{.joint = pin, .position = [](double t) { return 0.1 * t; }, .breaks = {0.4}}, "crank");
  system.add(Motor{.joint = pin, .torque = [](double, double, double) { return 0.0; }, .breaks = {0.4}});
  HalfPlane table{.point = {0.0, -9.0}, .normal = {0.0, 1.0}};
  table.motion.displacement = [](double) { return Vec<2>(0.0, 0.0); };
  table.motion.breaks = both;
  system.add(table, Surface{.friction = 0.0, .normal_restitution = 0.0}, "table");

  const carom_test::TemporaryFolder folder;
  Simulation simulation(system, EventDriven{});
  simulation.run_until(0.6);
  simulation.write_events(folder / "events.csv");
  const std::string table_of_events = folder.text_of("events.csv");
  std::map<std::string, int> named;
  for (const EventRecord& event : simulation.events()) {
    const std::string name = simulation.name(event);
    EXPECT_EQ(name.find("never given"), std::string::npos) << to_string(event.kind);
    EXPECT_NE(table_of_events.find("," + name + ","), std::string::npos) << name;
    ++named[std::string(to_string(event.kind)) + " of " + name];
  }
  const std::map<std::string, int> expected{
      {"switching point of cable 'rope' between ground and particle 'ball'", 2},
      {"discontinuity of applied force 'wind' on particle 'ball'", 1},
      {"discontinuity of driver 'crank'", 1},
      {"discontinuity of motor #2 between ground and rigid body 'bar'", 1},
      {"discontinuity of half-plane 'table'", 1},
  };
  EXPECT_EQ(named, expected);
}

TEST(EventLog, PartsOfAnotherModelHaveNoName) {
  System here, there;
  here.add(RigidBody{.mass = rod(1.0, 1.0)});
  const BodyId ball = there.add(Particle{.mass = 1.0}), bar = there.add(RigidBody{.mass = rod(1.0, 1.0)});
  EventRecord joint, element, obstacle;
  joint.joint = there.add(Revolute{.from = ground, .to = bar});
  element.element = there.add(Cable{.from = ground, .to = ball, .stiffness = 1.0, .free_length = 1.0});
  obstacle.obstacle =
      there.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = 0.0, .normal_restitution = 0.0});
  const Simulation simulation(here, EventDriven{});
  EXPECT_THROWS(ModelError, (void)simulation.name(joint), "joint", "of another system", "allowed");
  EXPECT_THROWS(ModelError, (void)simulation.name(element), "element", "of another system", "allowed");
  EXPECT_THROWS(ModelError, (void)simulation.name(obstacle), "obstacle", "of another system", "allowed");
}

TEST(EventLog, RecordsNothingWhereNotAskedTo) {
  Simulation simulation(bouncing_disc(0.5), EventDriven{.record_events = false});
  simulation.run_until(3.0);
  EXPECT_TRUE(simulation.events().empty());
  EXPECT_GT(simulation.statistics().impacts, 5);
}

// Whoever looks often, and has a long interval besides, still gets every moment.
TEST(EventDriver, ALongIntervalSkipsNothing) {
  System system;
  system.add(Gravity{{0.0, -10.0}});
  const BodyId body = system.add(Particle{.mass = 1.0});
  Simulation simulation(system, EventDriven{.interval = 1e9});
  int fired = 0;
  simulation.every(0.1, [&fired](Simulation&) { ++fired; });
  for (int i = 1; i <= 50; ++i) simulation.run_until(0.1 * i);
  EXPECT_EQ(fired, 50);
  EXPECT_NEAR(simulation.state().position(body)[1], -125.0, 1e-11);
  EXPECT_EQ(simulation.time(), 5.0);
}

TEST(EventDriver, ImpactsAllocateNothing) {
  for (const FlowMethod method : {FlowMethod::explicit_runge_kutta, FlowMethod::one_step}) {
    Simulation simulation(bouncing_disc(1.0), EventDriven{.method = method, .record_events = false});
    simulation.run_until(20.0);
    const std::int64_t impacts = simulation.statistics().impacts;
    const std::int64_t before = carom_test::allocations();
    simulation.run_until(120.0);
    EXPECT_EQ(carom_test::allocations() - before, 0);
    EXPECT_GT(simulation.statistics().impacts, impacts + 100);
  }
}

TEST(EventDriver, FrictionTransitionsAllocateNothing) {
  System system;
  system.add(Gravity{{0.0, -9.81}});
  system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = 0.01, .normal_restitution = 0.0});
  const BodyId block = system.add(Particle{.mass = 1.0, .position = {20.0, 0.0}});
  system.add(
      SpringDamper{.from = {ground, {-50.0, 0.0}}, .to = block, .stiffness = 100.0, .free_length = 50.0});
  Simulation simulation(system, EventDriven{.record_events = false});
  for (const double time : {1.0, 2.0}) simulation.run_until(time);  // some memory changes sides
  const auto slips = [&] {
    return simulation.statistics().events[static_cast<std::size_t>(EventKind::slip)];
  };
  const std::int64_t before = carom_test::allocations(), turns = slips();
  simulation.run_until(20.0);
  EXPECT_EQ(carom_test::allocations() - before, 0);
  EXPECT_GT(slips(), turns + 50);
}

}  // namespace
