// Work that would have no end is ended, by limits, by refusal before it begins, or by whoever asks for it;
// the simulation stands at its last good state.

#include "tests/integrators/pair_scene.h"
#include "tests/integrators/same_run.h"
#include "tests/integrators/throws.h"
#include "tests/model_error.h"
#include "tests/random.h"

#include <carom/carom.h>
#include <carom/integrators/run/companion.h>

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::bits_of;
using carom_test::pair_scene;
using carom_test::Random;

const std::vector<FlowMethod> methods{FlowMethod::explicit_runge_kutta, FlowMethod::one_step,
                                      FlowMethod::adams, FlowMethod::bdf};

/// A force that is another one each time it is asked for.
struct Noise {
  static constexpr Role role = Role::force;
  static constexpr int dimension = 2;
  static constexpr std::string_view label = "noise";
  BodyId body;
  std::shared_ptr<Random> random = std::make_shared<Random>(7);
  std::vector<BodyId> bodies() const { return {body}; }
  void loads(const ElementView<2>&, ElementLoads<2>& out) const {
    out.external(body, Vec<2>(random->uniform(-100.0, 100.0), random->uniform(-100.0, 100.0)));
  }
};

BodyId add_mass(System& system) {
  return system.add(Particle{.mass = 1.0, .position = {1.1, 0.0}, .velocity = {0.3, 0.2}, .contact = false},
                    "mass");
}

/// The run ends with an error that names the limit and a part, where it stood.
void expect_limit(const System& system, const EventDriven& options, const std::string& limit,
                  const std::string& part) {
  Simulation simulation(system, options);
  const auto before = bits_of(simulation);
  try {
    simulation.run_until(1.0);
    ADD_FAILURE() << "it went through";
  } catch (const SolverError& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find(limit), std::string::npos) << message;
    ASSERT_FALSE(error.failure().parts.empty());
    EXPECT_EQ(error.failure().parts.front(), part);
    EXPECT_NE(message.find(part), std::string::npos) << message;
  }
  EXPECT_EQ(bits_of(simulation), before);
}

TEST(Limits, ASpringBeyondAllStiffnessIsNamed) {
  for (const double stiffness : {1e20, 1e22, 1e30}) {
    for (const FlowMethod method : methods) {
      System system;
      const BodyId mass = add_mass(system);
      system.add(SpringDamper{.from = ground, .to = mass, .stiffness = stiffness, .free_length = 1.0}, "k");
      expect_limit(system, {.method = method}, "step_limit", "spring-damper 'k'");
    }
  }
}

TEST(Limits, ADashpotWithoutDampingEnds) {
  System system;
  const BodyId mass = add_mass(system);
  system.add(
      MaxwellElement{.from = ground, .to = mass, .stiffness = 10.0, .damping = 1e-20, .free_length = 1.0},
      "m");
  for (const FlowMethod method : {FlowMethod::explicit_runge_kutta, FlowMethod::one_step}) {
    expect_limit(system, {.method = method}, "step_limit", "Maxwell element 'm'");
  }
}

TEST(Limits, ANoisyForceEnds) {
  for (const FlowMethod method : methods) {
    System system;
    const BodyId mass = add_mass(system);
    system.add(Noise{mass}, "n");
    Simulation simulation(system, EventDriven{.method = method});
    const auto before = bits_of(simulation);
    EXPECT_THROW(simulation.run_until(1.0), SolverError);
    EXPECT_EQ(bits_of(simulation), before);
  }
}

TEST(Limits, EvaluationsWithoutProgressEnd) {
  // The limit is set below what a step of this method takes.
  const System system = pair_scene();
  Simulation simulation(system, EventDriven{.evaluation_limit = 4});
  const auto before = bits_of(simulation);
  EXPECT_THROWS(SolverError, simulation.run_until(0.1), "more than 4 evaluations", "evaluation_limit",
                "component of");
  EXPECT_EQ(bits_of(simulation), before);
  simulation.switch_to(EventDriven{});
  simulation.run_until(0.1);
  Simulation plain(system, EventDriven{});
  plain.run_until(0.1);
  EXPECT_EQ(simulation.state().q, plain.state().q);
}

