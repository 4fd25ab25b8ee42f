// Impossible input is refused by name in the event-driven mode too, with the value and what is allowed;
// nothing has changed afterwards, and the run can go on.

#include "tests/integrators/event_runs.h"
#include "tests/integrators/same_run.h"
#include "tests/integrators/throws.h"
#include "tests/model_error.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::bits_of;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

System ball(const Surface& surface = {.friction = 0.3, .normal_restitution = 0.5}, double height = 1.0,
            const Vec<2>& velocity = {0.0, 0.0}) {
  System system;
  system.add(Gravity{{0.0, -9.81}});
  system.add(HalfPlane{.normal = {0.0, 1.0}}, surface, "floor");
  system.add(Particle{.mass = 1.0, .position = {0.0, height}, .velocity = velocity}, "ball");
  return system;
}

TEST(EventBadInput, EveryOption) {
  const auto refused = [](const EventDriven& options, const char* name, const char* value) {
    EXPECT_MODEL_ERROR(Simulation(ball(), options), "event-driven", name, value, "allowed");
    Simulation simulation(ball(), EventDriven{});
    simulation.run_until(0.6);  // with an impact behind it
    const auto before = bits_of(simulation);
    EXPECT_MODEL_ERROR(simulation.switch_to(options), "event-driven", name, value, "allowed");
    EXPECT_EQ(bits_of(simulation), before);
    Simulation undisturbed(ball(), EventDriven{});
    undisturbed.run_until(0.6);
    simulation.run_until(1.0);  // it still runs, as if nothing had been
    undisturbed.run_until(1.0);
    EXPECT_EQ(bits_of(simulation), bits_of(undisturbed));
  };
  const auto positive = [&](double EventDriven::*member, const char* name) {
    for (const auto& [value, text] :
         {std::pair{0.0, "is 0"}, {-1e-3, "-0.001"}, {nan, "nan"}, {infinity, "inf"}}) {
      EventDriven options;
      options.*member = value;
      refused(options, name, text);
    }
  };
  positive(&EventDriven::relative_tolerance, "relative_tolerance");
  positive(&EventDriven::absolute_tolerance, "absolute_tolerance");
  positive(&EventDriven::interval, "interval");
  positive(&EventDriven::longest_step, "longest_step");
  positive(&EventDriven::gap_tolerance, "gap_tolerance");
  positive(&EventDriven::capture_speed, "capture_speed");
  positive(&EventDriven::event_limit, "event_limit");
  EXPECT_THROW(Simulation(ball(), EventDriven{.failure_directory = "/nowhere/at/all"}), Error);
}

TEST(EventBadInput, SurfacesThatCannotBe) {
  const auto refused = [](const Surface& surface, const char* name) {
    EXPECT_MODEL_ERROR(Simulation(ball(surface), EventDriven{}), "floor", name, "allowed");
  };
  refused({.friction = 0.3, .normal_restitution = 1.1}, "normal_restitution");
  refused({.friction = 0.3, .normal_restitution = -0.1}, "normal_restitution");
  refused({.friction = 0.3, .normal_restitution = nan}, "normal_restitution");
  refused({.friction = 0.3, .normal_restitution = 0.5, .tangential_restitution = 1.1},
          "tangential_restitution");
  refused({.friction = -0.3, .normal_restitution = 0.5}, "friction");
  refused({.friction = infinity, .normal_restitution = 0.5}, "friction");
}

TEST(EventBadInput, AContactWithoutALaw) {
  System system;
  system.add(HalfPlane{.normal = {0.0, 1.0}}, "floor");
  system.add(Particle{.mass = 1.0, .position = {0.0, 1.0}}, "ball");
  EXPECT_MODEL_ERROR(Simulation(system, EventDriven{}), "ball", "floor", "law", "allowed");
}

