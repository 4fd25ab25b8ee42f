// Traps for the search of events with a ball: many bounces, dips, grazing, starts in contact, output times.

#include "tests/integrators/event_runs.h"
#include "tests/integrators/same_run.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::count;
using carom_test::default_and_tight;

constexpr double g = 9.81;

struct Ball {
  Vec<2> position{0.0, 1.0};
  Vec<2> velocity{0.0, 0.0};
  Surface surface{.friction = 0.0, .normal_restitution = 1.0};
  double gravity = g;
};

struct BallScene {
  System system;
  BodyId ball;
};

BallScene over_a_floor(const Ball& start) {
  BallScene scene;
  if (start.gravity > 0.0) scene.system.add(Gravity{{0.0, -start.gravity}});
  scene.system.add(HalfPlane{.normal = {0.0, 1.0}}, start.surface);
  scene.ball =
      scene.system.add(Particle{.mass = 1.0, .position = start.position, .velocity = start.velocity});
  return scene;
}

// An impact is late by the rounding of its time, 4e-12 m at 4,000 s. Each bounce began as much deeper than
// the one before, and after some thousand the run ended with a closing that was missed.
TEST(EventBall, ElasticBouncesDoNotSinkInTheLongRun) {
  constexpr double end = 1e4;
  for (const double height : {0.31, 0.7, 1.0}) {
    const BallScene scene = over_a_floor({.position = {0.0, height}});
    Simulation simulation(scene.system, EventDriven{.record_limit = 1});
    ASSERT_NO_THROW(simulation.run_until(end)) << height;
    // One every two falls, the first after one.
    const double fall = std::sqrt(2.0 * height / g);
    EXPECT_EQ(simulation.statistics().impacts, std::lround(end / (2.0 * fall))) << height;
    // Two times with an error of four roundings of the end, at 4.4 m/s.
    EXPECT_GT(simulation.events().back().gap, -1e-10) << height;
    EXPECT_NEAR(simulation.energy().total(), simulation.energy().initial(), 1e-12) << height;
  }
}

TEST(EventBall, NoneOfAThousandBouncesIsMissed) {
  // Root finding by signs at the ends of steps misses nearly all of these.
  for (const FlowMethod method : carom_test::flow_methods) {
    for (const double tolerance : {1e-4, 1e-6, 1e-9}) {
      SCOPED_TRACE(std::to_string(static_cast<int>(method)) + ", tolerance " + to_text(tolerance));
      const BallScene scene = over_a_floor({});
      EventDriven options{.relative_tolerance = tolerance, .method = method};
      options.absolute_tolerance = 1e-2 * tolerance;
      Simulation simulation(scene.system, options);
      double deepest = 0.0;
      simulation.observe(
          [&](const Simulation& now) { deepest = std::min(deepest, now.state().position(scene.ball)[1]); });
      const double fall = std::sqrt(2.0 / g);
      simulation.run_until(2000.0 * fall);  // at the top after the 1000th bounce
      EXPECT_GE(deepest, -1e-9);
      // Free flight is a polynomial: explicit Runge-Kutta is exact, multistep methods err by their tolerance
      // in each flight, of which the energy is a sum.
      const bool exact = method == FlowMethod::explicit_runge_kutta || method == FlowMethod::one_step;
      const double allowed = exact ? 1e-9 : std::min(0.5, 1e4 * tolerance);
      EXPECT_NEAR(simulation.energy().total() / g, 1.0, allowed);
      if (exact || tolerance == 1e-9) {
        EXPECT_EQ(count(simulation, EventKind::impact), 1000);
        EXPECT_EQ(count(simulation, EventKind::accumulation), 0);
      }
    }
  }
}

TEST(EventBall, ADipThatBeginsAndEndsWithinAStepIsSeen) {
  // Thrown so that it is behind a wall from 0.4855 s to 0.5145 s were the wall not there: both ends lie
  // within one step.
  for (const EventDriven& options : default_and_tight()) {
    const double half = 0.0145, depth = 0.5 * g * half * half;
    System system;
    system.add(Gravity{{0.0, -g}});
    system.add(HalfPlane{.point = {0.0, 2.0}, .normal = {0.0, -1.0}},
               Surface{.friction = 0.0, .normal_restitution = 1.0});
    const double speed = g * 0.5;
    system.add(
        Particle{.mass = 1.0, .position = {0.0, 2.0 + depth - speed * 0.25}, .velocity = {0.0, speed}});
    Simulation simulation(system, options);
    simulation.run_until(0.7);
    ASSERT_EQ(simulation.events().size(), 1u);
    const EventRecord& event = simulation.events().front();
    EXPECT_EQ(event.kind, EventKind::impact);
    // Rounding of the gap over the speed there, 0.14 m/s.
    EXPECT_NEAR(event.time, 0.5 - half, 1e-11);
    EXPECT_NEAR(event.velocity_before[0], -g * half, 1e-10);
  }
}

