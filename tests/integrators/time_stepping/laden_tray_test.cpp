// Very many contacts on one body: a tray that joints hold, a slab on pegs, a bar on cranks.

#include "tests/energy/ledger_check.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;

constexpr double gravity = 9.81, pitch = 0.11, radius = 0.05;  // [m/s^2], [m]
constexpr int count = 60;                                      // more than exact solvers are asked for

System with_law() {
  System system;
  system.add(Gravity{{0.0, -gravity}});
  system.set_default_law({.friction = 0.5, .normal_restitution = 0.0, .tangential_restitution = 0.0});
  return system;
}

double place(int i) { return pitch * (i - 0.5 * (count - 1)); }

/// A slab of a length for all, with its upper side at y = 0.
BodyId add_slab(System& system, double mass) {
  const double width = pitch * count, half = 0.05;
  const BodyId slab = system.add(RigidBody{.mass = box(mass, width, 2.0 * half), .position = {0.0, -half}});
  system.add(Polygon{
      .body = slab,
      .vertices = {{-0.5 * width, -half}, {0.5 * width, -half}, {0.5 * width, half}, {-0.5 * width, half}}});
  return slab;
}

/// Discs of 1 kg and more in a row on it.
void add_discs(System& system) {
  for (int i = 0; i < count; ++i) {
    const BodyId body =
        system.add(RigidBody{.mass = disc(1.0 + 0.02 * i, radius), .position = {place(i), radius}});
    system.add(Disc{.body = body, .radius = radius});
  }
}

void expect_swept(const Simulation& run, std::size_t contacts) {
  ASSERT_EQ(run.report().contacts.size(), contacts);
  for (const ContactRecord& contact : run.report().contacts) {
    EXPECT_EQ(contact.solver, "nonlinear CG");
    EXPECT_LE(contact.residual, 1e-10);
  }
}

TEST(LadenTray, OnAGuideCarriesEachDisc) {
  System system = with_law();
  const BodyId tray = add_slab(system, 10.0);
  const JointId guide = system.add(Prismatic{.from = ground, .to = tray, .axis = {1.0, 0.0}});
  // Slower than friction can follow: discs ride along.
  const double swing = 0.01, pace = 5.0;
  system.add(
      Driver{.joint = guide, .position = [=](double t) { return swing * (1.0 - std::cos(pace * t)); }});
  add_discs(system);
  Simulation run(system, TimeStepping{.step = 1e-3});
  double load = 10.0 * gravity;
  for (int i = 0; i < count; ++i) load += (1.0 + 0.02 * i) * gravity;
  for (int step = 0; step < 50; ++step) {
    run.step();
    if (step < 2) continue;  // discs sink in by the first step
    expect_swept(run, static_cast<std::size_t>(count));
    // The guide does not give way, so each contact bears its own disc, to the residual of the sweeps.
    for (const ContactRecord& contact : run.report().contacts) {
      const double mass = 1.0 + 0.02 * (std::max(contact.body.serial, contact.other.serial) - 1.0);
      EXPECT_NEAR(contact.impulse[0], mass * gravity * 1e-3, 1e-8);
    }
    EXPECT_NEAR(run.reaction(guide).force[1], load, 1e-5);
  }
  EXPECT_TRUE(carom_test::ledger_closes(run.energy()));
}

/// Sum of the normal impulses of a step.
double normal_impulse(const Simulation& run) {
  double sum = 0.0;
  for (const ContactRecord& contact : run.report().contacts) sum += contact.impulse[0];
  return sum;
}

TEST(LadenTray, ASlabRestsOnVeryManyPegs) {
  System system = with_law();
  const BodyId slab = add_slab(system, 30.0);
  for (int i = 0; i < count; ++i) system.add(Peg{.centre = {place(i), -0.12}, .radius = 0.02});
  Simulation run(system, TimeStepping{.step = 1e-3});
  for (int step = 0; step < 50; ++step) {
    run.step();
    expect_swept(run, static_cast<std::size_t>(count));
    EXPECT_NEAR(normal_impulse(run), 30.0 * gravity * 1e-3, 1e-9);
  }
  // The residual is 1e-10 of the largest impulse: of the weight in a step, over the mass.
  EXPECT_LE(run.state().velocity(slab).norm(), 1e-11);
  EXPECT_NEAR(run.state().position(slab)[1], -0.05, 1e-12);
}

TEST(LadenTray, ABarRestsOnVeryManyCranks) {
  System system = with_law();
  const BodyId bar = add_slab(system, 30.0);
  std::vector<JointId> pins;
  for (int i = 0; i < count; ++i) {
    const Vec<2> centre(place(i), -0.12);
    const BodyId crank = system.add(RigidBody{.mass = disc(1.0, 0.02), .position = centre});
    system.add(Disc{.body = crank, .radius = 0.02});
    pins.push_back(system.add(Revolute{.from = {ground, centre}, .to = crank}));
  }
  Simulation run(system, TimeStepping{.step = 1e-3});
  run.step();
  expect_swept(run, static_cast<std::size_t>(count));
  // Later some are open by the rounding of places, and the others carry the bar.
  for (int step = 1; step < 50; ++step) run.step();
  EXPECT_LE(run.statistics().worst_residual, 1e-10);
  double load = 0.0;
  for (const JointId pin : pins) load += run.reaction(pin).force[1];
  EXPECT_NEAR(load, (30.0 + count) * gravity, 1e-5);
  EXPECT_NEAR(run.state().position(bar)[1], -0.05, 1e-10);
}

// Ropes on a floor: exact solvers took up to 8 s for a step of 50 links, whose forces are far from unique.
TEST(LadenTray, AChainLiesOnTheFloor) {
  System system = with_law();
  system.add(HalfPlane{.normal = {0.0, 1.0}});
  BodyId last{};
  constexpr int links = 30;
  for (int i = 0; i < links; ++i) {
    const BodyId link = system.add(RigidBody{.mass = rod(1.0, 1.0), .position = {i + 0.5, radius}});
    system.add(Segment{.body = link, .from = {-0.4, 0.0}, .to = {0.4, 0.0}, .radius = radius});
    if (i > 0) system.add(Revolute{.from = {last, {0.5, 0.0}}, .to = {link, {-0.5, 0.0}}});
    last = link;
  }
  Simulation run(system, TimeStepping{.step = 1e-3});
  for (int step = 0; step < 50; ++step) run.step();
  EXPECT_NEAR(normal_impulse(run), links * gravity * 1e-3, 1e-6);
  EXPECT_GE(run.statistics().deepest_gap, -2e-5);  // h^2 g of the first steps
  EXPECT_TRUE(carom_test::ledger_closes(run.energy()));
}

}  // namespace
