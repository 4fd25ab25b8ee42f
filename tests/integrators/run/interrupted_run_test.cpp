// Whoever may interrupt a run of the event-driven mode does not change it, and keeps what it has reached.

#include <carom/carom.h>

#include "tests/integrators/same_run.h"
#include "tests/integrators/throws.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <random>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;

/// Slow enough for a run to look around, many times.
constexpr auto moment = std::chrono::milliseconds(60);

/// Balls that touch nothing but the ground: groups that go each to the end.
System apart(std::mt19937& random) {
  std::uniform_real_distribution<double> speed(-0.5, 0.5), height(0.3, 1.0);
  System system;
  system.add(Gravity{{0.0, -9.81}});
  system.set_default_law({.friction = 0.3, .normal_restitution = 0.7});
  system.add(HalfPlane{.normal = {0.0, 1.0}});
  for (int i = 0; i < 4; ++i) {
    const BodyId ball = system.add(RigidBody{
        .mass = disc(1.0, 0.1), .position = {3.0 * i, height(random)}, .velocity = {speed(random), 0.0}});
    system.add(Disc{.body = ball, .radius = 0.1, .filter = {.groups = 2, .touches = 1}});
  }
  return system;
}

/// Discs in a box, which meet.
System together(std::mt19937& random) {
  std::uniform_real_distribution<double> speed(-2.0, 2.0);
  System system;
  system.add(Gravity{{0.0, -9.81}});
  system.set_default_law({.friction = 0.3, .normal_restitution = 0.6});
  system.add(BoxInside{.lower = {0.0, 0.0}, .upper = {2.0, 2.0}});
  for (int i = 0; i < 6; ++i) {
    const BodyId ball = system.add(RigidBody{.mass = disc(1.0, 0.1),
                                             .position = {0.3 + 0.6 * (i % 3), 0.3 + 0.6 * (i / 3)},
                                             .velocity = {speed(random), speed(random)}});
    system.add(Disc{.body = ball, .radius = 0.1});
  }
  return system;
}

/// A double pendulum with dry friction and a wall.
System mechanism(std::mt19937& random) {
  std::uniform_real_distribution<double> spin(-2.0, 2.0);
  System system;
  system.add(Gravity{{0.0, -9.81}});
  system.set_default_law({.friction = 0.2, .normal_restitution = 0.5});
  system.add(HalfPlane{.point = {-0.2, 0.0}, .normal = {1.0, 0.0}});
  const double w = spin(random);
  const BodyId upper = system.add(
      RigidBody{.mass = rod(1.0, 1.0), .position = {0.5, 0.0}, .velocity = {0.0, 0.5 * w}, .spin = w});
  const BodyId lower = system.add(
      RigidBody{.mass = rod(1.0, 1.0), .position = {1.5, 0.0}, .velocity = {0.0, 1.5 * w}, .spin = w});
  system.add(Revolute{.from = {ground, {0.0, 0.0}}, .to = {upper, {-0.5, 0.0}}});
  system.add(Revolute{.from = {upper, {0.5, 0.0}}, .to = {lower, {-0.5, 0.0}}});
  system.add(Point{.body = lower, .position = {0.5, 0.0}});
  return system;
}

struct Scene {
  const char* name;
  System (*make)(std::mt19937&);
  EventDriven mode;
  double end;
};

std::vector<Scene> scenes() {
  return {{"apart", apart, EventDriven{}, 2.0},
          {"together", together, EventDriven{}, 1.0},
          {"together, few records", together, EventDriven{.record_limit = 5}, 1.0},
          {"mechanism", mechanism, EventDriven{}, 2.0},
          {"mechanism, bdf", mechanism, EventDriven{.method = FlowMethod::bdf}, 1.0},
          {"mechanism, one step", mechanism, EventDriven{.method = FlowMethod::one_step}, 1.0}};
}

std::vector<std::uint64_t> all_bits(const Simulation& run) {
  std::vector<std::uint64_t> bits = carom_test::motion_bits(run.state());
  for (std::size_t i = 0; i < stored_energy_count; ++i)
    carom_test::append_bits(bits, run.energy().stored(static_cast<StoredEnergy>(i)));
  for (std::size_t i = 0; i < energy_flow_count; ++i)
    carom_test::append_bits(bits, run.energy().flow(static_cast<EnergyFlow>(i)));
  for (const EventRecord& event : run.events()) {
    bits.push_back(static_cast<std::uint64_t>(event.kind));
    bits.push_back(static_cast<std::uint64_t>(event.instant));
    for (const double number : {event.time, event.impulse[0], event.impulse[1], event.velocity_after[1]})
      carom_test::append_bits(bits, number);
  }
  for (const JointImpulse& joint : run.report().joint_impulses) carom_test::append_bits(bits, joint.time);
  for (const std::int64_t count :
       {run.statistics().steps, run.statistics().impacts, run.statistics().flow_steps,
        run.contact_statistics().problems, static_cast<std::int64_t>(run.report().contacts.size())})
    bits.push_back(static_cast<std::uint64_t>(count));
  return bits;
}