// Also where a state is only looked at, before there is a step.
TEST(Limits, EvaluationsOfALookAreCounted) {
  System system;
  const BodyId bar = system.add(RigidBody{.mass = rod(1.0, 1.0)});
  const JointId pin = system.add(Revolute{.from = ground, .to = bar});
  system.add(Gravity{{0.0, -9.81}});
  for (const std::int64_t limit : {1, 2, 3}) {
    Simulation run(system, TimeStepping{});
    const auto look = [&] {
      run.switch_to(EventDriven{.evaluation_limit = limit});
      (void)run.reaction(pin);
      run.run_until(0.1);
    };
    EXPECT_THROWS(SolverError, look(), "evaluations", "evaluation_limit", std::to_string(limit));
    run.switch_to(EventDriven{});
    EXPECT_NO_THROW(run.run_until(0.1));
  }
}

TEST(Limits, OptionsThatCannotBe) {
  EXPECT_MODEL_ERROR(Simulation(pair_scene(), EventDriven{.step_limit = 0.0}), "step_limit", "0", "allowed");
  EXPECT_MODEL_ERROR(Simulation(pair_scene(), EventDriven{.step_limit = std::nan("")}), "step_limit", "nan");
  EXPECT_MODEL_ERROR(Simulation(pair_scene(), EventDriven{.evaluation_limit = 0}), "evaluation_limit", "0",
                     "at least 1");
}

TEST(Limits, TimesThatStepsCannotReachAreRefusedAtOnce) {
  for (const Mode& mode : {Mode(TimeStepping{.step = 1e-3}), Mode(EventDriven{})}) {
    Simulation simulation(pair_scene(), mode);
    const auto before = bits_of(simulation);
    for (const double time : {1e14, 1e20, 1e300}) {
      EXPECT_MODEL_ERROR(simulation.run_until(time), "run_until", "allowed", "rounding of times");
    }
    EXPECT_EQ(bits_of(simulation), before);
    State far = simulation.state();
    far.time = 1e20;
    simulation.set_state(far);
    EXPECT_MODEL_ERROR(simulation.step(), "step", "allowed", "rounding of times");
    EXPECT_MODEL_ERROR(simulation.run_until(1e20 + 1e6), "run_until", "rounding of times");
    EXPECT_EQ(simulation.time(), 1e20);
    far.time = 1.7e9;  // seconds since 1970
    simulation.set_state(far);
    simulation.run_until(1.7e9 + 0.02);
    EXPECT_EQ(simulation.time(), 1.7e9 + 0.02);
  }
  Simulation fine(pair_scene(), TimeStepping{.step = 1e-17});
  EXPECT_MODEL_ERROR(fine.run_until(1.0), "step is 1e-17", "allowed");
  Simulation close(pair_scene(), EventDriven{.interval = 1e-17});
  EXPECT_MODEL_ERROR(close.run_until(1.0), "interval is 1e-17", "allowed");
  // Intervals may be long, the steps of the integrator are not.
  Simulation wide(pair_scene(), EventDriven{.interval = 1e19});
  EXPECT_THROWS(SolverError, wide.run_until(1e20), "rounding of times", "component of");
  EXPECT_EQ(wide.time(), 0.0);
}

TEST(Limits, PeriodicEventsTooShortToBeToldApartAreRefused) {
  for (const Mode& mode : {Mode(TimeStepping{.step = 1e-3}), Mode(EventDriven{})}) {
    Simulation simulation(pair_scene(), mode);
    EXPECT_MODEL_ERROR(simulation.every(1e-20, [](Simulation&) {}), "every", "1e-20", "allowed: at least");
    EXPECT_EQ(simulation.companion().rhythms.size(), 0u);
    simulation.every(1e-10, [](Simulation&) {});
    EXPECT_MODEL_ERROR(simulation.run_until(1e6), "every", "1e-10", "allowed: at least");
    simulation.step();  // here it can
    EXPECT_EQ(simulation.time(), 1e-10);
  }
}

