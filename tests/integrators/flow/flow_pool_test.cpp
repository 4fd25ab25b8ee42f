// Flows are shared: few are made for many components, whoever is served by them moves as if it had one to
// itself, and none is lost.

#include <carom/core/assembly.h>
#include <carom/core/errors.h>
#include <carom/integrators/event_driven/event_driver.h>
#include <carom/integrators/flow/flow.h>
#include <carom/integrators/flow/flow_pool.h>
#include <carom/integrators/run/companion.h>

#include "tests/allocation_counter.h"
#include "tests/integrators/event_runs.h"
#include "tests/integrators/flow_problems.h"
#include "tests/integrators/same_run.h"

#include <carom/carom.h>
#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using namespace flow_problems;

TEST(FlowPool, LendsWhatCameBack) {
  FlowPool pool(FlowMethod::explicit_runge_kutta, 1e-8);
  Problem swing = oscillator(1e-8), turn = pendulum(1e-8);
  FlowPool::Loan first = pool.borrow(swing);
  Flow* const one = first.get();
  FlowPool::Loan second = pool.borrow(turn);
  EXPECT_NE(second.get(), one);
  EXPECT_EQ(pool.made(), 2U);
  EXPECT_EQ(pool.lent(), 2U);
  first.reset();
  EXPECT_EQ(pool.lent(), 1U);
  first = pool.borrow(turn);
  EXPECT_EQ(first.get(), one);
  EXPECT_EQ(pool.made(), 2U);

  first->start(0.0, std::array{1.0, 0.0}, 0.0);
  go_to(*first, 1.0);
  second->start(0.0, std::array{1.0, 0.0}, 0.0);
  EXPECT_EQ(swing.evaluations, 0);
  EXPECT_EQ(pool.counts().evaluations, turn.evaluations);
  EXPECT_EQ(pool.counts().steps, first->counts().steps);
  EXPECT_EQ(pool.counts().restarts, 2);
}

TEST(FlowPool, KeepsSizesApart) {
  FlowPool pool(FlowMethod::one_step, 1e-8);
  Problem two = oscillator(1e-8);
  Problem one(1, 1e-8, [](double, const double*, double* rates) { rates[0] = 1.0; });
  pool.borrow(two).reset();
  pool.borrow(one).reset();
  EXPECT_EQ(pool.made(), 2U);
  for (int i = 0; i < 3; ++i) {
    const FlowPool::Loan of_two = pool.borrow(two), of_one = pool.borrow(one);
    EXPECT_EQ(of_two->state().size(), 2U);
    EXPECT_EQ(of_one->state().size(), 1U);
  }
  EXPECT_EQ(pool.made(), 2U);
  EXPECT_EQ(pool.lent(), 0U);
}

TEST(FlowPool, WhatCannotBeMadeIsNotLent) {
  FlowPool pool(FlowMethod::one_step, 1e-8);
  Problem fine = oscillator(1e-8), intolerant(2, 0.0, {});
  EXPECT_THROW((void)pool.borrow(intolerant), ModelError);
  EXPECT_EQ(pool.made(), 0U);
  pool.borrow(fine).reset();
  EXPECT_THROW((void)pool.borrow(intolerant), ModelError);  // by the flow that is there
  EXPECT_EQ(pool.lent(), 0U);
  EXPECT_TRUE(pool.borrow(fine));
  EXPECT_EQ(pool.made(), 1U);
}

TEST(FlowPool, LendingTakesNoMemory) {
  FlowPool pool(FlowMethod::bdf, 1e-8);
  Problem swing = oscillator(1e-8);
  std::vector<FlowPool::Loan> loans(20);
  const auto borrow_all = [&] {
    for (FlowPool::Loan& loan : loans) loan = pool.borrow(swing);
  };
  borrow_all();
  const std::int64_t before = carom_test::allocations();
  for (FlowPool::Loan& loan : loans) loan.reset();
  borrow_all();
  EXPECT_EQ(carom_test::allocations() - before, 0);
  EXPECT_EQ(pool.made(), 20U);
}

// Balls side by side, each its own component, no two alike; e < 1 so that they come to rest.
constexpr double radius = 0.1;

void add_ball(System& system, int i) {
  const BodyId ball = system.add(RigidBody{.mass = disc(1.0 + 0.01 * i, radius),
                                           .position = {1.0 * i, radius + 0.02 + 1e-4 * i},
                                           .velocity = {0.2, 0.0},
                                           .spin = 0.1 * (i % 7)});
  system.add(Disc{.body = ball, .radius = radius});
}

System floor_alone(double restitution = 0.5) {
  System system;
  system.add(Gravity{{0.0, -9.81}});
  system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = 0.3, .normal_restitution = restitution},
             "floor");
  return system;
}

