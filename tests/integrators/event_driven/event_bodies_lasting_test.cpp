// Bodies that stay in contact with each other, event-driven: sliding, rolling, stacks, accumulations.

#include "tests/integrators/event_driven/body_scenes.h"
#include "tests/integrators/event_run.h"
#include "tests/reference/reference_data.h"

#include <carom/carom.h>
#include <carom/contact/detection/body_pairs.h>
#include <carom/contact/detection/detector.h>
#include <carom/core/assembly.h>
#include <carom/core/constraint_set.h>
#include <carom/integrators/event_driven/motion_memory.h>
#include <carom/integrators/event_driven/smooth_motion.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

namespace {

using namespace body_scenes;
using namespace carom_test;

const EventRecord* find_event(const Simulation& simulation, EventKind kind) {
  for (const EventRecord& event : simulation.events()) {
    if (event.kind == kind) return &event;
  }
  return nullptr;
}

TEST(EventBodies, ABlockSlidesOnABlockUntilBothMoveAsOne) {
  // Upper m, lower M on a floor without friction: a = -mu g, A = mu g m/M; as one at t = v/(mu g (1 + m/M)).
  constexpr double m = 1.0, M = 2.0, mu = 0.3, v = 2.0;
  System system;
  system.set_default_law({.friction = mu, .normal_restitution = 0.0});
  system.add(Gravity{{0.0, -g}});
  system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = 0.0, .normal_restitution = 0.0}, "floor");
  const BodyId lower = add_box(system, M, 4.0, 0.2, {0.0, 0.1});
  const BodyId upper = add_box(system, m, 0.2, 0.1, {-0.5, 0.25}, 0.0, {v, 0.0});
  Simulation simulation(system, tight());
  const LedgerWatch ledger(simulation);
  const double stop = v / (mu * g * (1.0 + m / M)), common = m * v / (m + M);
  simulation.run_until(0.5 * stop);
  EXPECT_NEAR(simulation.state().velocity(upper)[0], v - 0.5 * mu * g * stop, 1e-10);
  EXPECT_NEAR(simulation.state().velocity(lower)[0], 0.5 * mu * g * m / M * stop, 1e-10);
  simulation.run_until(1.0);
  const EventRecord* const stick = find_event(simulation, EventKind::stick);
  ASSERT_NE(stick, nullptr);
  EXPECT_NEAR(stick->time, stop, 1e-10);
  EXPECT_NEAR(simulation.state().velocity(upper)[0], common, 1e-10);
  EXPECT_NEAR(simulation.state().velocity(lower)[0], common, 1e-10);
  const double apart = simulation.state().position(upper)[0] - simulation.state().position(lower)[0];
  EXPECT_NEAR(apart, -0.5 + 0.5 * v * stop, 1e-9);
  EXPECT_NEAR(simulation.energy().flow(EnergyFlow::sliding), 0.5 * m * M / (m + M) * v * v, 1e-9);
  EXPECT_TRUE(ledger.closes());
}

/// A disc on a disc that is welded to the ground, from rest at an angle from the top: cosine of the angle at
/// which the normal force vanishes.
double cosine_of_lift_off(double friction, double angle) {
  constexpr double base = 0.5, radius = 0.2, from_centre = base + radius;
  System system;
  system.set_default_law({.friction = friction, .normal_restitution = 0.0});
  system.add(Gravity{{0.0, -g}});
  const BodyId fixed = add_disc(system, 1.0, base, {0.0, 0.0});
  system.add(Weld{.from = {ground, {0.0, 0.0}}, .to = {fixed, {0.0, 0.0}}});
  const BodyId disc = add_disc(system, 1.0, radius, from_centre * Vec<2>(std::sin(angle), std::cos(angle)));
  Simulation simulation(system, tight());
  const LedgerWatch ledger(simulation);
  double cosine = 0.0;
  while (find_event(simulation, EventKind::lift_off) == nullptr && simulation.time() < 3.0) {
    simulation.step();
  }
  EXPECT_TRUE(ledger.closes());
  const EventRecord* const lift_off = find_event(simulation, EventKind::lift_off);
  if (lift_off == nullptr) return 2.0;
  Simulation again(system, tight());
  again.run_until(lift_off->time);
  const Vec<2> at = again.state().position(disc);
  EXPECT_NEAR(at.norm(), from_centre, 1e-10);
  cosine = at[1] / from_centre;
  return cosine;
}

