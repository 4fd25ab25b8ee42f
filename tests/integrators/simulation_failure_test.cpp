// A failure in a run is named, and leaves it at its last good state.

#include "tests/energy/ledger_check.h"
#include "tests/integrators/contrary.h"
#include "tests/integrators/pair_scene.h"
#include "tests/integrators/same_run.h"
#include "tests/integrators/throws.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::bits_of;
using carom_test::Contrary;
using carom_test::ledger_closes;
using carom_test::pair_scene;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// A spring that stiffens with time.
struct Stiffening {
  static constexpr Role role = Role::force;
  static constexpr int dimension = 2;
  static constexpr std::string_view label = "stiffening spring";
  BodyId body;
  std::vector<BodyId> bodies() const { return {body}; }
  void loads(const ElementView<2>& at, ElementLoads<2>& out) const {
    out.external(body, -1e8 * at.time() * at.time() * at.position(body));
  }
};

/// A force that is no number from 0.5 s on.
struct Broken {
  static constexpr Role role = Role::force;
  static constexpr int dimension = 2;
  BodyId body;
  std::vector<BodyId> bodies() const { return {body}; }
  void loads(const ElementView<2>& at, ElementLoads<2>& out) const {
    out.conservative(body, Vec<2>(std::sqrt(0.25 - at.time() * at.time()), 0.0));
  }
};

/// A potential that is no number from 0.5 s on, of loads that are.
struct Bottomless {
  static constexpr Role role = Role::force;
  static constexpr int dimension = 2;
  BodyId body;
  std::vector<BodyId> bodies() const { return {body}; }
  void loads(const ElementView<2>& at, ElementLoads<2>& out) const {
    out.conservative(body, -at.position(body));
  }
  double potential(const ElementView<2>& at) const { return at.time() > 0.5 ? nan : 0.0; }
};

/// An element that throws from 0.1 s on.
struct Thrower {
  static constexpr Role role = Role::force;
  static constexpr int dimension = 2;
  BodyId body;
  std::vector<BodyId> bodies() const { return {body}; }
  void loads(const ElementView<2>& at, ElementLoads<2>&) const {
    if (at.time() > 0.1) throw std::runtime_error("out of range");
  }
};

TEST(SimulationFailure, TooStiffASpringIsNamedWithAStepThatContracts) {
  System system = pair_scene();
  const BodyId lower = system.body("lower"), upper = system.body("upper");
  system.add(SpringDamper{.from = lower, .to = upper, .stiffness = 4e7, .free_length = 1.9}, "stiff");
  Simulation simulation(std::move(system), TimeStepping{.step = 1e-3, .iteration = Iteration::fixed_point});
  const auto before = bits_of(simulation);
  double suggested = 0.0;
  try {
    simulation.step();
    FAIL() << "nothing was thrown";
  } catch (const SolverError& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("spring-damper 'stiff'"), std::string::npos) << message;
    EXPECT_NE(message.find("does not contract"), std::string::npos) << message;
    EXPECT_EQ(error.failure().time, 0.0);
    EXPECT_EQ(error.failure().step, 1e-3);
    ASSERT_EQ(error.failure().parts.size(), 1u);
    EXPECT_EQ(error.failure().parts[0], "spring-damper 'stiff'");
    suggested = error.failure().suggested_step;
    EXPECT_NE(message.find(to_text(suggested)), std::string::npos) << message;
  }
  EXPECT_EQ(bits_of(simulation), before);
  ASSERT_GT(suggested, 0.0);
  EXPECT_LE(suggested, 0.5e-3);
  // With that step it contracts, also through the impacts, and never badly.
  simulation.switch_to(TimeStepping{.step = suggested, .iteration = Iteration::fixed_point});
  simulation.run_until(0.5);
  EXPECT_GT(simulation.statistics().impacts, 0);
  EXPECT_LT(simulation.statistics().largest_contraction, 0.75);
  EXPECT_TRUE(ledger_closes(simulation.energy()));
}

TEST(SimulationFailure, TooStrongADashpotToo) {
  System system;
  const BodyId a = system.add(Particle{.mass = 0.1, .velocity = {1.0, 0.0}});
  system.add(SpringDamper{.from = ground, .to = {a}, .stiffness = 1.0, .damping = 1e3, .free_length = 0.0},
             "damper");
  State state;
  Simulation simulation(std::move(system), TimeStepping{.step = 1e-2, .iteration = Iteration::fixed_point});
  state = simulation.state();
  state.q = {1.0, 0.0};
  simulation.set_state(state);
  const auto before = bits_of(simulation);
  try {
    simulation.step();
    FAIL() << "nothing was thrown";
  } catch (const SolverError& error) {
    EXPECT_EQ(error.failure().parts.at(0), "spring-damper 'damper'");
    EXPECT_EQ(bits_of(simulation), before);
    simulation.switch_to(TimeStepping{.step = error.failure().suggested_step});
  }
  simulation.run_until(0.01);
  EXPECT_TRUE(ledger_closes(simulation.energy()));
}