/// Never ends a run, and takes its time now and then.
StopFunction slow_at(std::int64_t every, std::int64_t times) {
  return [=, asked = std::int64_t{0}]() mutable {
    if (++asked % every == 0 && asked <= times * every) std::this_thread::sleep_for(moment);
    return false;
  };
}

TEST(InterruptedRun, WhoeverWaitsChangesNoBit) {
  std::mt19937 random(41);
  for (const Scene& scene : scenes()) {
    const System system = scene.make(random);
    Simulation plain(system, scene.mode), waited(system, scene.mode);
    std::vector<double> reached;
    waited.interrupt_when(slow_at(20, 16), [&](double time) { reached.push_back(time); });
    for (const double end : {0.4 * scene.end, scene.end}) {
      plain.run_until(end);
      waited.run_until(end);
      EXPECT_EQ(all_bits(waited), all_bits(plain)) << scene.name << " at " << end;
    }
    EXPECT_EQ(waited.statistics().steps, 2) << scene.name;
    EXPECT_GE(reached.size(), 2U) << scene.name;
    for (std::size_t i = 1; i < reached.size(); ++i) EXPECT_GT(reached[i], reached[i - 1]) << scene.name;
  }
}

TEST(InterruptedRun, KeepsWhatItHasReached) {
  // Works are integrated along with the motion, most loosely by bdf: 1e-9 of energies of 10 J a step [J].
  constexpr double integrated = 1e-7;
  std::mt19937 random(43);
  for (const Scene& scene : scenes()) {
    const System system = scene.make(random);
    Simulation plain(system, scene.mode), stopped(system, scene.mode);
    plain.run_until(scene.end);
    double reached = 0.0;
    StopFunction slow = slow_at(25, 8);
    std::int64_t asked = 0;
    stopped.interrupt_when([&] { return slow(), ++asked > 250; }, [&](double time) { reached = time; });
    EXPECT_THROWS(Cancelled, stopped.run_until(scene.end), "interrupt_when");
    ASSERT_GT(reached, 0.0) << scene.name;
    EXPECT_EQ(stopped.time(), reached) << scene.name;
    EXPECT_LT(stopped.time(), scene.end) << scene.name;
    EXPECT_NEAR(stopped.energy().residual(), 0.0, integrated) << scene.name;
    if (scene.mode.record_limit == 0) {
      std::size_t before = 0;
      while (before < plain.events().size() && plain.events()[before].time <= reached) ++before;
      ASSERT_EQ(stopped.events().size(), before) << scene.name;
      for (std::size_t i = 0; i < before; ++i) {
        EXPECT_EQ(stopped.events()[i].time, plain.events()[i].time) << scene.name;
        EXPECT_EQ(stopped.events()[i].instant, plain.events()[i].instant) << scene.name;
      }
    }
    // The state is one of the same run: asked for then, without anybody who waits.
    Simulation then(system, scene.mode);
    then.run_until(reached);
    EXPECT_EQ(carom_test::motion_bits(stopped.state()), carom_test::motion_bits(then.state())) << scene.name;
    EXPECT_EQ(stopped.statistics().impacts, then.statistics().impacts) << scene.name;
    EXPECT_EQ(stopped.contact_statistics().problems, then.contact_statistics().problems) << scene.name;
    stopped.interrupt_when({});
    stopped.run_until(scene.end);
    EXPECT_EQ(stopped.time(), scene.end) << scene.name;
    EXPECT_NEAR(stopped.energy().residual(), 0.0, integrated) << scene.name;
  }
}

TEST(InterruptedRun, WhatTheFunctionsThrowComesOut) {
  std::mt19937 random(47);
  for (const Mode& mode : {Mode(TimeStepping{}), Mode(EventDriven{})}) {
    Simulation simulation(together(random), mode);
    simulation.interrupt_when([]() -> bool { throw std::runtime_error("enough"); });
    EXPECT_THROWS(std::runtime_error, simulation.run_until(0.1), "enough");
    EXPECT_EQ(simulation.time(), 0.0);
    simulation.interrupt_when([] { return true; });
    EXPECT_THROWS(Cancelled, simulation.step(), "interrupt_when");
    simulation.interrupt_when({});
    simulation.run_until(0.1);
    simulation.interrupt_when([&] { return simulation.interrupt_when({}), false; });
    EXPECT_THROWS(ModelError, simulation.run_until(0.2), "interrupt_when was called by", "stop function");
  }
}

TEST(InterruptedRun, WhatHearsOfTheTimeMayEndIt) {
  std::mt19937 random(53);
  Simulation simulation(together(random), EventDriven{});
  simulation.interrupt_when(slow_at(50, 30), [](double time) {
    if (time > 0.01) throw std::runtime_error("far enough");
  });
  EXPECT_THROWS(std::runtime_error, simulation.run_until(1.0), "far enough");
  EXPECT_GT(simulation.time(), 0.01);
  EXPECT_LT(simulation.time(), 1.0);
}

}  // namespace