System balls(int count) {
  System system = floor_alone();
  for (int i = 0; i < count; ++i) add_ball(system, i);
  return system;
}

// Air: what flies through it is not ballistic.
void slow_down(System& system, BodyId body) { system.add(Drag{.on = body, .linear = 0.01}); }

// A driver with all that it advances.
struct Journey {
  Journey(const System& system, const EventDriven& options)
      : assembly(system), driver(assembly, options), state(assembly.initial_state()) {
    Evaluation evaluation = make_evaluation(assembly);
    companion.ledger.open(stored_energies(assembly, state.view(), evaluation));
  }
  void to(double time) { driver.advance(state, companion, time, report, events); }
  [[nodiscard]] const FlowPool& flows() const { return driver.flows(); }
  [[nodiscard]] std::int64_t evaluations() const { return companion.statistics.flow_evaluations; }

  Assembly assembly;
  EventDriver driver;
  State state;
  Companion companion;
  StepReport report;
  RecordedEvents events;
};

TEST(SharedFlows, AThousandBallsNeedTwo) {
  constexpr int count = 1000;
  for (const FlowMethod method : {FlowMethod::explicit_runge_kutta, FlowMethod::one_step}) {
    Journey run(balls(count), {.method = method});
    EXPECT_EQ(run.flows().made(), 0U);
    for (int i = 1; i <= 5; ++i) {
      run.to(0.04 * i);
      EXPECT_EQ(run.flows().lent(), 0U);
    }
    EXPECT_EQ(run.flows().made(), 2U);  // for flight and for contact
    EXPECT_GE(run.companion.statistics.impacts, count);
  }
}

// Motion of one ball as bits, at the times of output, then its events.
std::vector<std::uint64_t> story(const System& system, BodyId ball, const EventDriven& options) {
  std::vector<std::uint64_t> bits;
  Simulation simulation(system, options);
  simulation.observe([&](const Simulation& now) {
    const Vec<2> x = now.state().position(ball), v = now.state().velocity(ball);
    for (const double number : {x[0], x[1], v[0], v[1], now.state().spin(ball)})
      carom_test::append_bits(bits, number);
  });
  simulation.run_until(0.7);
  for (const EventRecord& event : simulation.events()) {
    if (event.body != ball) continue;
    bits.push_back(static_cast<std::uint64_t>(event.kind));
    for (const double number : {event.time, event.impulse[0], event.impulse[1], event.energy_after})
      carom_test::append_bits(bits, number);
  }
  return bits;
}

// Components that share differ in what they are in the middle of: the first guess, a step with an event, long
// motion without any, cuts by breaks of laws, joints.
System company(std::vector<BodyId>& bodies, int only = -1) {
  System system = floor_alone();
  const auto wanted = [only](int component) { return only < 0 || only == component; };
  for (int i = 0; i < 6; ++i) {
    const double x = 2.0 * i;
    if (!wanted(i)) continue;
    const BodyId body = bodies.emplace_back(system.add(RigidBody{.mass = disc(1.0 + i, radius),
                                                                 .position = {x, 0.15 + 0.1 * i},
                                                                 .velocity = {0.3, 0.0},
                                                                 .spin = 1.0}));
    if (i < 2) system.add(Disc{.body = body, .radius = radius});
    if (i == 2 || i == 3) {
      system.add(SpringDamper{
          .from = {ground, {x, 2.0}}, .to = {body, {0.0, 0.05}}, .stiffness = 50.0, .free_length = 1.0});
    }
    if (i == 4) system.add(Revolute{.from = {ground, {x - 0.2, 0.55}}, .to = {body, {-0.2, 0.0}}});
    if (i == 5) {
      system.add(AppliedForce{.on = body,
                              .force = [](double t) { return Vec<2>(t < 0.333 ? 5.0 : -5.0, 0.0); },
                              .breaks = {0.333}});
    }
  }
  return system;
}

TEST(SharedFlows, SameBitsAsByItself) {
  for (const FlowMethod method : carom_test::flow_methods) {
    const EventDriven options{.method = method, .interval = 0.0123};
    std::vector<BodyId> bodies;
    const System together = company(bodies);
    for (int i = 0; i < 6; ++i) {
      std::vector<BodyId> alone;
      const System apart = company(alone, i);
      EXPECT_EQ(story(together, bodies[static_cast<std::size_t>(i)], options),
                story(apart, alone.front(), options))
          << "component " << i << ", method " << static_cast<int>(method);
    }
  }
}