// A ball on a spring over a table: x runs on while y swings about the level of the table plus a bit less than
// the amplitude. Every dip is an impact, which the loss-free surface returns.
TEST(EventBall, EveryDipOfACurvedPathIsAnImpact) {
  for (const EventDriven& options : default_and_tight()) {
    for (const double dip : {1e-3, 1e-4, 1e-6}) {
      SCOPED_TRACE(dip);
      System system;
      system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = 0.0, .normal_restitution = 1.0});
      const double mean = 0.1, amplitude = mean + dip, rate = 10.0;
      // A soft law of time would do too; a spring of free length 0 to the ground swings in both directions.
      const BodyId ball = system.add(Particle{.mass = 1.0, .position = {0.0, mean + amplitude}});
      system.add(SpringDamper{.from = End<2>(ground, {0.0, mean}),
                              .to = End<2>(ball),
                              .stiffness = rate * rate,
                              .damping = 0.0,
                              .free_length = 0.0});
      Simulation simulation(system, options);
      // Swings down from the top, hits at the angle whose cosine is -mean/amplitude, is back at the top after
      // twice that.
      const double period = 2.0 * std::acos(-mean / amplitude) / rate;
      simulation.run_until(8.0 * period);
      EXPECT_EQ(count(simulation, EventKind::impact), 8);
      EXPECT_NEAR(simulation.state().position(ball)[1], mean + amplitude, 1e-6);
    }
  }
}

TEST(EventBall, ThrownWithDipsBelowATable) {
  // Bounces of 1 mm and 0.1 mm: eight dips in a row of a body that a loss-free floor throws back.
  for (const EventDriven& options : default_and_tight()) {
    for (const double height : {1e-3, 1e-4}) {
      const BallScene scene = over_a_floor({.position = {0.0, height}, .velocity = {3.0, 0.0}});
      Simulation simulation(scene.system, options);
      simulation.run_until(16.0 * std::sqrt(2.0 * height / g));
      EXPECT_EQ(count(simulation, EventKind::impact), 8) << height;
      EXPECT_NEAR(simulation.state().position(scene.ball)[1], height, 1e-9 * 16.0);
    }
  }
}

TEST(EventBall, StartInContactAndClosingIsAnImpactAtOnce) {
  for (const EventDriven& options : default_and_tight()) {
    const BallScene scene = over_a_floor({.position = {0.0, 0.0},
                                          .velocity = {0.0, -2.0},
                                          .surface = {.friction = 0.0, .normal_restitution = 0.9}});
    Simulation simulation(scene.system, options);
    simulation.step();
    ASSERT_EQ(simulation.events().size(), 1u);
    const EventRecord& event = simulation.events().front();
    EXPECT_EQ(event.time, 0.0);
    EXPECT_EQ(event.kind, EventKind::impact);
    EXPECT_DOUBLE_EQ(event.velocity_after[0], 1.8);
    EXPECT_DOUBLE_EQ(event.impulse[0], 3.8);
    EXPECT_NEAR(simulation.state().velocity(scene.ball)[1], 1.8 - g * 0.01, 1e-14);
  }
}

TEST(EventBall, StandsExactlyWhereItIsAskedTo) {
  for (const FlowMethod method : carom_test::flow_methods) {
    const BallScene scene = over_a_floor({});
    Simulation simulation(scene.system, EventDriven{.method = method});
    simulation.run_until(3.5);
    EXPECT_EQ(simulation.time(), 3.5);
    EXPECT_EQ(simulation.state().time, 3.5);
    // Also at the time of an impact itself, which then has happened.
    const double hit = simulation.events().back().time;
    Simulation again(scene.system, EventDriven{.method = method});
    again.run_until(hit);
    EXPECT_EQ(again.time(), hit);
    EXPECT_EQ(again.events().back().time, hit);
    EXPECT_GT(again.state().velocity(scene.ball)[1], 0.0);
  }
}