TEST(EventBadInput, ContactInSpace) {
  for (const double friction : {0.0, 0.3}) {
    System system;
    system.add(spatial::Gravity{{0.0, 0.0, -9.81}});
    system.add(spatial::HalfSpace{.normal = {0.0, 0.0, 1.0}},
               Surface{.friction = friction, .normal_restitution = 0.5});
    system.add(spatial::Particle{.mass = 1.0, .position = {0.0, 0.0, 1.0}}, "stone");
    EXPECT_MODEL_ERROR(Simulation(system, EventDriven{}), "event-driven", "particle 'stone'", "space",
                       "allowed");
    Simulation simulation(system, TimeStepping{});
    simulation.run_until(0.1);
    const auto before = bits_of(simulation);
    EXPECT_MODEL_ERROR(simulation.switch_to(EventDriven{}), "particle 'stone'", "space");
    EXPECT_EQ(bits_of(simulation), before);
  }
  // A body that touches nothing flies.
  System flight;
  flight.add(spatial::Gravity{{0.0, 0.0, -9.81}});
  const BodyId id = flight.add(spatial::Particle{.mass = 1.0, .velocity = {1.0, 2.0, 0.0}});
  Simulation simulation(flight, EventDriven{});
  simulation.run_until(2.0);
  EXPECT_NEAR((simulation.state().position(id) - Vec<3>(2.0, 4.0, -2.0 * 9.81)).norm(), 0.0, 1e-12);
}

TEST(EventBadInput, AStartWithinAnObstacle) {
  // Within gap_tolerance it touches; deeper it is refused.
  EXPECT_NO_THROW(
      Simulation(ball({.friction = 0.3, .normal_restitution = 0.5}, -0.9e-9), EventDriven{}).step());
  EXPECT_MODEL_ERROR(Simulation(ball({.friction = 0.3, .normal_restitution = 0.5}, -1e-3), EventDriven{}),
                     "particle 'ball'", "half-plane 'floor'", "-0.001", "gap_tolerance", "allowed");
}

TEST(EventBadInput, AStateWithinAnObstacleOrNotFinite) {
  Simulation simulation(ball(), EventDriven{});
  simulation.run_until(0.2);
  const State good = simulation.state();
  State state = good;
  state.v[0] = nan;
  const auto before = bits_of(simulation);
  EXPECT_MODEL_ERROR(simulation.set_state(state), "ball");
  EXPECT_EQ(bits_of(simulation), before);
  state = good;
  state.q[1] = -0.25;
  EXPECT_MODEL_ERROR(simulation.set_state(state), "ball", "floor", "-0.25");
  EXPECT_EQ(bits_of(simulation), before);
  // It runs on, as if nothing had been.
  simulation.run_until(1.0);
  Simulation undisturbed(ball(), EventDriven{});
  undisturbed.run_until(0.2);
  undisturbed.run_until(1.0);
  EXPECT_EQ(bits_of(simulation), bits_of(undisturbed));
}

TEST(EventBadInput, TimesThatCannotBe) {
  Simulation simulation(ball(), EventDriven{});
  simulation.run_until(0.6);
  const auto before = bits_of(simulation);
  EXPECT_MODEL_ERROR(simulation.run_until(0.5), "0.5", "allowed");
  EXPECT_MODEL_ERROR(simulation.run_until(nan), "nan", "allowed");
  EXPECT_MODEL_ERROR(simulation.run_until(infinity), "inf", "allowed");
  EXPECT_EQ(bits_of(simulation), before);
  simulation.run_until(0.6);  // where it stands
  EXPECT_EQ(simulation.time(), 0.6);
}