TEST(Limits, ControlledStepsThatMoveNoTimeAreNamed) {
  Simulation simulation(
      pair_scene(),
      TimeStepping{.step = 1e-3, .control = StepControl{.tolerance = 1e-12, .smallest = 1e-12}});
  State far = simulation.state();
  far.time = 1e6;
  simulation.set_state(far);
  auto last = bits_of(simulation);
  simulation.observe([&](const Simulation& now) { last = bits_of(now); });
  // The tolerance asks for steps below the distance of times there, 1e-10 s.
  simulation.switch_to(
      TimeStepping{.step = 1e-3, .control = StepControl{.tolerance = 1e-40, .smallest = 1e-15}});
  EXPECT_THROWS(SolverError, simulation.run_until(1e6 + 1.0), "rounding of time", "control.smallest");
  EXPECT_EQ(bits_of(simulation), last);
}

/// Asks for the end at the n-th question.
StopFunction at_question(std::int64_t n) {
  return [n, asked = std::int64_t{0}]() mutable { return ++asked >= n; };
}

TEST(Cancelling, LeavesTheLastGoodStateAndGoesOnFromThere) {
  for (const Mode& mode :
       {Mode(TimeStepping{.step = 1e-3}),
        Mode(TimeStepping{.step = 1e-3, .iteration = Iteration::linearly_implicit}),
        Mode(TimeStepping{.step = 1e-3, .control = StepControl{}}), Mode(EventDriven{}),
        Mode(EventDriven{.method = FlowMethod::bdf}), Mode(EventDriven{.method = FlowMethod::one_step})}) {
    Simulation plain(pair_scene(), mode);
    plain.run_until(0.7);
    Simulation simulation(pair_scene(), mode);
    auto last = bits_of(simulation);
    simulation.observe([&](const Simulation& now) { last = bits_of(now); });
    Random random(3);
    int cancelled = 0;
    while (simulation.time() < 0.7 && cancelled < 40) {
      simulation.stop_when(at_question(1 + random.below(400)));
      try {
        simulation.run_until(0.7);
      } catch (const Cancelled& end) {
        ++cancelled;
        EXPECT_NE(std::string(end.what()).find("stop_when"), std::string::npos);
      }
      EXPECT_EQ(bits_of(simulation), last);
    }
    EXPECT_GE(cancelled, 5);
    simulation.stop_when({});
    simulation.run_until(0.7);
    if (std::holds_alternative<TimeStepping>(mode)) {
      EXPECT_EQ(bits_of(simulation), bits_of(plain));
      continue;
    }
    // Its integrators start anew each time: the same motion within the tolerance of 40 starts.
    for (std::size_t i = 0; i < plain.state().q.size(); ++i) {
      EXPECT_NEAR(simulation.state().q[i], plain.state().q[i], 1e-7);
    }
  }
}