TEST(SharedFlows, NoEvaluationIsMadeTwice) {
  for (const FlowMethod method : carom_test::flow_methods) {
    const EventDriven options{.method = method, .interval = 0.0123};
    const auto evaluations = [&](int only) {
      std::vector<BodyId> bodies;
      Simulation simulation(company(bodies, only), options);
      simulation.run_until(0.7);
      return simulation.statistics().flow_evaluations;
    };
    std::int64_t apart = 0;
    for (int i = 0; i < 6; ++i) apart += evaluations(i);
    EXPECT_EQ(evaluations(-1), apart) << "method " << static_cast<int>(method);
  }
}

TEST(SharedFlows, MethodsOfManyStepsKeepTheirsThroughAPhase) {
  constexpr std::size_t count = 40;
  for (const FlowMethod method : {FlowMethod::adams, FlowMethod::bdf}) {
    System system = balls(count);
    for (const BodyId ball : system.bodies()) slow_down(system, ball);
    Journey run(system, {.method = method});
    run.to(0.01);
    EXPECT_EQ(run.flows().made(), count);
    run.to(0.1);
    EXPECT_EQ(run.flows().lent(), count);
    EXPECT_EQ(run.flows().made(), count);
  }
}

TEST(SharedFlows, AtRestThereIsNone) {
  for (const FlowMethod method : carom_test::flow_methods) {
    System system = floor_alone();
    for (int i = 0; i < 5; ++i) {
      const BodyId brick = system.add(RigidBody{.mass = {.mass = 1.0, .inertia = 0.01},
                                                .position = {1.0 * i, radius + (i == 4 ? 0.01 : 0.0)}});
      system.add(Polygon{.body = brick, .vertices = {{-0.1, -0.1}, {0.1, -0.1}, {0.1, 0.1}, {-0.1, 0.1}}});
      if (i == 4) slow_down(system, brick);
    }
    Journey run(system, {.method = method});
    run.to(0.01);
    const bool one_step = method == FlowMethod::explicit_runge_kutta || method == FlowMethod::one_step;
    EXPECT_EQ(run.flows().made(), 1U);  // of the one that falls
    EXPECT_EQ(run.flows().lent(), one_step ? 0U : 1U);
    run.to(1.0);
    EXPECT_EQ(run.flows().made(), 1U);
    EXPECT_EQ(run.flows().lent(), 0U);
    const std::int64_t before = run.evaluations();
    run.to(10.0);
    EXPECT_EQ(run.evaluations(), before);
  }
}

// The last of some balls has a load that ends: all others have moved when that is noticed.
TEST(SharedFlows, AFailureLosesNone) {
  constexpr double end = 0.05;
  const auto doomed = [] {
    System system = balls(20);
    const BodyId last = system.add(RigidBody{.mass = disc(1.0, radius), .position = {-1.0, 1.0}});
    system.add(AppliedForce{.on = last, .force = [](double t) {
                              return Vec<2>(t > end ? std::numeric_limits<double>::quiet_NaN() : 1.0, 0.0);
                            }});
    return system;
  };
  for (const FlowMethod method : carom_test::flow_methods) {
    const EventDriven options{.method = method};
    Journey run(doomed(), options);
    run.to(0.03);
    const std::size_t made = run.flows().made(), told = run.events.records().size();
    const State before = run.state;
    for (int i = 0; i < 3; ++i) EXPECT_THROW(run.to(0.1), SolverError);
    EXPECT_EQ(run.state.time, 0.03);
    EXPECT_EQ(carom_test::motion_bits(run.state), carom_test::motion_bits(before));
    EXPECT_EQ(run.events.records().size(), told);
    run.to(0.045);
    EXPECT_EQ(run.flows().made(), made);

    // As a driver that starts there, which none of this happened to.
    Journey other(doomed(), options);
    other.state = before;
    other.companion.modes = run.companion.modes;
    other.to(0.045);
    EXPECT_EQ(carom_test::motion_bits(run.state), carom_test::motion_bits(other.state));
  }
}

TEST(SharedFlows, SteadyStateTakesNoMemory) {
  System system = floor_alone(1.0);
  for (int i = 0; i < 10; ++i) {
    add_ball(system, i);
    const BodyId bob = system.add(Particle{.mass = 1.0, .position = {1.0 * i, 3.0}});
    system.add(
        SpringDamper{.from = {ground, {1.0 * i, 4.0}}, .to = bob, .stiffness = 50.0 + i, .free_length = 0.5});
  }
  for (const FlowMethod method : {FlowMethod::explicit_runge_kutta, FlowMethod::one_step}) {
    Simulation simulation(system, EventDriven{.method = method, .record_events = false});
    simulation.run_until(3.0);
    const std::int64_t impacts = simulation.statistics().impacts;
    const std::int64_t before = carom_test::allocations();
    simulation.run_until(4.0);
    EXPECT_EQ(carom_test::allocations() - before, 0);
    EXPECT_GT(simulation.statistics().impacts, impacts + 20);
  }
}

}  // namespace