TEST(EventBadInput, MoreEventsThanAllowed) {
  // A ball on a floor that throws it back without loss, from 5 um: 500 impacts a second, where ten are
  // allowed over the last 1,000 events.
  const Surface elastic{.friction = 0.0, .normal_restitution = 1.0};
  Simulation simulation(ball(elastic, 5e-6), EventDriven{.event_limit = 10.0});
  State last = simulation.state();
  simulation.observe([&](const Simulation& now) { last = now.state(); });
  EXPECT_THROWS(SolverError, simulation.run_until(100.0), "event_limit", "10", "particle 'ball'",
                "half-plane 'floor'");
  EXPECT_EQ(simulation.state().q, last.q);
  EXPECT_EQ(simulation.state().v, last.v);
  EXPECT_EQ(simulation.state().time, last.time);
  EXPECT_GT(simulation.time(), 0.1);
  simulation.run_until(simulation.time() + 0.1);  // the counting starts anew
  simulation.switch_to(EventDriven{});
  simulation.run_until(10.0);
  EXPECT_NEAR(simulation.energy().total(), 9.81 * 5e-6, 1e-12);
}

// Each impact of a disc on the floor joins the neighbour that it touches, and parts from it again: events are
// counted through all that.
TEST(EventBadInput, MoreEventsThanAllowedOfGroupsThatJoinAndPart) {
  System system;
  system.add(Gravity{{0.0, -9.81}});
  system.set_default_law({.friction = 0.0, .normal_restitution = 1.0});
  system.add(HalfPlane{.normal = {0.0, 1.0}}, "floor");
  constexpr double radius = 0.1, height = 5e-6;
  for (const char* const name : {"left disc", "right disc"}) {
    const double x = system.bodies().empty() ? 0.0 : 2.0 * radius;
    const BodyId body =
        system.add(RigidBody{.mass = disc(1.0, radius), .position = {x, radius + height}}, name);
    system.add(Disc{.body = body, .radius = radius});
  }
  Simulation simulation(system, EventDriven{.event_limit = 10.0, .record_events = false});
  EXPECT_THROWS(SolverError, simulation.run_until(100.0), "event_limit", "10", "disc'", "half-plane 'floor'");
  EXPECT_LT(simulation.time(), 5.0);  // 1,000 events last 2 s
}

TEST(EventBadInput, AnEnergyGainThatIsRefused) {
  // The example of the paper with (e_n, e_t) = (1, 0): r_1 = r, r_2 = -r, I = m r^2, mu = 1.
  System system;
  system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = 1.0, .normal_restitution = 1.0}, "floor");
  const BodyId id = system.add(
      RigidBody{.mass = {.mass = 1.0, .inertia = 1.0}, .position = {0.0, 1.1}, .velocity = {1.0, -2.0}},
      "foot");
  system.add(Point{.body = id, .position = {-1.0, -1.0}});
  Simulation allowed(system, EventDriven{});
  allowed.run_until(0.1);
  EXPECT_NEAR(allowed.statistics().energy_gained, 2.0 / 15.0 * 2.5, 1e-12);
  Simulation refused(system, EventDriven{.impact_rules = {.energy_gain = EnergyGain::refuse}});
  refused.run_until(0.04);
  const auto before = bits_of(refused);
  EXPECT_THROWS(SolverError, refused.run_until(0.1), "impact_rules.energy_gain", "'foot'",
                "half-plane 'floor'");
  EXPECT_EQ(refused.statistics().energy_gains, 0);
  EXPECT_LE(refused.time(), 0.05);  // it would hit then
  refused.switch_to(EventDriven{});
  refused.run_until(0.1);
  EXPECT_EQ(refused.statistics().energy_gains, 1);
}

TEST(EventBadInput, LoadsThatAreNotFinite) {
  System system = ball();
  system.add(AppliedForce{.on = system.bodies().front(),
                          .force = [](double t) { return Vec<2>(t > 0.3 ? nan : 0.0, 0.0); }});
  Simulation simulation(system, EventDriven{});
  EXPECT_THROWS(SolverError, simulation.run_until(1.0), "'ball'");
  EXPECT_LE(simulation.time(), 0.3);
  for (const double number : simulation.state().q) EXPECT_TRUE(std::isfinite(number));
}

}  // namespace
