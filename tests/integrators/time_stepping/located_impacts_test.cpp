// Option TimeStepping::impacts = located: bodies are hit when their gaps close. Against the event-driven mode
// and closed forms; orders are measured.

#include "examples/scenes/incline.h"
#include "examples/scenes/tables.h"
#include "tests/allocation_counter.h"
#include "tests/analytic/convergence.h"
#include "tests/energy/ledger_check.h"
#include "tests/integrators/event_run.h"
#include "tests/integrators/time_stepping/located_runs.h"
#include "tests/model_error.h"
#include "tests/random.h"
#include "tests/temporary_folder.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::add_floor;
using carom_test::distance;
using carom_test::ledger_closes;
using carom_test::located;
using carom_test::run;
using carom_test::tight;

constexpr double g = 9.81;

System ball(double height, double speed, double e) {
  System system;
  add_floor(system, 0.0, e, 0.0);
  system.add(Particle{.mass = 1.0, .position = {0.0, height}, .velocity = {1.0, speed}}, "ball");
  return system;
}

PrescribedMotion vibration(double a, double w) {
  return {.displacement = [=](double t) { return Vec<2>(0.0, a * std::sin(w * t)); },
          .velocity = [=](double t) { return Vec<2>(0.0, a * w * std::cos(w * t)); }};
}

/// Two particles that bounce, on a spring with a dashpot.
System pair(double damping, double friction) {
  System system;
  add_floor(system, friction, 0.8, 0.5);
  const BodyId low = system.add(Particle{.mass = 1.0, .position = {0.0, 0.5}, .velocity = {1.0, 0.0}}, "low");
  const BodyId high = system.add(Particle{.mass = 1.5, .position = {0.1, 1.5}}, "high");
  system.add(
      SpringDamper{.from = low, .to = high, .stiffness = 300.0, .damping = damping, .free_length = 1.0});
  return system;
}

System thrown_box(double e, double friction) {
  System system;
  add_floor(system, friction, e, e);
  const BodyId body = system.add(RigidBody{.mass = box(1.0, 1.0, 0.6),
                                           .position = {0.0, 1.0},
                                           .angle = 0.3,
                                           .velocity = {1.0, 0.0},
                                           .spin = 1.0},
                                 "box");
  system.add(Polygon{.body = body, .vertices = {{-0.5, -0.3}, {0.5, -0.3}, {0.5, 0.3}, {-0.5, 0.3}}});
  return system;
}

// Flights under constant loads are exact, so that only the search for the instant is left.
TEST(LocatedImpacts, OfABallBetweenTwoTablesAreExact) {
  System system;
  scenes::add_tables(system, {});
  const State there = run(system, tight(), 1.0);
  for (const double step : {1e-2, 1e-3, 1e-4}) {
    // 1e4 steps of rounding, which angles of up to 500 rad dominate.
    EXPECT_LT(distance(run(system, located(step), 1.0), there), 1e-10) << step;
  }
  EXPECT_GT(distance(run(system, TimeStepping{.step = 1e-4}, 1.0), there), 1e-4);
}

TEST(LocatedImpacts, OfABarOnAnInclineKeepTheEnergyThatTheEventDrivenModeFinds) {
  System system;
  const scenes::Incline incline;
  scenes::add_plane(system, incline);
  scenes::add_bar(system, incline);
  Simulation events(system, tight()), steps(system, located(1.0 / 1200.0));
  events.run_until(8.0);
  steps.run_until(8.0);
  // The first of several impacts is found to 1e-15 of a step; later ones multiply that.
  EXPECT_NEAR(steps.energy().total(), events.energy().total(), 1e-8);
  EXPECT_LT(distance(steps.state(), events.state()), 1e-8);
}

struct OrderCase {
  const char* name;
  System system;
  double end, largest_step;
};

class LocatedOrder : public testing::TestWithParam<int> {};

std::vector<OrderCase> order_cases() {
  std::vector<OrderCase> cases;
  cases.push_back({"pair", pair(0.0, 0.3), 1.0, 4e-3});
  cases.push_back({"damped pair", pair(5.0, 0.3), 1.0, 4e-3});
  cases.push_back({"box that comes to lie on a corner and tumbles", thrown_box(0.0, 0.3), 0.6, 8e-3});
  return cases;
}