TEST(EventBodies, ADiscSlidesOffADisc) {
  // m v^2/(R + r) = m g cos, v^2/2 = g (R + r)(cos_0 - cos): cos = 2/3 cos_0.
  for (const double angle : {0.05, 0.3, 0.6}) {
    EXPECT_NEAR(cosine_of_lift_off(0.0, angle), 2.0 / 3.0 * std::cos(angle), 1e-9) << angle;
  }
}

TEST(EventBodies, ADiscRollsOnADiscUntilItSlips) {
  // Rolling from rest, 3/4 v^2 = g (R + r)(cos_0 - cos): normal force m g (7 cos - 4 cos_0)/3, friction m g
  // sin/3. It slips where sin = mu (7 cos - 4 cos_0), and lifts off after that.
  constexpr double base = 0.5, radius = 0.2, from_centre = base + radius;
  for (const double mu : {0.5, 2.0, 10.0}) {
    for (const double angle : {0.05, 0.3, 0.6}) {
      System system;
      system.set_default_law({.friction = mu, .normal_restitution = 0.0});
      system.add(Gravity{{0.0, -g}});
      const BodyId fixed = add_disc(system, 1.0, base, {0.0, 0.0});
      system.add(Weld{.from = {ground, {0.0, 0.0}}, .to = {fixed, {0.0, 0.0}}});
      const BodyId disc =
          add_disc(system, 1.0, radius, from_centre * Vec<2>(std::sin(angle), std::cos(angle)));
      Simulation simulation(system, tight());
      simulation.run_until(2.5);
      const EventRecord* const slip = find_event(simulation, EventKind::slip);
      const EventRecord* const lift_off = find_event(simulation, EventKind::lift_off);
      ASSERT_NE(slip, nullptr) << mu << ", " << angle;
      ASSERT_NE(lift_off, nullptr) << mu << ", " << angle;
      EXPECT_LT(slip->time, lift_off->time);
      Simulation again(system, tight());
      again.run_until(slip->time);
      const Vec<2> at = again.state().position(disc) / from_centre;
      EXPECT_NEAR(at[0], mu * (7.0 * at[1] - 4.0 * std::cos(angle)), 1e-9 * (1.0 + mu))
          << mu << ", " << angle;
      EXPECT_NEAR(again.state().velocity(disc).squaredNorm(),
                  4.0 / 3.0 * g * from_centre * (std::cos(angle) - at[1]), 1e-9);
    }
  }
}

TEST(EventBodies, ADiscComesToRestOnABlockOnTheFloor) {
  System system;
  system.set_default_law({.friction = 0.4, .normal_restitution = 0.6, .tangential_restitution = 0.6});
  system.add(Gravity{{0.0, -g}});
  system.add(HalfPlane{.normal = {0.0, 1.0}});
  const BodyId block = add_box(system, 3.0, 1.0, 0.4, {0.0, 0.2});
  const BodyId disc = add_disc(system, 1.0, 0.1, {0.0, 0.8});
  Simulation simulation(system, EventDriven{});
  simulation.run_until(4.0);
  EXPECT_GT(simulation.statistics().events[static_cast<std::size_t>(EventKind::accumulation)], 0);
  EXPECT_NEAR(simulation.state().position(disc)[1], 0.5, 1e-9);
  EXPECT_NEAR(simulation.state().position(block)[1], 0.2, 1e-9);
  EXPECT_LT(simulation.state().velocity(disc).norm(), 1e-9);
  EXPECT_LT(simulation.state().velocity(block).norm(), 1e-9);
  EXPECT_LT(std::abs(simulation.energy().residual()), 1e-9);
}

/// Normal forces of all contacts of a state at rest, in the modes found, by the height of the contact's body.
std::vector<double> forces_at_rest(const System& system) {
  const Assembly assembly(system);
  const Detector detector(assembly);
  const EventDriven options;
  MotionMemory memory(assembly);
  const BodyPairs pairs(detector.outlines());
  std::vector<Index> bodies(assembly.layout()->bodies().size());
  std::iota(bodies.begin(), bodies.end(), Index{0});
  GroupComponents all;
  pairs.append(bodies, all.body_pairs);
  for (Index i = 0; i < assembly.components().size(); ++i) all.components.push_back(i);
  SmoothMotion motion(assembly, detector, all, options, memory);
  std::vector<double> y(motion.size());
  motion.model().unknowns.gather(assembly.initial_state(), y);
  MotionSample at(assembly);
  motion.sample(0.0, y.data(), Forces::without_contact, at);
  SingleConstraint contact;
  for (Index i = 0; i < motion.model().pairs.size(); ++i) {
    motion.contact(i, at, contact);
    if (contact.gap > 1e-12) continue;
    ActiveContact& closed = motion.active().list().emplace_back();
    closed.pair = motion.model().pairs[i];
    closed.place = i;
    closed.at = contact;
  }
  motion.sample(0.0, y.data(), Forces::all, at);
  EXPECT_TRUE(at.has_forces);
  std::vector<double> forces;
  for (const ActiveContact& closed : motion.active().list()) forces.push_back(closed.normal);
  std::sort(forces.rbegin(), forces.rend());
  return forces;
}