TEST(EventBall, Grazing) {
  // Thrown up so that its top is a little below, just at, or a little above a ceiling.
  for (const EventDriven& options : default_and_tight()) {
    for (const double overlap : {-1e-6, 0.0, 1e-6}) {
      SCOPED_TRACE(overlap);
      System system;
      system.add(Gravity{{0.0, -g}});
      system.add(HalfPlane{.point = {0.0, 1.0}, .normal = {0.0, -1.0}},
                 Surface{.friction = 0.3, .normal_restitution = 0.5});
      const double speed = std::sqrt(2.0 * g * (1.0 + overlap));
      const BodyId ball = system.add(Particle{.mass = 1.0, .velocity = {1.0, speed}});
      Simulation simulation(system, options);
      simulation.run_until(2.0 * speed / g);
      const std::int64_t hits = count(simulation, EventKind::impact);
      if (overlap > 0.0) {
        ASSERT_EQ(hits, 1);
        // v^2 = 2 g overlap; rounding of 1 m over the speed of 4.4 mm/s, times g.
        EXPECT_NEAR(simulation.events().front().velocity_before[0], -std::sqrt(2.0 * g * overlap), 1e-11);
      } else if (overlap < 0.0) {
        EXPECT_EQ(simulation.events().size(), 0u);
      }
      // Touching, whether noticed or not, changes nothing but by the root of rounding.
      const double height = simulation.state().position(ball)[1];
      if (overlap <= 0.0) {
        EXPECT_NEAR(height, 0.0, overlap < 0.0 ? 1e-13 : 1e-6);
      }
    }
  }
}

TEST(EventBall, AtRestInContactWithoutGravity) {
  for (const EventDriven& options : default_and_tight()) {
    const BallScene scene = over_a_floor({.position = {0.0, 0.0}, .gravity = 0.0});
    Simulation simulation(scene.system, options);
    const auto before = carom_test::motion_bits(simulation.state());
    simulation.run_until(1000.0);
    EXPECT_EQ(carom_test::motion_bits(simulation.state()), before);
    EXPECT_LE(simulation.statistics().flow_steps, 20000);
  }
}

/// A scene with impacts, sliding, sticking and an accumulation.
BallScene busy() {
  BallScene scene =
      over_a_floor({.position = {0.0, 0.5},
                    .velocity = {1.0, 0.0},
                    .surface = {.friction = 0.3, .normal_restitution = 0.6, .tangential_restitution = 0.2}});
  const BodyId box = scene.system.add(RigidBody{.mass = planar::box(2.0, 0.4, 0.2),
                                                .position = {-1.0, 0.6},
                                                .angle = 0.4,
                                                .velocity = {1.5, 0.0},
                                                .spin = 3.0});
  scene.system.add(Polygon{.body = box, .vertices = {{-0.2, -0.1}, {0.2, -0.1}, {0.2, 0.1}, {-0.2, 0.1}}});
  scene.system.add(SpringDamper{
      .from = End<2>(box), .to = End<2>(scene.ball), .stiffness = 5.0, .damping = 0.1, .free_length = 1.0});
  return scene;
}

std::vector<std::uint64_t> event_bits(const Simulation& simulation) {
  std::vector<std::uint64_t> bits;
  for (const EventRecord& event : simulation.events()) {
    carom_test::append_bits(bits, event.time);
    bits.push_back(static_cast<std::uint64_t>(event.kind));
    for (int i = 0; i < 2; ++i) {
      const auto at = static_cast<std::size_t>(i);
      carom_test::append_bits(bits, event.velocity_before[at]);
      carom_test::append_bits(bits, event.velocity_after[at]);
      carom_test::append_bits(bits, event.impulse[at]);
    }
  }
  return bits;
}

TEST(EventBall, OutputTimesDoNotChangeTheRun) {
  const BallScene scene = busy();
  for (const FlowMethod method : carom_test::flow_methods) {
    std::vector<std::uint64_t> events, motion;
    for (const double interval : {1e-2, 1.0, 0.37, 1.7e-3}) {
      Simulation simulation(scene.system, EventDriven{.method = method, .interval = interval});
      double sum = 0.0;
      if (interval != 1.0) {
        simulation.observe([&](const Simulation& now) { sum += now.energy().total() + now.state().q[0]; });
      }
      simulation.run_until(3.0);
      if (events.empty()) {
        events = event_bits(simulation);
        motion = carom_test::motion_bits(simulation.state());
        EXPECT_GE(count(simulation, EventKind::impact), 10);
        EXPECT_GE(count(simulation, EventKind::accumulation), 1);
      }
      EXPECT_EQ(event_bits(simulation), events) << interval;
      EXPECT_EQ(carom_test::motion_bits(simulation.state()), motion) << interval;
    }
  }
}

TEST(EventBall, RunsAreTheSameEachTime) {
  const BallScene scene = busy();
  Simulation one(scene.system, EventDriven{}), two(scene.system, EventDriven{});
  one.run_until(2.0);
  two.run_until(2.0);
  EXPECT_EQ(carom_test::bits_of(one), carom_test::bits_of(two));
  EXPECT_EQ(event_bits(one), event_bits(two));
}

}  // namespace