TEST_P(LocatedOrder, IsTwo) {
  const OrderCase scene = order_cases()[static_cast<std::size_t>(GetParam())];
  const State there = run(scene.system, tight(), scene.end);
  const analytic::MeanOrder order = analytic::mean_order(scene.largest_step, 5, 12, [&](double step) {
    return distance(run(scene.system, located(step), scene.end), there);
  });
  // 2; the error scatters with where the grid of steps lies, as the deviation says.
  EXPECT_GT(order.slope, 1.8) << scene.name << ", deviation " << order.deviation;
  EXPECT_LT(order.slope, 2.4) << scene.name;
  const State first_order = run(scene.system, TimeStepping{.step = order.steps.back()}, scene.end);
  EXPECT_GT(distance(first_order, there), 20.0 * order.errors.back()) << scene.name;
}

INSTANTIATE_TEST_SUITE_P(Scenes, LocatedOrder, testing::Values(0, 1, 2));

// The loads of a step pass momentum on in full, whatever hits a body on the way.
TEST(LocatedImpacts, KeepTheMomentumAlongASmoothFloor) {
  for (const double damping : {0.0, 5.0}) {
    const System system = pair(damping, 0.0);
    Simulation simulation(system, located(2e-3));
    simulation.run_until(2.0);
    const BodyId low = system.body("low"), high = system.body("high");
    const double momentum = simulation.state().velocity(low)[0] + 1.5 * simulation.state().velocity(high)[0];
    EXPECT_GT(simulation.statistics().impacts, 3);
    // 1000 steps, each with changes of 1e-12 m in the loads that it iterates.
    EXPECT_NEAR(momentum, 1.0, 1e-8) << damping;
  }
}

TEST(LocatedImpacts, AtTheVeryStartAndTheVeryEndOfAStepAreExact) {
  const double e = 0.5, step = 1e-2;
  {
    Simulation simulation(ball(0.0, -2.0, e), located(step));
    simulation.step();
    EXPECT_NEAR(simulation.state().v[1], 2.0 * e - g * step, 1e-15);
    EXPECT_NEAR(simulation.state().q[1], 2.0 * e * step - 0.5 * g * step * step, 1e-16);
  }
  for (const double off : {-1e-15, 0.0, 1e-15}) {
    const double height = 2.0 * step + 0.5 * g * step * step + off;
    Simulation simulation(ball(height, -2.0, e), located(step));
    simulation.run_until(2.0 * step);
    const double after = e * (2.0 + g * step);
    EXPECT_NEAR(simulation.state().v[1], after - g * step, 1e-12) << off;
    EXPECT_NEAR(simulation.state().q[1], after * step - 0.5 * g * step * step, 1e-14) << off;
  }
}

TEST(LocatedImpacts, AtOneInstantAreOneImpactOfTheBody) {
  System system;
  add_floor(system, 0.5, 0.5, 0.5);
  const BodyId body = system.add(
      RigidBody{.mass = box(1.0, 1.0, 0.6), .position = {0.0, 1.0}, .velocity = {1.0, 0.0}}, "box");
  system.add(Polygon{.body = body, .vertices = {{-0.5, -0.3}, {0.5, -0.3}, {0.5, 0.3}, {-0.5, 0.3}}});
  const double fall = std::sqrt(2.0 * 0.7 / g);
  Simulation steps(system, located(1e-2)), events(system, tight());
  steps.run_until(fall + 0.1);
  events.run_until(fall + 0.1);
  EXPECT_LT(distance(steps.state(), events.state()), 1e-12);
}

TEST(LocatedImpacts, OfTwoBodiesAtOneInstantMirrorEachOther) {
  System system;
  add_floor(system, 0.3, 0.7, 0.0);
  const BodyId left = system.add(Particle{.mass = 1.0, .position = {-0.5, 0.3}});
  const BodyId right = system.add(Particle{.mass = 1.0, .position = {0.5, 0.3}});
  system.add(SpringDamper{.from = left, .to = right, .stiffness = 500.0, .damping = 3.0, .free_length = 0.9});
  const State end = run(system, located(1e-3), 1.0);
  EXPECT_EQ(end.position(left)[1], end.position(right)[1]);
  EXPECT_EQ(end.position(left)[0], -end.position(right)[0]);
}