System stack(int count, bool blocks, double narrower = 0.0) {
  System system;
  system.set_default_law({.friction = 0.5, .normal_restitution = 0.5, .tangential_restitution = 0.5});
  system.add(Gravity{{0.0, -g}});
  system.add(HalfPlane{.normal = {0.0, 1.0}});
  for (int i = 0; i < count; ++i) {
    // Each block is a little narrower than that below: corners stand on edges, not on corners.
    if (blocks) add_box(system, 1.0, 0.5 - narrower * i, 0.25, {0.0, 0.125 + 0.25 * i});
    if (!blocks) add_disc(system, 1.0, 0.125, {0.0, 0.125 + 0.25 * i});
  }
  return system;
}

TEST(EventBodies, TenDiscsStackedAreAtRest) {
  const Json expected =
      reference_data("contacts_planar.json").at("static_stack").at("disc_contact_forces_bottom_up");
  const System system = stack(10, false);
  const std::vector<double> forces = forces_at_rest(system);
  ASSERT_EQ(forces.size(), expected.size());
  for (std::size_t i = 0; i < forces.size(); ++i) EXPECT_NEAR(forces[i], expected.at(i).get<double>(), 1e-10);
  Simulation simulation(system, EventDriven{});
  simulation.run_until(1.0);
  EXPECT_EQ(simulation.state().q, Simulation(system, EventDriven{}).state().q);
}

TEST(EventBodies, TenBlocksStackedAreAtRest) {
  const Json expected =
      reference_data("contacts_planar.json").at("static_stack").at("block_corner_forces_bottom_up");
  const System system = stack(10, true, 0.03125);
  // Twenty corners, two for each block.
  std::vector<double> forces = forces_at_rest(system);
  ASSERT_EQ(forces.size(), 2 * expected.size());
  for (std::size_t i = 0; i < forces.size(); ++i) {
    EXPECT_NEAR(forces[i], expected.at(i / 2).get<double>(), 1e-9);
  }
  Simulation simulation(system, EventDriven{});
  simulation.run_until(1.0);
  const Simulation start(system, EventDriven{});
  for (std::size_t i = 0; i < start.state().q.size(); ++i) {
    EXPECT_NEAR(simulation.state().q[i], start.state().q[i], 1e-12);
  }
}

TEST(EventBodies, EqualBlocksStackedAreAtRest) {
  // Corners stand on corners: which features are nearest is a matter of rounding.
  const System system = stack(10, true);
  Simulation simulation(system, EventDriven{});
  simulation.run_until(1.0);
  const Simulation start(system, EventDriven{});
  for (std::size_t i = 0; i < start.state().q.size(); ++i) {
    EXPECT_NEAR(simulation.state().q[i], start.state().q[i], 1e-12);
  }
}

TEST(EventBodies, ADiscRollsOverTheCornerOfATable) {
  // Without friction, at speed v over the corner of a table: it leaves the corner at once if v^2 > g r;
  // slower, where cos = 2/3 + v^2/(3 g r) (the corner is a disc of radius 0).
  constexpr double radius = 0.1;
  for (const double speed : {0.3, 0.6, 1.2}) {
    System system;
    system.set_default_law({.friction = 0.0, .normal_restitution = 0.0});
    system.add(Gravity{{0.0, -g}});
    const BodyId table = add_box(system, 5.0, 1.0, 0.4, {0.0, 0.2});
    system.add(Weld{.from = {ground, {0.0, 0.0}}, .to = {table, {0.0, -0.2}}});
    const BodyId disc = add_disc(system, 1.0, radius, {0.3, 0.4 + radius}, {speed, 0.0});
    const auto leave = [&] {
      Simulation simulation(system, tight());
      while (find_event(simulation, EventKind::lift_off) == nullptr && simulation.time() < 2.0)
        simulation.step();
      const EventRecord* const event = find_event(simulation, EventKind::lift_off);
      return event == nullptr ? 2.0 : event->time;
    };
    const double time = leave();
    Simulation simulation(system, tight());
    simulation.run_until(time);
    const Vec<2> at = simulation.state().position(disc) - Vec<2>(0.5, 0.4);
    const double cosine = std::min(1.0, 2.0 / 3.0 + speed * speed / (3.0 * g * radius));
    EXPECT_NEAR(at.norm(), radius, 1e-9) << speed;
    EXPECT_NEAR(at[1] / radius, cosine, 1e-8) << speed;
    if (cosine == 1.0) {
      EXPECT_NEAR(time, 0.2 / speed, 1e-9);
    }
  }
}