TEST(SimulationFailure, MidRunLeavesTheLastGoodState) {
  // The spring of a user stiffens with time until a step fails; the run goes on with a smaller one.
  System system = pair_scene();
  const BodyId far = system.add(Particle{.mass = 1.0, .position = {1.0, 50.0}, .contact = false});
  system.add(Stiffening{far});
  Simulation simulation(std::move(system), TimeStepping{.step = 1e-3, .iteration = Iteration::fixed_point});
  State last = simulation.state();
  auto last_bits = bits_of(simulation);
  simulation.observe([&](const Simulation& now) { last_bits = bits_of(now); });
  EXPECT_THROWS(SolverError, simulation.run_until(1.0), "stiffening spring",
                "t = " + to_text(simulation.time()));
  EXPECT_GT(simulation.time(), 0.05);
  EXPECT_EQ(bits_of(simulation), last_bits);
  // Again: the same failure from the same state.
  EXPECT_THROWS(SolverError, simulation.step(), "stiffening spring");
  EXPECT_EQ(bits_of(simulation), last_bits);
  const double failed_at = simulation.time();
  simulation.switch_to(TimeStepping{.step = 1e-5});
  simulation.run_until(failed_at + 0.01);
  EXPECT_TRUE(ledger_closes(simulation.energy()));
}

void expect_named_at_once(System system, const std::string& name) {
  Simulation simulation(std::move(system), TimeStepping{.step = 1e-3});
  auto last = bits_of(simulation);
  simulation.observe([&](const Simulation& now) { last = bits_of(now); });
  EXPECT_THROWS(SolverError, simulation.run_until(1.0), name, "not finite");
  EXPECT_EQ(bits_of(simulation), last);
  EXPECT_NEAR(simulation.time(), 0.5, 2e-3);
  EXPECT_TRUE(ledger_closes(simulation.energy()));
}

TEST(SimulationFailure, AForceThatIsNoNumberIsNamed) {
  for (const double bad : {nan, std::numeric_limits<double>::infinity()}) {
    System system = pair_scene();
    system.add(AppliedForce{.on = system.body("lower"),
                            .force = [bad](double t) { return Vec<2>(0.0, t > 0.5 ? bad : 0.0); }},
               "broken");
    expect_named_at_once(std::move(system), "applied force 'broken'");
  }
}

TEST(SimulationFailure, AForceThatIsNoNumberIsNamedOnABodyInContactToo) {
  System system;
  system.add(Gravity{{0.0, -9.81}});
  system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = 0.5, .normal_restitution = 0.0});
  const BodyId body = system.add(RigidBody{.mass = box(1.0, 1.0, 1.0), .position = {0.0, 0.5 - 1e-9}});
  system.add(Polygon{.body = body, .vertices = {{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}}});
  system.add(AppliedTorque{.on = body, .torque = [](double t) { return t > 0.5 ? nan : 0.0; }}, "motor");
  expect_named_at_once(std::move(system), "applied torque 'motor'");
}

TEST(SimulationFailure, AUsersElementThatIsNoNumberIsNamed) {
  System system = pair_scene();
  system.add(Broken{system.body("upper")}, "root");
  expect_named_at_once(std::move(system), "force element 'root'");
}

TEST(SimulationFailure, APotentialThatIsNoNumberIsNamedAndNotBooked) {
  System system;
  system.add(Bottomless{system.add(Particle{.mass = 1.0, .position = {1.0, 0.0}})}, "well");
  Simulation simulation(std::move(system), TimeStepping{.step = 1e-3});
  simulation.run_until(0.5);
  const auto before = bits_of(simulation);
  EXPECT_THROWS(SolverError, simulation.step(), "potential of force element 'well'", "not finite");
  EXPECT_EQ(bits_of(simulation), before);
}

TEST(SimulationFailure, AnElementThatThrowsChangesNothing) {
  System system = pair_scene();
  system.add(Thrower{system.body("upper")});
  Simulation simulation(std::move(system), TimeStepping{.step = 1e-3});
  auto last = bits_of(simulation);
  simulation.observe([&](const Simulation& now) { last = bits_of(now); });
  EXPECT_THROWS(std::runtime_error, simulation.run_until(1.0), "out of range");
  EXPECT_EQ(bits_of(simulation), last);
  EXPECT_NEAR(simulation.time(), 0.1, 2e-3);
}

TEST(SimulationFailure, AForceThatJumpsIsNotBlamedOnTheStep) {
  // Pushed down while it leaves, up while it does not: no fixed point. Derivatives cannot show that; the
  // message says so, and which contact changes between modes, instead of promising a step.
  System system;
  system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = 0.5, .normal_restitution = 0.0}, "floor");
  const BodyId body = system.add(Particle{.mass = 1.0}, "ball");
  system.add(Contrary{body}, "contrary");
  Simulation simulation(std::move(system), TimeStepping{.step = 1e-3});
  const auto before = bits_of(simulation);
  EXPECT_THROWS(SolverError, simulation.step(), "does not contract", "a force jumps",
                "particle 'ball' on half-plane 'floor'");
  EXPECT_EQ(bits_of(simulation), before);
}

}  // namespace