TEST(LocatedImpacts, ThatGrazeAreNoFailure) {
  // The lowest point of the flight is within a step, above the ceiling by less than rounding, or below it.
  for (const double off : {-1e-6, -1e-12, 0.0, 1e-12, 1e-6}) {
    System system;
    system.add(Gravity{{0.0, -g}});
    system.add(HalfPlane{.point = {0.0, 1.0 + off}, .normal = {0.0, -1.0}},
               Surface{.friction = 0.3, .normal_restitution = 0.5, .tangential_restitution = 0.0});
    system.add(Particle{.mass = 1.0, .velocity = {1.0, std::sqrt(2.0 * g)}});
    for (const double step : {1e-2, 3e-3}) {
      const State end = run(system, located(step), 0.8);
      const double free = std::sqrt(2.0 * g) * 0.8 - 0.5 * g * 0.8 * 0.8;
      // A graze at depth d closes at sqrt(2 g d).
      EXPECT_NEAR(end.q[1], free, 2.0 * std::sqrt(2.0 * g * std::max(-off, step * step)) * 0.5) << off;
    }
  }
}

TEST(LocatedImpacts, ThatAccumulateEndAtRest) {
  for (const int most : {1, 2, 10}) {
    TimeStepping options = located(5e-3);
    options.most_impacts = most;
    Simulation simulation(ball(0.3, 0.0, 0.6), options);
    simulation.run_until(5.0);
    // The last contact begins with at most the capture speed, and lasts.
    EXPECT_NEAR(simulation.state().q[1], 0.0, 1e-2 * 5e-3) << most;
    EXPECT_NEAR(simulation.state().v[1], 0.0, 1e-12) << most;
    EXPECT_TRUE(ledger_closes(simulation.energy()));
    EXPECT_EQ(simulation.report().contacts.size(), 1U);
  }
}

TEST(LocatedImpacts, OnAVibratingTableAreOfSecondOrder) {
  System system;
  system.add(Gravity{{0.0, -g}});
  const double w = 30.0, a = 0.01;
  const PrescribedMotion motion{.displacement = [=](double t) { return Vec<2>(0.0, a * std::sin(w * t)); },
                                .velocity = [=](double t) { return Vec<2>(0.0, a * w * std::cos(w * t)); }};
  system.add(HalfPlane{.normal = {0.0, 1.0}, .motion = vibration(0.01, 30.0)},
             Surface{.friction = 0.0, .normal_restitution = 0.7, .tangential_restitution = 0.0}, "table");
  system.add(Particle{.mass = 1.0, .position = {0.0, 0.2}});
  // The flight is exact and the table is where it is at the instant: nothing of the step is left.
  const State there = run(system, tight(), 0.6);
  EXPECT_LT(distance(run(system, located(4e-3), 0.6), there), 1e-9);
}

// A contact that lasts while the body turns: reactions halfway and the law at the end do not sink.
TEST(LocatedImpacts, LastingContactsOnTurningBodiesNeitherSinkNorGainEnergy) {
  Simulation simulation(thrown_box(0.0, 0.0), located(1e-3));
  double before = simulation.energy().total();
  for (int i = 0; i < 600; ++i) {
    simulation.step();
    // The error of a step is of third order: (w h)^3 m v^2, w = 5/s, v = 3 m/s.
    EXPECT_LT(simulation.energy().total() - before, 1e-6) << i;
    before = simulation.energy().total();
    for (const ContactRecord& contact : simulation.report().contacts) EXPECT_GT(contact.gap, -1e-6) << i;
  }
}

