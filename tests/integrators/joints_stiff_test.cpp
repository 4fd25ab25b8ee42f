// Time stepping of mechanisms where it is hard: stiff couplings, gaps projected, positions in line.

#include "tests/analytic/convergence.h"
#include "tests/energy/ledger_check.h"
#include "tests/integrators/joint_run.h"
#include "tests/integrators/throws.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace {

using namespace joint_scenes;
using carom_test::ledger_closes;
using carom_test::reference_data;

/// Three rods from the origin, the tip of the last on a spring to the ground.
Scene held_chain(double stiffness, double damping) {
  Scene scene = rod_pendulum(3);
  scene.system.add(SpringDamper{.from = {ground, {3.0, 0.5}},
                                .to = {scene.bodies[2], {0.5, 0.0}},
                                .stiffness = stiffness,
                                .damping = damping,
                                .free_length = 0.5},
                   "spring");
  return scene;
}

std::vector<double> angles(const Simulation& simulation, const Scene& scene) {
  std::vector<double> numbers;
  for (const BodyId body : scene.bodies) numbers.push_back(simulation.state().angle(body));
  return numbers;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

std::vector<double> run(const Scene& scene, const TimeStepping& options, double time) {
  Simulation simulation(scene.system, options);
  JointCheck check(simulation);
  simulation.run_until(time);
  EXPECT_LE(check.gap, gap_limit) << "step " << options.step;
  // Under the other rule velocities follow positions (energy_momentum_joints_test.cpp).
  if (options.force_rule == ForceRule::trapezoidal) {
    EXPECT_LE(check.speed, speed_limit) << "step " << options.step;
  }
  EXPECT_TRUE(ledger_closes(simulation.energy())) << "step " << options.step;
  return angles(simulation, scene);
}

TEST(JointsTimeStepping, StiffSpringsDoNotLoosenTheJoints) {
  // Sweeps contract by some 0.5 at the stiffest: a change below the tolerance leaves much to do.
  for (const double stiffness : {1e4, 1e5, 4e5}) run(held_chain(stiffness, 1.0), {.step = 1e-3}, 1.0);
}

TEST(JointsTimeStepping, LinearlyImplicitIsTheSameStep) {
  const Scene scene = held_chain(1e4, 1.0);
  for (const ForceRule rule : {ForceRule::trapezoidal, ForceRule::energy_momentum}) {
    const auto plain = run(scene, {.step = 1e-3, .force_rule = rule}, 1.0);
    const auto implicit =
        run(scene, {.step = 1e-3, .force_rule = rule, .iteration = Iteration::linearly_implicit}, 1.0);
    // Both end within the tolerance of 1e-12 m in each of 1,000 steps.
    EXPECT_LE(largest_difference(plain, implicit), 1e-9);
  }
}

TEST(JointsTimeStepping, LinearlyImplicitWhereSweepsDoNotContract) {
  // h^2 k/m of 10^4: a spring so stiff is a rod, and as accurate as one.
  const Scene scene = held_chain(1e10, 0.0);
  Scene rigid = rod_pendulum(3);
  rigid.system.add(Rod{.from = {ground, {3.0, 0.5}}, .to = {rigid.bodies[2], {0.5, 0.0}}});
  const auto reference = run(rigid, {.step = 5e-5}, 1.0);
  std::vector<double> steps, errors;
  for (const double step : {2e-3, 1e-3, 5e-4}) {
    Simulation refusing(scene.system, TimeStepping{.step = step, .iteration = Iteration::fixed_point});
    EXPECT_THROWS(SolverError, refusing.step(), "fixed-point", "does not contract", "spring",
                  "as would the linearly implicit");
    const auto implicit = run(scene, {.step = step, .iteration = Iteration::linearly_implicit}, 1.0);
    steps.push_back(step);
    errors.push_back(largest_difference(implicit, reference));
  }
  const double slope = analytic::slope(steps, errors);
  EXPECT_GT(slope, 1.9);
  EXPECT_LT(slope, 2.1);
}

TEST(JointsTimeStepping, LinearlyImplicitWithRedundantJoints) {
  // A third parallel link follows from the other two; its spring to the ground is stiff.
  Scene scene = windows(1);
  System& system = scene.system;
  const BodyId third = system.add(RigidBody{
      .mass = rod(1.0, 1.0), .position = {0.5, 0.5}, .angle = quarter, .velocity = {0.5, 0.0}, .spin = -1.0});
  system.add(Revolute{.from = {ground, {0.5, 0.0}}, .to = {third, {-0.5, 0.0}}});
  system.add(Revolute{.from = {third, {0.5, 0.0}}, .to = scene.bodies[2]}, "third pin");
  system.add(SpringDamper{.from = {ground, {-1.0, 1.0}},
                          .to = scene.bodies[2],
                          .stiffness = 1e9,
                          .damping = 1e3,
                          .free_length = 1.5},
             "spring");
  TimeStepping options{.step = 1e-3, .iteration = Iteration::linearly_implicit};
  Simulation simulation(system, options);
  EXPECT_FALSE(simulation.mobility().redundant.empty());
  JointCheck check(simulation);
  simulation.run_until(0.5);
  EXPECT_LE(check.gap, gap_limit);
  EXPECT_LE(check.speed, speed_limit);
  EXPECT_TRUE(ledger_closes(simulation.energy()));
}

/// A double pendulum of discs that falls on a plane, its far end on a spring.
Scene falling(double stiffness) {
  Scene scene = rod_pendulum(2);
  System& system = scene.system;
  const BodyId bob = system.add(RigidBody{.mass = disc(0.5, 0.1), .position = {2.0, 0.0}}, "bob");
  system.add(Disc{.body = bob, .radius = 0.1});
  system.add(Revolute{.from = {scene.bodies[1], {0.5, 0.0}}, .to = bob});
  system.add(HalfPlane{.point = {0.0, -0.8}, .normal = {0.0, 1.0}},
             Surface{.friction = 0.4, .normal_restitution = 0.3}, "floor");
  system.add(SpringDamper{.from = {ground, {2.0, 1.0}},
                          .to = bob,
                          .stiffness = stiffness,
                          .damping = 0.02 * std::sqrt(stiffness),
                          .free_length = 0.5},
             "spring");
  scene.bodies.push_back(bob);
  return scene;
}

TEST(JointsTimeStepping, LinearlyImplicitWithContact) {
  const Scene scene = falling(10.0);
  const TimeStepping plain{.step = 1e-3};
  TimeStepping implicit = plain;
  implicit.iteration = Iteration::linearly_implicit;
  EXPECT_LE(largest_difference(run(scene, plain, 2.0), run(scene, implicit, 2.0)), 1e-9);
}

/// Gaps that projection leaves: the deepest at the ends of steps.
TEST(JointsTimeStepping, ProjectsGapsAlongTheJoints) {
  const Scene scene = falling(10.0);
  for (const Iteration iteration : {Iteration::fixed_point, Iteration::linearly_implicit}) {
    Simulation simulation(scene.system,
                          TimeStepping{.step = 1e-3, .iteration = iteration, .project_gaps = true});
    JointCheck check(simulation);
    double lowest = 1.0, shift = 0.0;
    simulation.observe([&](const Simulation& now) {
      if (now.report().contacts.empty()) return;
      lowest = std::min(lowest, now.state().position(scene.bodies[2])[1] - 0.1 + 0.8);
      shift = std::max(shift, now.report().projected);
    });
    simulation.run_until(2.0);
    EXPECT_LE(check.gap, gap_limit);
    EXPECT_LE(check.speed, speed_limit);
    // Rounding of the coordinates, of angles of several turns too.
    EXPECT_GE(lowest, -1e-13);
    EXPECT_GT(shift, 1e-5);  // without it: 3 mm deep
    EXPECT_NE(simulation.energy().flow(EnergyFlow::projection), 0.0);
    EXPECT_TRUE(ledger_closes(simulation.energy()));
  }
}

/// A link from the origin and a disc pinned to its end, in line, both pulled taut by a spring along that
/// line; the disc turns a little.
Scene taut_pair(double link_mass, double stretched) {
  constexpr double mass = 4.0,
                   stiffness = 0.5625e6 * mass;  // h^2 k/m = 2.25 at 2 ms: sweeps of loads contract
  Scene scene;
  scene.system.add(Gravity{{0.0, -g}});
  const BodyId link = scene.system.add(RigidBody{.mass = rod(link_mass, 0.1), .position = {0.05, 0.0}});
  const BodyId body =
      scene.system.add(RigidBody{.mass = disc(mass, 0.1), .position = {0.2, 0.0}, .spin = 1.0});
  scene.system.add(Revolute{.from = ground, .to = {link, {-0.05, 0.0}}});
  scene.system.add(Revolute{.from = {link, {0.05, 0.0}}, .to = {body, {-0.1, 0.0}}});
  scene.system.add(SpringDamper{
      .from = {ground, {1.2, 0.0}}, .to = body, .stiffness = stiffness, .free_length = 1.0 - stretched});
  scene.bodies = {link, body};
  return scene;
}

// The pull F turns with the link: a stiffness F/l of the reactions, by which sweeps over their rows do not
// contract, (w h/2)^2 > 1, although masses are no farther apart than 1 to 20. Nothing touches, so that
// Newton's method knows how rows turn.
TEST(JointsTimeStepping, APullThatTurnsWithItsLinkEndsNoStep) {
  for (const double link_mass : {1.0, 0.5, 0.2}) {
    for (const double stretched : {0.005, 0.01, 0.02}) {
      const Scene scene = taut_pair(link_mass, stretched);
      const std::string what = std::to_string(link_mass) + " kg, " + std::to_string(stretched) + " m";
      Simulation simulation(scene.system, TimeStepping{.step = 2e-3}),
          by_newton(scene.system, TimeStepping{.step = 2e-3, .iteration = Iteration::linearly_implicit});
      JointCheck check(simulation);
      const double begin = simulation.energy().total();
      ASSERT_NO_THROW(simulation.run_until(0.5)) << what;
      ASSERT_NO_THROW(by_newton.run_until(0.5)) << what;
      EXPECT_GE(simulation.statistics().fallbacks, 1) << what;  // else the scene tests nothing
      EXPECT_NEAR(simulation.energy().total(), begin, 1e-7 * begin) << what;
      EXPECT_TRUE(ledger_closes(simulation.energy())) << what;
      EXPECT_LE(check.gap, gap_limit) << what;
      EXPECT_LE(check.speed, speed_limit) << what;
      const std::vector<double> turned = angles(simulation, scene);
      // It stays taut: F l angle^2/2 is at most what the spin and the weight give, 0.1 J.
      for (const double angle : turned) EXPECT_LE(std::abs(angle), 0.02) << what;
      EXPECT_LE(largest_difference(turned, angles(by_newton, scene)), 1e-8) << what;
    }
  }
}

// Ten passages through positions where rows depend on each other and the motion could branch. Steps that end
// there magnify rounding, and those that have it halfway are of first order: between them, the error is one
// of second order at most.
void pass_positions_in_line(int number, const char* problem, const std::vector<double>& steps,
                            double error_at_1_ms) {
  const Scene scene = windows(number);
  const auto data = reference_data("smooth_planar.json").at(problem).at("reference");
  for (const double step : steps) {
    Simulation simulation(scene.system, TimeStepping{.step = step});
    JointCheck check(simulation);
    simulation.run_until(10.0);
    EXPECT_LE(check.gap, gap_limit) << step;
    EXPECT_LE(check.speed, speed_limit) << step;
    EXPECT_TRUE(ledger_closes(simulation.energy())) << step;
    const double phi = data.at("10").at("phi").get<double>();
    const double allowed = error_at_1_ms * std::pow(step / 1e-3, 2);
    for (std::size_t i = 0; i <= static_cast<std::size_t>(number); ++i) {
      // On another branch uprights would part.
      EXPECT_NEAR(quarter - simulation.state().angle(scene.bodies[i]), phi, allowed) << step;
    }
    carom_test::note("step", step);
    carom_test::note("speed", check.speed);
    carom_test::note("phi", quarter - simulation.state().angle(scene.bodies[0]) - phi);
  }
}
TEST(JointsTimeStepping, TwoWindowsPassTheirPositionsInLine) {
  pass_positions_in_line(2, "A02_double_fourbar_N2", {4e-3, 2e-3, 1e-3, 5e-4}, 1e-3);
}
TEST(JointsTimeSteppingLong, FortyWindowsPassTheirPositionsInLine) {
  pass_positions_in_line(40, "A02_fourbar_N40", {4e-3, 2e-3, 1e-3}, 1e-3);
}

}  // namespace
