// Option project_gaps: bodies stay out of obstacles, and the ledger knows.

#include "tests/energy/ledger_check.h"

#include <carom/carom.h>
#include <carom/contact/detection/detector.h>
#include <carom/core/assembly.h>
#include <carom/core/constraint_set.h>
#include <carom/integrators/run/companion.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::ledger_closes;

/// Rounding of coordinates of a few metres.
constexpr double rounding = 1e-13;

/// The most negative gap of the contacts that took part in the last step.
double deepest(const Simulation& simulation) {
  const Assembly& assembly = simulation.assembly();
  Evaluation evaluation = make_evaluation(assembly);
  const Detector detector(assembly);
  ConstraintSet contacts;
  for (Index component = 0; component < assembly.components().size(); ++component) {
    evaluate_positions(assembly, component, simulation.state().view(), evaluation);
    detector.find(component, simulation.state().view(), evaluation, 0.0, contacts);
  }
  double depth = 0.0;
  for (const Constraint& contact : contacts) {
    for (const ContactRecord& record : simulation.report().contacts) {
      if (record.key == contact.key) depth = std::min(depth, contact.gap);
    }
  }
  return depth;
}

System brick_on_slope() {
  System system;
  system.add(Gravity{{0.0, -9.81}});
  system.add(HalfPlane{.point = {0.0, 0.0}, .normal = {-std::sin(0.1), std::cos(0.1)}},
             Surface{.friction = 0.05, .normal_restitution = 0.3, .tangential_restitution = 0.0});
  const BodyId brick = system.add(RigidBody{.mass = box(1.0, 0.4, 0.2),
                                            .position = {0.0, 0.4},
                                            .angle = 0.3,
                                            .velocity = {1.0, -2.0},
                                            .spin = 1.0});
  system.add(Polygon{.body = brick, .vertices = {{-0.2, -0.1}, {0.2, -0.1}, {0.2, 0.1}, {-0.2, 0.1}}});
  return system;
}

TEST(GapProjection, KeepsABrickOutOfASlope) {
  Simulation with(brick_on_slope(), TimeStepping{.step = 1e-3, .project_gaps = true});
  Simulation without(brick_on_slope(), TimeStepping{.step = 1e-3});
  double worst_with = 0.0, worst_without = 0.0, shift = 0.0;
  for (int i = 0; i < 2000; ++i) {
    with.step();
    without.step();
    worst_with = std::min(worst_with, deepest(with));
    worst_without = std::min(worst_without, deepest(without));
    shift = std::max(shift, with.report().projected);
  }
  EXPECT_LT(worst_without, -1e-4);
  EXPECT_GE(worst_with, -rounding);
  // The deepest it can sink in one step, (3 - e)/2 h v with v <= 3 m/s.
  EXPECT_GT(shift, 0.0);
  EXPECT_LE(shift, 1.35 * 1e-3 * 3.0);
  EXPECT_GT(with.statistics().contact_steps, 500);
}

TEST(GapProjection, IsBookedAsWhatItChangesOfThePotential) {
  Simulation simulation(brick_on_slope(), TimeStepping{.step = 1e-3, .project_gaps = true});
  simulation.run_until(1.0);
  EXPECT_TRUE(ledger_closes(simulation.energy()));
  // Lifted out against gravity: energy came in, a negative loss; nothing of it in other lines.
  EXPECT_LT(simulation.energy().flow(EnergyFlow::projection), 0.0);
  EXPECT_LE(std::abs(simulation.energy().flow(EnergyFlow::coupling_discretisation)),
            1e-12 * simulation.energy().scale());
  Simulation without(brick_on_slope(), TimeStepping{.step = 1e-3});
  without.run_until(1.0);
  EXPECT_EQ(without.energy().flow(EnergyFlow::projection), 0.0);
}

TEST(GapProjection, ARestingBodyStaysInContact) {
  System system;
  system.add(Gravity{{0.0, -10.0}});
  system.add(HalfPlane{.point = {0.0, 0.0}, .normal = {0.0, 1.0}},
             Surface{.friction = 0.5, .normal_restitution = 0.0, .tangential_restitution = 0.0});
  const BodyId dot = system.add(Particle{.mass = 1.0, .position = {0.0, 1e-3}});
  Simulation simulation(std::move(system), TimeStepping{.step = 1e-3, .project_gaps = true});
  simulation.run_until(0.1);
  const std::int64_t before = simulation.statistics().contact_steps;
  simulation.run_until(0.2);
  EXPECT_EQ(simulation.statistics().contact_steps - before, 100);
  EXPECT_LE(std::abs(simulation.state().position(dot)[1]), rounding);
  EXPECT_NEAR(simulation.report().contacts.at(0).impulse[0], 1e-2, 1e-12);
}

TEST(GapProjection, SpringsAreEvaluatedWhereTheBodiesWereMovedTo) {
  // A particle pressed on the ground by a spring: its loads at the start of the next step are those there.
  System system;
  system.add(HalfPlane{.point = {0.0, 0.0}, .normal = {0.0, 1.0}},
             Surface{.friction = 0.0, .normal_restitution = 0.2, .tangential_restitution = 0.0});
  const BodyId dot = system.add(Particle{.mass = 1.0, .position = {0.0, 0.1}, .velocity = {0.0, -1.0}});
  system.add(SpringDamper{.from = {ground, {0.0, 2.0}}, .to = dot, .stiffness = 100.0, .free_length = 2.5});
  for (const ForceRule rule : {ForceRule::trapezoidal, ForceRule::energy_momentum}) {
    Simulation simulation(system, TimeStepping{.step = 1e-3, .force_rule = rule, .project_gaps = true});
    simulation.run_until(1.0);
    EXPECT_TRUE(ledger_closes(simulation.energy()));
    if (rule == ForceRule::trapezoidal) {
      EXPECT_NEAR(simulation.companion().loads.total[1], -100.0 * (2.5 - 2.0), 1e-9);
    }
  }
}

TEST(GapProjection, BetweenTwoWallsThatOverlapNothingHelps) {
  System system;
  const Surface surface{.friction = 0.0, .normal_restitution = 0.0, .tangential_restitution = 0.0};
  system.add(HalfPlane{.point = {0.0, 0.0}, .normal = {0.0, 1.0}}, surface);
  system.add(HalfPlane{.point = {0.0, -0.1}, .normal = {0.0, -1.0}}, surface);
  system.add(Particle{.mass = 1.0, .position = {0.0, -0.05}}, "wedged");
  Simulation simulation(std::move(system), TimeStepping{.step = 1e-3, .project_gaps = true});
  const double before = simulation.state().q[1];
  try {
    simulation.step();
    FAIL();
  } catch (const SolverError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("project_gaps"), std::string::npos) << text;
    EXPECT_NE(text.find("wedged"), std::string::npos) << text;
  }
  EXPECT_EQ(simulation.state().q[1], before);
}

}  // namespace
