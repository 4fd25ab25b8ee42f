// A run that nobody looks at goes straight to its end: same motion, same events, same times of steps after.

#include <carom/carom.h>

#include "tests/integrators/same_run.h"
#include "tests/integrators/throws.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <stdexcept>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;

System bouncing_balls(int count) {
  System system;
  system.add(Gravity{{0.0, -9.81}});
  system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = 0.3, .normal_restitution = 0.8});
  for (int i = 0; i < count; ++i) {
    const BodyId ball = system.add(
        RigidBody{.mass = disc(1.0, 0.1), .position = {1.0 * i, 0.6 + 0.07 * i}, .velocity = {0.5, 0.0}});
    system.add(Disc{.body = ball, .radius = 0.1});
  }
  return system;
}

std::vector<std::uint64_t> event_bits(const std::vector<EventRecord>& events) {
  std::vector<std::uint64_t> bits;
  for (const EventRecord& event : events) {
    bits.push_back(static_cast<std::uint64_t>(event.kind));
    bits.push_back(event.contact.a.serial);
    for (const double number : {event.time, event.impulse[0], event.impulse[1], event.velocity_after[1]}) {
      carom_test::append_bits(bits, number);
    }
  }
  return bits;
}

TEST(UnseenRun, IsOneStepOfTheSameMotion) {
  Simulation unseen(bouncing_balls(3), EventDriven{}), seen(bouncing_balls(3), EventDriven{});
  seen.observe([](const Simulation&) {});
  unseen.run_until(2.0);
  seen.run_until(2.0);
  EXPECT_EQ(unseen.statistics().steps, 1);
  EXPECT_EQ(seen.statistics().steps, 200);
  EXPECT_EQ(carom_test::motion_bits(unseen.state()), carom_test::motion_bits(seen.state()));
  EXPECT_EQ(event_bits(unseen.events()), event_bits(seen.events()));
  EXPECT_EQ(unseen.statistics().impacts, seen.statistics().impacts);
  EXPECT_GT(unseen.statistics().impacts, 10);
  EXPECT_EQ(unseen.statistics().flow_evaluations, seen.statistics().flow_evaluations);  // a flight is known
  // Works of 200 steps or of one are added in another order.
  EXPECT_NEAR(unseen.energy().lost(), seen.energy().lost(), 1e-13 * seen.energy().scale());
}

TEST(UnseenRun, WhoeverLooksGetsEveryTime) {
  const auto steps_with = [](const auto& prepare) {
    Simulation simulation(bouncing_balls(1), EventDriven{.interval = 0.1});
    prepare(simulation);
    simulation.run_until(1.0);
    return simulation.statistics().steps;
  };
  EXPECT_EQ(steps_with([](Simulation&) {}), 1);
  EXPECT_EQ(steps_with([](Simulation& now) { now.observe([](const Simulation&) {}); }), 10);
  EXPECT_EQ(steps_with([](Simulation& now) { now.stop_when([] { return false; }); }), 10);
  EXPECT_EQ(steps_with([](Simulation& now) { now.show_progress(true); }), 10);
  EXPECT_EQ(steps_with([](Simulation& now) { now.log() = Log([](LogLevel, std::string_view) {}); }), 10);
  EXPECT_EQ(steps_with([](Simulation& now) {
              const CallbackId observer = now.observe([](const Simulation&) {});
              now.remove_callback(observer);
            }),
            1);
  EXPECT_EQ(steps_with([](Simulation& now) { now.every(0.25, [](Simulation&) {}); }), 4);
}

TEST(UnseenRun, StepsGoOnAlongTheGrid) {
  Simulation simulation(bouncing_balls(1), EventDriven{.interval = 0.01});
  simulation.run_until(0.5);
  simulation.step();
  EXPECT_EQ(simulation.time(), 0.51);
  simulation.run_until(0.777);  // beside the grid, which begins anew
  simulation.step();
  EXPECT_NEAR(simulation.time(), 0.787, 1e-15);
}

// As where somebody looks: at the last interval before the failure.
TEST(UnseenRun, StandsWhereItIsStillGoodAfterAFailure) {
  for (const bool seen : {false, true}) {
    System system;
    const BodyId body = system.add(Particle{.mass = 1.0});
    system.add(AppliedForce{.on = body, .force = [](double t) {
                              if (t > 1.5) throw std::runtime_error("no more");
                              return Vec<2>(1.0, 0.0);
                            }});
    Simulation simulation(system, EventDriven{.interval = 0.01, .longest_step = 0.02});
    if (seen) simulation.observe([](const Simulation&) {});
    EXPECT_THROW(simulation.run_until(10.0), std::runtime_error);
    // A step of the integrator, which looks ahead, and an interval.
    EXPECT_GT(simulation.time(), 1.45) << seen;
    EXPECT_LE(simulation.time(), 1.5) << seen;
    const double t = simulation.time();
    EXPECT_NEAR(simulation.state().position(body)[0], 0.5 * t * t, 1e-9) << seen;
    EXPECT_NEAR(simulation.energy().residual(), 0.0, 1e-9) << seen;
  }
}

TEST(UnseenRun, KeepsTheLatestRecords) {
  for (const bool seen : {false, true}) {
    Simulation all(bouncing_balls(5), EventDriven{});
    Simulation some(bouncing_balls(5), EventDriven{.record_limit = 7});
    Simulation none(bouncing_balls(5), EventDriven{.record_events = false});
    for (Simulation* run : {&all, &some, &none}) {
      if (seen) run->observe([](const Simulation&) {});
      run->run_until(4.0);
    }
    ASSERT_GT(all.events().size(), 50U);
    ASSERT_EQ(some.events().size(), 7U);
    const std::vector<EventRecord> latest(all.events().end() - 7, all.events().end());
    EXPECT_EQ(event_bits(some.events()), event_bits(latest)) << seen;
    EXPECT_TRUE(none.events().empty());
    EXPECT_TRUE(none.report().contacts.empty());
    for (const Simulation* run : {&some, &none}) {
      EXPECT_EQ(run->statistics().impacts, all.statistics().impacts);
      EXPECT_EQ(run->statistics().events, all.statistics().events);
      EXPECT_EQ(run->statistics().worst_residual, all.statistics().worst_residual);
      EXPECT_EQ(carom_test::motion_bits(run->state()), carom_test::motion_bits(all.state()));
    }
  }
  EXPECT_THROWS(ModelError, Simulation(bouncing_balls(1), EventDriven{.record_limit = -1}),
                "record_limit is -1", "allowed: at least 0");
}

}  // namespace