// A contact that tolerances leave open a little is neither a lift-off nor an impact where a run goes on.
TEST(Cancelling, ContactsThatLastGoOn) {
  Random random(1709);
  int stops = 0;
  for (int repeat = 0; repeat < 40; ++repeat) {
    System system;
    system.add(Gravity{{0.0, -9.81}});
    const double slope = random.uniform(-0.6, 0.6);
    const Vec<2> normal = incline(slope);
    system.add(HalfPlane{.normal = normal},
               Surface{.friction = random.uniform(0.0, 0.5), .normal_restitution = 0.0});
    const double length = random.uniform(0.3, 1.5), angle = random.uniform(0.2, 1.3);
    const BodyId bar = system.add(RigidBody{.mass = rod(random.uniform(0.1, 3.0), length),
                                            .position = (0.5 * length * std::sin(angle) + 0.02) * normal,
                                            .angle = slope + angle,
                                            .velocity = {random.uniform(-1.0, 1.0), -0.3}});
    system.add(Segment{.body = bar, .from = {-0.5 * length, 0.0}, .to = {0.5 * length, 0.0}});
    // Until the bar is about to fall flat: that is an accumulation whose count depends on the last bit.
    Simulation plain(system, EventDriven{});
    Simulation stopped(system, EventDriven{});
    std::int64_t asked = 0, stop_at = 61;
    stopped.stop_when([&] { return ++asked == stop_at; });
    while (stopped.time() < 0.25) {
      try {
        stopped.run_until(0.25);
      } catch (const Cancelled&) {
        stop_at = asked + 300;  // more than an interval takes, or there would be no end
        ++stops;
      }
    }
    plain.run_until(0.25);
    ASSERT_EQ(stopped.events().size(), plain.events().size()) << repeat;
    for (std::size_t i = 0; i < plain.events().size(); ++i) {
      EXPECT_EQ(stopped.events()[i].kind, plain.events()[i].kind) << repeat;
      EXPECT_NEAR(stopped.events()[i].time, plain.events()[i].time, 1e-8) << repeat;
    }
  }
  EXPECT_GE(stops, 80);
}

TEST(Cancelling, IsAskedWithinStepsOfBothModes) {
  // Forces that take many sweeps, and one interval with many steps of the flow.
  System system;
  const BodyId mass = add_mass(system);
  system.add(SpringDamper{.from = ground, .to = mass, .stiffness = 1e5, .free_length = 1.0}, "k");
  for (const Mode& mode : {Mode(TimeStepping{.step = 4e-3}), Mode(EventDriven{.interval = 10.0})}) {
    Simulation simulation(system, mode);
    std::int64_t asked = 0;
    simulation.stop_when([&] {
      ++asked;
      return false;
    });
    simulation.step();
    EXPECT_GT(asked, 5);
    simulation.stop_when(at_question(5));
    const auto before = bits_of(simulation);
    EXPECT_THROW(simulation.step(), Cancelled);
    EXPECT_EQ(bits_of(simulation), before);
  }
}

TEST(Cancelling, WhatTheFunctionThrowsComesOut) {
  for (const Mode& mode : {Mode(TimeStepping{.step = 1e-3}), Mode(EventDriven{})}) {
    Simulation simulation(pair_scene(), mode);
    simulation.stop_when([]() -> bool { throw std::runtime_error("enough"); });
    EXPECT_THROWS(std::runtime_error, simulation.run_until(0.1), "enough");
    EXPECT_EQ(simulation.time(), 0.0);
    simulation.stop_when({});
    simulation.run_until(0.1);
    // From the function itself nothing of the run may be changed.
    simulation.stop_when([&]() -> bool {
      simulation.stop_when({});
      return false;
    });
    EXPECT_MODEL_ERROR(simulation.run_until(0.2), "stop_when was called by", "stop function");
  }
}

TEST(Cancelling, ReachesAnalyses) {
  CrossCheckOptions check;
  check.end = 0.1;
  check.steps = spread_steps(1e-3, 1e-4, 5);
  check.stop_when = at_question(1000);
  EXPECT_THROW((void)cross_check(pair_scene(), check), Cancelled);
  check.stop_when = {};
  check.end = 1e9;
  EXPECT_MODEL_ERROR((void)cross_check(pair_scene(),
                                       [&] {
                                         CrossCheckOptions lost = check;
                                         lost.steps.back() = 1e-9;
                                         return lost;
                                       }()),
                     "a step is", "rounding of the end");
  System hanging;
  hanging.add(Gravity{{0.0, -9.81}});
  const BodyId mass = add_mass(hanging);
  hanging.add(SpringDamper{.from = ground, .to = mass, .stiffness = 100.0, .free_length = 0.5});
  EquilibriumOptions equilibrium;
  equilibrium.stop_when = at_question(3);
  EXPECT_THROW((void)find_equilibrium(hanging, equilibrium), Cancelled);
}

}  // namespace
