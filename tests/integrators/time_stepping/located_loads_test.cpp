// Impacts that are located (TimeStepping::impacts) where loads depend on velocities, and so jump with them:
// by both rules and every iteration. Against the event-driven mode; orders are measured.

#include "tests/analytic/convergence.h"
#include "tests/energy/ledger_check.h"
#include "tests/integrators/event_run.h"
#include "tests/integrators/time_stepping/located_runs.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::add_floor;
using carom_test::distance;
using carom_test::ledger_closes;
using carom_test::run;
using carom_test::tight;

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

TimeStepping located(double step, ForceRule rule = ForceRule::trapezoidal) {
  return {.step = step, .impacts = ImpactTimes::located, .force_rule = rule};
}

/// A particle that bounces in air.
System in_air(double linear, double quadratic) {
  System system;
  add_floor(system, 0.0, 0.7, 0.0);
  const BodyId ball =
      system.add(Particle{.mass = 1.0, .position = {0.0, 0.5}, .velocity = {1.0, 0.0}}, "ball");
  system.add(Drag{.on = ball, .linear = linear, .quadratic = quadratic});
  return system;
}

// Loads jump with velocities, within the step too: whether they are means over it or not, linear or not.
TEST(LocatedLoads, ThatDependOnVelocitiesKeepTheSecondOrder) {
  struct Case {
    const char* name;
    System system;
    ForceRule rule;
  };
  for (const Case& scene : {Case{"air, linear", in_air(2.0, 0.0), ForceRule::trapezoidal},
                            Case{"air, linear", in_air(2.0, 0.0), ForceRule::energy_momentum},
                            Case{"air, quadratic", in_air(0.0, 1.0), ForceRule::trapezoidal},
                            Case{"dashpot", pair(5.0, 0.3), ForceRule::energy_momentum}}) {
    const double end = 0.6;  // behind the first impact
    const State there = run(scene.system, tight(), end);
    const analytic::MeanOrder order = analytic::mean_order(8e-3, 5, 12, [&](double step) {
      return distance(run(scene.system, located(step, scene.rule), end), there);
    });
    const std::string name = std::string(scene.name) + ", " + std::string(to_string(scene.rule));
    EXPECT_GT(order.slope, 1.8) << name << ", deviation " << order.deviation;
    EXPECT_LT(order.slope, 2.4) << name;
    EXPECT_LT(order.errors.back(), 1e-6) << name;  // of h = 0.4 ms; 1e-4 where a jump is missed
  }
}

// Every iteration that is named alone: Newton's method does not see impacts within a step, which ends there
// then.
TEST(LocatedLoads, AreOfSecondOrderByEveryIteration) {
  const System system = pair(5.0, 0.3);
  const State there = run(system, tight(), 0.6);
  for (const Iteration iteration :
       {Iteration::fixed_point, Iteration::anderson, Iteration::linearly_implicit}) {
    const analytic::MeanOrder order = analytic::mean_order(4e-3, 4, 8, [&](double step) {
      TimeStepping options = located(step);
      options.iteration = iteration;
      return distance(run(system, options, 0.6), there);
    });
    EXPECT_GT(order.slope, 1.8) << to_string(iteration) << ", deviation " << order.deviation;
    EXPECT_LT(order.errors.back(), 1e-5) << to_string(iteration);  // 1e-3 where impacts are a step late
  }
}

/// A box that tips on a corner, without friction, and a particle that is hit, on a dashpot.
System box_and_particle() {
  System system;
  add_floor(system, 0.0, 0.0, 0.0);
  const double angle = 0.5, c = std::cos(angle), s = std::sin(angle);
  const BodyId tipping = system.add(RigidBody{.mass = box(1.0, 0.6, 0.4),
                                              .position = {0.3 * c - 0.2 * s, 0.3 * s + 0.2 * c},
                                              .angle = angle,
                                              .spin = 1.0},
                                    "box");
  system.add(Polygon{.body = tipping, .vertices = {{-0.3, -0.2}, {0.3, -0.2}, {0.3, 0.2}, {-0.3, 0.2}}});
  const BodyId struck =
      system.add(Particle{.mass = 0.5, .position = {1.2, 0.3}, .velocity = {0.0, -1.0}}, "low");
  system.add(
      SpringDamper{.from = tipping, .to = struck, .stiffness = 50.0, .damping = 10.0, .free_length = 1.0});
  return system;
}

// A body whose own contact lasts gets all of the impulse that a jump leaves it, though it is not hit itself.
TEST(LocatedLoads, PassMomentumOnToABodyThatIsHeldInAContactThatTurns) {
  const System system = box_and_particle();
  const State there = run(system, tight(), 0.2);
  for (const ForceRule rule : {ForceRule::trapezoidal, ForceRule::energy_momentum}) {
    for (const double step : {2e-3, 5e-4}) {
      const State end = run(system, located(step, rule), 0.2);
      const double momentum = end.velocity(system.body("box"))[0] + 0.5 * end.velocity(system.body("low"))[0];
      EXPECT_NEAR(momentum, 0.0, 1e-14) << to_string(rule) << ", step " << step;
      EXPECT_LT(distance(end, there), 4.0 * step * step) << to_string(rule) << ", step " << step;
    }
  }
}

// A dashpot takes, beyond its mean rate, what its rate varies by within the step; nothing else is lost.
TEST(LocatedLoads, KeepTheAccountOfMeanLoads) {
  for (const double damping : {0.0, 5.0}) {
    Simulation simulation(pair(damping, 0.0), located(2e-3, ForceRule::energy_momentum));
    double before = simulation.energy().flow(EnergyFlow::dashpot);
    for (int i = 0; i < 1000; ++i) {
      simulation.step();
      const double now = simulation.energy().flow(EnergyFlow::dashpot);
      EXPECT_GE(now, before) << i;
      before = now;
    }
    EXPECT_GT(simulation.statistics().impacts, 3);
    EXPECT_TRUE(ledger_closes(simulation.energy()));
    // 1000 steps, each with changes of 1e-12 m in the loads that it iterates, of some hundred newton.
    EXPECT_NEAR(simulation.energy().flow(EnergyFlow::coupling_discretisation), 0.0, 1e-8) << damping;
  }
}

}  // namespace
