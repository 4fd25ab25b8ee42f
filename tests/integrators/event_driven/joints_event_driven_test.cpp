// Joints in the event-driven mode: mechanisms against references, joints kept closed, energy accounted for.

#include "tests/integrators/joint_run.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

namespace {

using namespace joint_scenes;
using carom_test::reference_data;

// Errors are some hundred tolerances of a step of 1e-12, grown by the motion, unless said.

TEST(JointsEventDriven, ParticleOnARod) {
  const Scene scene = particle_pendulum();
  const auto data = reference_data("smooth_planar.json").at("A01_simple_pendulum").at("reference");
  WatchedRun run(scene);
  double drift = 0.0;
  run.simulation.observe(
      [&](const Simulation& now) { drift = std::max(drift, std::abs(now.energy().total())); });
  for (int t = 1; t <= 10; ++t) {
    run.simulation.run_until(t);
    const auto& at = data.at(std::to_string(t));
    const State& state = run.simulation.state();
    const auto x = state.position(scene.bodies[0]), v = state.velocity(scene.bodies[0]);
    carom_test::Worst worst;
    worst(x[0], at.at("x").get<double>());
    worst(x[1], at.at("y").get<double>());
    worst(v[0], at.at("vx").get<double>());
    worst(v[1], at.at("vy").get<double>());
    const auto& pull = run.simulation.reaction(scene.system.joint("rod")).force;
    worst(std::hypot(pull[0], pull[1]), at.at("rod_tension").get<double>(), 3.0 * g);
    EXPECT_LE(pull[0] * x[0] + pull[1] * x[1], 0.0);  // towards the pin
    EXPECT_LE(worst.value(), 5e-11 * t) << "t = " << t;
    carom_test::note("error", worst.value());
  }
  EXPECT_LE(drift, 1e-9);  // of 9.81 J
  carom_test::note("drift", drift);
}

void chain(int links, const char* problem, const std::vector<const char*>& times, double tolerance) {
  const Scene scene = rod_pendulum(links);
  const auto data = reference_data("smooth_planar.json").at(problem).at("reference");
  WatchedRun run(scene);
  for (const char* const time : times) {
    run.simulation.run_until(std::stod(time));
    const auto& at = data.at(time);
    carom_test::Worst angles, spins;
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
      angles(run.simulation.state().angle(scene.bodies[i]), at.at("theta")[i].get<double>() - quarter);
      spins(run.simulation.state().spin(scene.bodies[i]), at.at("omega")[i].get<double>());
    }
    EXPECT_LE(angles.value(), tolerance) << "t = " << time;
    EXPECT_LE(spins.value(), 10.0 * tolerance) << "t = " << time;
    carom_test::note("angle", angles.value());
    carom_test::note("spin", spins.value());
  }
}
TEST(JointsEventDriven, DoublePendulum) { chain(2, "double_pendulum_rods", {"0.5", "1", "2", "3"}, 1e-10); }
TEST(JointsEventDriven, TenLinks) { chain(10, "ten_link_pendulum_rods", {"0.5", "1", "1.5", "2"}, 1e-10); }

TEST(JointsEventDriven, SliderCrank) {
  const Scene scene = slider_crank();
  const auto data = reference_data("smooth_planar.json").at("slider_crank").at("reference");
  EventDriven options = fine();
  options.interval = 1e-3;
  WatchedRun run(scene, options);
  for (const char* const time : {"0.01", "0.05", "0.1"}) {
    run.simulation.run_until(std::stod(time));
    const auto number = [&](const char* name) { return data.at(time).at(name).get<double>(); };
    const State& state = run.simulation.state();
    carom_test::Worst positions, speeds;
    positions(state.angle(scene.bodies[0]), number("crank_angle"));
    positions(state.angle(scene.bodies[1]), number("rod_angle"));
    positions(state.position(scene.bodies[2])[0], number("slider_x"));
    speeds(state.spin(scene.bodies[0]), number("crank_speed"), 150.0);
    speeds(state.spin(scene.bodies[1]), number("rod_speed"), 150.0);
    speeds(state.velocity(scene.bodies[2])[0], number("slider_v"), 20.0);
    EXPECT_LE(positions.value(), 3e-11) << "t = " << time;
    EXPECT_LE(speeds.value(), 3e-11) << "t = " << time;
    carom_test::note("position", positions.value());
    carom_test::note("speed", speeds.value());
  }
}

void expect_one_freedom(const Simulation& at_start) {
  const Mobility mobility = at_start.mobility();
  EXPECT_EQ(mobility.degrees_of_freedom, 1U);
  EXPECT_TRUE(mobility.redundant.empty());  // not yet in line
}

// Where all rods are in line rows depend on each other. Nearby rounding is magnified by the inverse of the
// smallest pivot that is kept, 1e-9: 1e-7 a passage at worst, and there are ten of them.
void through_positions_in_line(int number, const char* problem, double tolerance) {
  const Scene scene = windows(number);
  const auto data = reference_data("smooth_planar.json").at(problem).at("reference");
  WatchedRun run(scene);
  expect_one_freedom(run.simulation);
  for (const char* const time : {"0.5", "1", "2", "5", "10"}) {
    run.simulation.run_until(std::stod(time));
    const auto& at = data.at(time);
    const State& state = run.simulation.state();
    // All uprights: on another branch they would part.
    carom_test::Worst angle, spin;
    for (std::size_t i = 0; i <= static_cast<std::size_t>(number); ++i) {
      angle(quarter - state.angle(scene.bodies[i]), at.at("phi").get<double>());
      spin(-state.spin(scene.bodies[i]), at.at("phidot").get<double>());
    }
    EXPECT_LE(angle.value(), tolerance) << "t = " << time;
    EXPECT_LE(spin.value(), 3.0 * tolerance) << "t = " << time;
    carom_test::note("phi", angle.value());
    carom_test::note("phidot", spin.value());
  }
}
TEST(JointsEventDriven, TwoWindowsPassTheirPositionsInLine) {
  through_positions_in_line(2, "A02_double_fourbar_N2", 1e-8);
}
// Their run is a page of the validation report, which is watched likewise (report_test.cpp).
TEST(JointsEventDriven, FortyWindowsHaveOneFreedom) {
  expect_one_freedom(Simulation(windows(40).system, fine()));
}

TEST(JointsEventDriven, SqueezingMechanism) {
  const Scene scene = squeezing_mechanism();
  const auto data = reference_data("andrews.json").at("recomputed");
  EventDriven options = fine();
  options.interval = 1e-3;
  WatchedRun run(scene, options);
  for (const char* const time : {"0.01", "0.02", "0.03"}) {
    run.simulation.run_until(std::stod(time));
    std::array<double, 7> angle{}, spin{};
    for (std::size_t i = 0; i < 7; ++i) {
      angle[i] = run.simulation.state().angle(scene.bodies[i]);
      spin[i] = run.simulation.state().spin(scene.bodies[i]);
    }
    const std::vector<double> q = relative(angle), v = relative(spin);
    carom_test::Worst angles, rates;
    for (std::size_t i = 0; i < 7; ++i) {
      angles(q[i], data.at(time).at("q")[i].get<double>());
      const auto rate = data.at(time).at("v")[i].get<double>();
      rates(v[i], rate, std::abs(rate));
    }
    EXPECT_LE(angles.value(), 1e-10) << "t = " << time;
    EXPECT_LE(rates.value(), 1e-9) << "t = " << time;
    carom_test::note("angle", angles.value());
    carom_test::note("rate", rates.value());
  }
}

}  // namespace
