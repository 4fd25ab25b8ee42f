// Joints in the time-stepping mode: order two, constraints obeyed at the end of every step, energy accounted
// for.

#include "tests/analytic/convergence.h"
#include "tests/energy/ledger_check.h"
#include "tests/integrators/joint_scenes.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace {

using namespace joint_scenes;
using carom_test::ledger_closes;
using carom_test::reference_data;

constexpr double gap_limit = 1e-10, speed_limit = 1e-9;  // [m, rad], [m/s, rad/s]

using Read = std::function<std::vector<double>(const State&, const std::vector<BodyId>&)>;

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

/// Runs a scene with steps h, h/2, ...; each run must obey its joints and close its ledger. Under the rule
/// energy_momentum velocities follow positions: `speeds` is by how much joints part at most [m/s].
struct Refined {
  std::vector<double> steps, errors, speeds;
  [[nodiscard]] double slope() const { return analytic::slope(steps, errors); }
};
Refined refine(const Scene& scene, double time, double step, int runs, const Read& read,
               const std::vector<double>& reference, TimeStepping options = {}) {
  Refined result;
  for (int run = 0; run < runs; ++run, step *= 0.5) {
    options.step = step;
    Simulation simulation(scene.system, options);
    JointCheck check(simulation);
    simulation.run_until(time);
    EXPECT_LE(check.gap, gap_limit) << "step " << step;
    if (options.force_rule == ForceRule::trapezoidal) {
      EXPECT_LE(check.speed, speed_limit) << "step " << step;
    }
    result.speeds.push_back(check.speed);
    EXPECT_TRUE(ledger_closes(simulation.energy())) << "step " << step;
    result.steps.push_back(step);
    result.errors.push_back(largest_difference(read(simulation.state(), scene.bodies), reference));
  }
  return result;
}

/// Angles, then spins, of all bodies.
std::vector<double> angles(const State& state, const std::vector<BodyId>& bodies) {
  std::vector<double> numbers;
  for (const BodyId body : bodies) numbers.push_back(state.angle(body));
  for (const BodyId body : bodies) numbers.push_back(state.spin(body));
  return numbers;
}

/// The reference of a chain of rods counts angles from the vertical.
std::vector<double> chain_reference(const char* problem, const char* time) {
  const auto at = reference_data("smooth_planar.json").at(problem).at("reference").at(time);
  std::vector<double> numbers;
  for (const auto& angle : at.at("theta")) numbers.push_back(angle.get<double>() - quarter);
  for (const auto& spin : at.at("omega")) numbers.push_back(spin.get<double>());
  return numbers;
}

TEST(JointsTimeStepping, ParticleOnARodOrderTwo) {
  const auto data = reference_data("smooth_planar.json").at("A01_simple_pendulum").at("reference");
  const Read read = [](const State& state, const std::vector<BodyId>& bodies) {
    const auto x = state.position(bodies[0]), v = state.velocity(bodies[0]);
    return std::vector<double>{x[0], x[1], v[0], v[1]};
  };
  for (const char* const time : {"1", "10"}) {
    const auto& at = data.at(time);
    std::vector<double> reference;
    for (const char* const name : {"x", "y", "vx", "vy"}) reference.push_back(at.at(name).get<double>());
    const Refined run = refine(particle_pendulum(), std::stod(time), 4e-3, 4, read, reference);
    EXPECT_NEAR(run.slope(), 2.0, 0.05) << "t = " << time;
  }
}

TEST(JointsTimeStepping, TensionOfARodIsTheMeanForceOfItsImpulse) {
  // 3 m g cos(theta) at angle theta from the vertical, from rest at the level. The step is centred on the
  // time.
  const double step = 1e-3;
  Scene scene = particle_pendulum();
  Simulation simulation(scene.system, TimeStepping{.step = step});
  simulation.run_until(1.0);
  const auto before = simulation.state().position(scene.bodies[0]);
  const Vec<2> start(before[0], before[1]);
  const StepReport& report = simulation.step();
  const auto after = simulation.state().position(scene.bodies[0]);
  ASSERT_EQ(report.joint_impulses.size(), 1U);
  EXPECT_EQ(report.joint_impulses[0].joint, scene.system.joint("rod"));
  const auto& force = report.joint_impulses[0].impulse.force;
  const double pull = std::hypot(force[0], force[1]) / report.step;
  EXPECT_NEAR(pull, 3.0 * g * -0.5 * (start[1] + after[1]), 1e-4);
  EXPECT_LT(force[0] * after[0], 0.0);  // towards the pin
}