TEST(EventBodies, ABlockSlidesOffTheEdgeOfATable) {
  // Half a width w/2 before the edge the leading corner leaves the table, whose corner takes over; at mu h/2
  // before it the normal force there balances friction alone, and the trailing corner lifts off.
  constexpr double v = 1.5, mu = 0.1, w = 0.2, h = 0.1, way = 0.2;
  System system;
  system.set_default_law({.friction = mu, .normal_restitution = 0.0});
  system.add(Gravity{{0.0, -g}});
  const BodyId table = add_box(system, 5.0, 1.0, 0.4, {0.0, 0.2});
  system.add(Weld{.from = {ground, {0.0, 0.0}}, .to = {table, {0.0, -0.2}}});
  add_box(system, 1.0, w, h, {0.5 - way, 0.4 + 0.5 * h}, 0.0, {v, 0.0});
  Simulation simulation(system, tight());
  const LedgerWatch ledger(simulation);
  simulation.run_until(0.4);
  const auto time_at = [](double x) { return (v - std::sqrt(v * v - 2.0 * mu * g * x)) / (mu * g); };
  std::vector<double> times;
  for (const EventRecord& event : simulation.events()) {
    EXPECT_NE(event.kind, EventKind::impact);
    if (event.kind == EventKind::lift_off) times.push_back(event.time);
  }
  ASSERT_GE(times.size(), 2U);
  // A corner leaves 2e-9 m beyond the edge.
  EXPECT_NEAR(times[0], time_at(way - 0.5 * w), 2e-9);
  EXPECT_NEAR(times[1], time_at(way - 0.5 * mu * h), 1e-8);
  EXPECT_TRUE(ledger.closes());
}

TEST(EventBodies, ADoublePendulumHitsADisc) {
  // Without gravity the angular momentum about the pivot is that of the whole, through all impacts.
  System system;
  system.set_default_law({.friction = 0.3, .normal_restitution = 0.7, .tangential_restitution = 0.7});
  std::vector<BodyId> rods;
  for (int i = 0; i < 2; ++i) {
    const double x = 0.5 + i;
    // Both turn as one about the pivot.
    rods.push_back(system.add(
        RigidBody{.mass = rod(1.0, 1.0), .position = {x, 0.0}, .velocity = {0.0, 2.0 * x}, .spin = 2.0}));
    system.add(Segment{.body = rods.back(), .from = {-0.45, 0.0}, .to = {0.45, 0.0}});
  }
  system.add(Revolute{.from = {ground, {0.0, 0.0}}, .to = {rods[0], {-0.5, 0.0}}});
  system.add(Revolute{.from = {rods[0], {0.5, 0.0}}, .to = {rods[1], {-0.5, 0.0}}});
  add_disc(system, 0.5, 0.2, {1.4, 0.8});
  const std::vector<double> masses{1.0, 1.0, 0.5}, inertias{1.0 / 12.0, 1.0 / 12.0, 0.5 * 0.5 * 0.04};
  Simulation simulation(system, tight());
  const LedgerWatch ledger(simulation);
  const double before = momentum(simulation, masses, inertias)[2];
  simulation.run_until(1.5);
  EXPECT_GT(simulation.statistics().impacts, 0);
  EXPECT_NEAR(momentum(simulation, masses, inertias)[2], before, 1e-9);
  EXPECT_TRUE(ledger.closes());
  for (const EventRecord& event : simulation.events()) {
    if (event.kind != EventKind::impact || event.impulse[0] == 0.0) continue;
    EXPECT_NEAR(event.velocity_after[0], -0.7 * event.velocity_before[0], 1e-11);
  }
}

}  // namespace