// A regular polygon between a floor and two inclines, rounding of whose contacts opens what just closed.
System polygon_in_a_trough(std::uint64_t seed) {
  carom_test::Random random(seed);
  const double restitution = random.uniform(0.0, 1.0), friction = random.uniform(0.0, 1.0);
  const Surface surface{
      .friction = friction, .normal_restitution = restitution, .tangential_restitution = restitution};
  System system;
  system.add(Gravity{{0.0, -g}});
  system.add(HalfPlane{.normal = {0.0, 1.0}}, surface);
  for (const double side : {-1.0, 1.0}) {
    const double slope = random.uniform(0.3, 1.5);
    system.add(HalfPlane{.point = {2.0 * side, 0.0}, .normal = {-side * std::sin(slope), std::cos(slope)}},
               surface);
  }
  const unsigned corners = 3 + random.below(4);
  const double size = random.uniform(0.1, 0.5), angle = random.uniform(-3.0, 3.0);
  const double x = random.uniform(-1.0, 1.0), spin = random.uniform(-10.0, 10.0);
  Polygon shape;
  for (unsigned i = 0; i < corners; ++i) {
    const double at = 2.0 * std::numbers::pi * i / corners;
    shape.vertices.emplace_back(size * std::cos(at), size * std::sin(at));
  }
  shape.body = system.add(RigidBody{.mass = {1.0, 0.2 * size * size},
                                    .position = {x, 1.5},
                                    .angle = angle,
                                    .velocity = random.vec<2>(3.0),
                                    .spin = spin});
  system.add(shape);
  return system;
}

// One common e: no impact gains energy (Johansson 1999).
TEST(LocatedImpacts, OfPolygonsInATroughComeToAnEndInEveryStep) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    Simulation simulation(polygon_in_a_trough(seed), located(2e-3));
    simulation.run_until(2.0);
    EXPECT_GT(simulation.statistics().impacts, 0) << seed;
    EXPECT_EQ(simulation.statistics().energy_gains, 0) << seed;
    EXPECT_TRUE(ledger_closes(simulation.energy())) << seed;
  }
}

TEST(LocatedImpacts, GoOnBitForBitAfterACheckpoint) {
  const carom_test::TemporaryFolder folder;
  const System system = pair(5.0, 0.3);
  Simulation whole(system, located(1e-3)), part(system, located(1e-3)), again(system, located(1e-3));
  whole.run_until(1.0);
  part.run_until(0.317);
  part.save(folder / "half");
  again.load(folder / "half");
  again.run_until(1.0);
  EXPECT_EQ(whole.state().q, again.state().q);
  EXPECT_EQ(whole.state().v, again.state().v);
}

TEST(LocatedImpacts, TakeNoMemoryOnceTheyWereSeen) {
  System system;
  system.add(Gravity{{0.0, -g}});
  system.add(HalfPlane{.normal = {0.0, 1.0}, .motion = vibration(0.01, 30.0)},
             Surface{.friction = 0.1, .normal_restitution = 0.8, .tangential_restitution = 0.0});
  const BodyId low = system.add(Particle{.mass = 1.0, .position = {0.0, 0.2}});
  const BodyId high = system.add(Particle{.mass = 1.0, .position = {0.1, 1.2}});
  system.add(SpringDamper{.from = low, .to = high, .stiffness = 300.0, .damping = 2.0, .free_length = 1.0});
  Simulation simulation(system, located(1e-3));
  simulation.run_until(10.0);
  const std::int64_t before = carom_test::allocations(), impacts = simulation.statistics().impacts;
  for (int i = 0; i < 2000; ++i) simulation.step();
  EXPECT_GT(simulation.statistics().impacts, impacts + 5);
  EXPECT_EQ(carom_test::allocations() - before, 0);
}

TEST(LocatedImpacts, NameOptionsThatCannotBe) {
  const System system = ball(1.0, 0.0, 0.5);
  TimeStepping options = located(1e-3);
  options.most_impacts = 0;
  EXPECT_TRUE(carom_test::throws_model_error([&] { Simulation(system, options); },
                                             {"time stepping: most_impacts is 0; allowed: at least 1"}));
  options = located(1e-3);
  options.impacts = static_cast<ImpactTimes>(7);
  EXPECT_TRUE(carom_test::throws_model_error([&] { Simulation(system, options); },
                                             {"impacts is 7; allowed: at_step_start (0) or located (1)"}));
}

}  // namespace