TEST(JointsTimeStepping, RodPinnedToGroundOrderTwo) {
  // A rod of 1 m is a simple pendulum of 2/3 m: its times are those of 1 m times sqrt(2/3).
  const auto at = reference_data("smooth_planar.json").at("A01_simple_pendulum").at("reference").at("1");
  const double scale = std::sqrt(2.0 / 3.0);
  const std::vector<double> reference = {at.at("theta").get<double>() - quarter,
                                         at.at("thetadot").get<double>() / scale};
  Refined result;
  for (int steps = 200; steps <= 1600; steps *= 2) {
    const Refined run = refine(rod_pendulum(1), scale, scale / steps, 1, angles, reference);
    result.steps.push_back(run.steps[0]);
    result.errors.push_back(run.errors[0]);
  }
  EXPECT_NEAR(result.slope(), 2.0, 0.05);
}

TEST(JointsTimeStepping, DoublePendulumOrderTwo) {
  for (const char* const time : {"0.5", "1"}) {
    const Refined run = refine(rod_pendulum(2), std::stod(time), 2e-3, 4, angles,
                               chain_reference("double_pendulum_rods", time));
    EXPECT_NEAR(run.slope(), 2.0, 0.05) << "t = " << time;
  }
}

TEST(JointsTimeStepping, DoublePendulumUnderTheOtherRuleAndIteration) {
  const std::vector<double> reference = chain_reference("double_pendulum_rods", "1");
  const Refined rule = refine(rod_pendulum(2), 1.0, 2e-3, 4, angles, reference,
                              TimeStepping{.force_rule = ForceRule::energy_momentum});
  EXPECT_NEAR(rule.slope(), 2.0, 0.05);
  EXPECT_NEAR(analytic::slope(rule.steps, rule.speeds), 2.0, 0.05);
  const Refined mixed = refine(rod_pendulum(2), 1.0, 2e-3, 4, angles, reference,
                               TimeStepping{.iteration = Iteration::anderson});
  EXPECT_NEAR(mixed.slope(), 2.0, 0.05);
}

TEST(JointsTimeStepping, TenLinksOrderTwo) {
  const Refined run =
      refine(rod_pendulum(10), 0.5, 2e-3, 4, angles, chain_reference("ten_link_pendulum_rods", "0.5"));
  EXPECT_NEAR(run.slope(), 2.0, 0.05);
}

TEST(JointsTimeStepping, SliderCrankOrderTwo) {
  const auto data = reference_data("smooth_planar.json").at("slider_crank").at("reference");
  const Read read = [](const State& state, const std::vector<BodyId>& bodies) {
    return std::vector<double>{state.angle(bodies[0]),       state.spin(bodies[0]),
                               state.angle(bodies[1]),       state.spin(bodies[1]),
                               state.position(bodies[2])[0], state.velocity(bodies[2])[0]};
  };
  for (const char* const time : {"0.01", "0.05", "0.1"}) {
    std::vector<double> reference;
    for (const char* const name :
         {"crank_angle", "crank_speed", "rod_angle", "rod_speed", "slider_x", "slider_v"})
      reference.push_back(data.at(time).at(name).get<double>());
    const Refined run = refine(slider_crank(), std::stod(time), 5e-5, 3, read, reference);
    EXPECT_NEAR(run.slope(), 2.0, 0.05) << "t = " << time;
  }
}

TEST(JointsTimeStepping, SqueezingMechanismOrderTwo) {
  const Read read = [](const State& state, const std::vector<BodyId>& bodies) {
    std::array<double, 7> angle{};
    for (std::size_t i = 0; i < 7; ++i) angle[i] = state.angle(bodies[i]);
    return relative(angle);
  };
  const auto data = reference_data("andrews.json").at("recomputed");
  for (const char* const time : {"0.01", "0.03"}) {
    const auto reference = data.at(time).at("q").get<std::vector<double>>();
    const Refined run = refine(squeezing_mechanism(), std::stod(time), 1e-5, 3, read, reference);
    EXPECT_NEAR(run.slope(), 2.0, 0.05) << "t = " << time;
  }
}

}  // namespace
