// Impacts in the report of a step that nobody looked at while it was made.

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

namespace {

using namespace carom;

constexpr double end = 1.0;  // [s]

System bouncing_ball() {
  System system;
  system.add(planar::Gravity{{0.0, -9.81}});
  system.add(planar::HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = 0.3, .normal_restitution = 0.9});
  constexpr double radius = 0.01, mass = 0.01;  // [m], [kg]
  const BodyId ball = system.add(planar::RigidBody{
      .mass = planar::solid_sphere(mass, radius), .position = {0.0, 0.06}, .velocity = {0.2, 0.0}});
  system.add(planar::Disc{.body = ball, .radius = radius});
  return system;
}

/// Records of impacts since the last look.
std::vector<EventRecord> impacts(const Simulation& simulation, std::size_t from = 0) {
  std::vector<EventRecord> found;
  for (std::size_t i = from; i < simulation.events().size(); ++i) {
    const EventRecord& event = simulation.events()[i];
    if (event.kind == EventKind::impact || event.kind == EventKind::accumulation) found.push_back(event);
  }
  return found;
}

void expect_listed(const std::vector<ContactRecord>& listed, const std::vector<EventRecord>& expected) {
  ASSERT_EQ(listed.size(), expected.size());
  for (std::size_t i = 0; i < listed.size(); ++i) {
    EXPECT_EQ(listed[i].key, expected[i].contact);
    EXPECT_EQ(listed[i].body, expected[i].body);
    EXPECT_EQ(listed[i].time, expected[i].time);
    EXPECT_EQ(listed[i].impulse, expected[i].impulse);
    EXPECT_EQ(listed[i].velocity_after, expected[i].velocity_after);
    EXPECT_TRUE(listed[i].impact);
    EXPECT_EQ(listed[i].directions, 2);
  }
}

TEST(ImpactList, IsThatOfTheStepWhenSomebodyLooks) {
  Simulation simulation(bouncing_ball(), EventDriven{});
  simulation.run_until(end);
  const std::vector<EventRecord> first = impacts(simulation);
  ASSERT_GT(first.size(), 2U);
  expect_listed(simulation.report().contacts, first);
  expect_listed(simulation.report().contacts, first);  // once
  const std::size_t seen = simulation.events().size();
  simulation.run_until(1.5 * end);
  expect_listed(simulation.report().contacts, impacts(simulation, seen));
}

TEST(ImpactList, GoesOnForWhomeverHasTheReport) {
  Simulation simulation(bouncing_ball(), EventDriven{});
  const StepReport& report = simulation.report();
  EXPECT_TRUE(report.contacts.empty());
  simulation.run_until(end);
  expect_listed(report.contacts, impacts(simulation));
}

TEST(ImpactList, DoesNotDependOnWhetherEventsWereLookedAt) {
  const System system = bouncing_ball();
  Simulation simulation(system, EventDriven{}), other(system, EventDriven{});
  simulation.run_until(end);
  other.run_until(end);
  const std::vector<ContactRecord> listed = simulation.report().contacts;
  expect_listed(listed, impacts(other));
}

TEST(ImpactList, OutlivesTheEvents) {
  const System system = bouncing_ball();
  Simulation simulation(system, EventDriven{}), other(system, EventDriven{});
  simulation.run_until(end);
  other.run_until(end);
  simulation.clear_events();
  ASSERT_TRUE(simulation.events().empty());
  expect_listed(simulation.report().contacts, impacts(other));
}

TEST(ImpactList, OutlivesTheMode) {
  const System system = bouncing_ball();
  Simulation simulation(system, EventDriven{}), other(system, EventDriven{});
  simulation.run_until(end);
  other.run_until(end);
  simulation.switch_to(TimeStepping{.step = 1e-3});
  expect_listed(simulation.report().contacts, impacts(other));
}

TEST(ImpactList, IsOfTheEventsThatAreKept) {
  constexpr std::int64_t limit = 2;
  Simulation simulation(bouncing_ball(), EventDriven{.record_limit = limit});
  simulation.run_until(end);
  ASSERT_EQ(simulation.events().size(), std::size_t{limit});
  expect_listed(simulation.report().contacts, impacts(simulation));
}

}  // namespace
