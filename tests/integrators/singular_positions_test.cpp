// Mechanisms with redundant joints pass positions in line in the event-driven mode: energy, motion, and the
// error where a projection takes too much.

#include "tests/integrators/redundant_mechanisms.h"
#include "tests/integrators/throws.h"
#include "tests/shares.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>

namespace {

using namespace joint_scenes;

constexpr std::array<FlowMethod, 4> methods{FlowMethod::explicit_runge_kutta, FlowMethod::one_step,
                                            FlowMethod::adams, FlowMethod::bdf};

std::string label(FlowMethod method) { return "method " + std::to_string(static_cast<int>(method)) + " "; }

EventDriven options(FlowMethod method, double tolerance, double interval) {
  return {.relative_tolerance = tolerance,
          .absolute_tolerance = 0.01 * tolerance,
          .method = method,
          .interval = interval};
}

/// Part of the kinetic energy at the start that projections take. Within 3e-5 rad of a position in line a row
/// is let go. Where steps fall there, a load across that row that turns by A (in units of the squared spin)
/// moves the mechanism by 2 * 3e-5 * A of its spin, which the next projection takes back: the square of that
/// is some 1e-7 for A = 5. There are five passages.
constexpr double of_passages = 1e-6;

double projected(const Simulation& simulation, double start) {
  return std::abs(simulation.energy().flow(EnergyFlow::projection)) / start;
}

double kinetic(const Simulation& simulation) { return simulation.energy().stored(StoredEnergy::kinetic); }

/// Six cranks on one coupler, at 3 rad/s: they turn on at that, and their energy is kept.
TEST(SingularPositions, SixParallelCranksKeepTheirEnergy) {
  constexpr int number = 6;
  constexpr double length = 0.5, start = 0.7, spin = 3.0, end = 4.0;
  Linkage linkage;
  const Vec<2> crank = length * Linkage::along(start), swing = spin * Vec<2>(-crank[1], crank[0]);
  const Linkage::Bar coupler = linkage.bar(1.0, crank, crank + Vec<2>(number - 1, 0.0), swing, 0.0);
  for (int i = 0; i < number; ++i) {
    const Vec<2> base(i, 0.0);
    const Linkage::Bar bar = linkage.bar(1.0, base, base + crank, Vec<2>::Zero(), spin);
    linkage.pin(linkage.base, bar, base);
    linkage.pin(bar, coupler, base + crank);
  }
  for (const FlowMethod method : methods) {
    for (const double tolerance : {1e-9, 1e-11}) {
      Simulation simulation(linkage.scene.system, options(method, tolerance, end));
      const double before = kinetic(simulation);
      simulation.run_until(end);
      EXPECT_NEAR(kinetic(simulation) / before, 1.0, of_passages) << label(method) << tolerance;
      const double turned = simulation.state().angle(linkage.scene.bodies[1]) - start;
      EXPECT_NEAR(turned, spin * end, 1e-6) << label(method) << tolerance;
    }
  }
}

void expect_passage(const ParallelCranks& cranks, FlowMethod method, const std::string& name) {
  // Errors of BDF add up by the same sign, those of Adams' method start at order 1.
  const bool steps_add_up = method == FlowMethod::bdf || method == FlowMethod::adams;
  const double of_steps = steps_add_up ? 1e-6 : 1e-8;
  const BodyId crank = cranks.linkage.scene.bodies.front();
  Simulation simulation(cranks.linkage.scene.system, options(method, 1e-9, cranks.end));
  const double before = kinetic(simulation), angle = simulation.state().angle(crank);
  simulation.run_until(cranks.end);
  EXPECT_LE(projected(simulation, before), of_passages) << name;
  EXPECT_LE(std::abs(simulation.energy().residual()) / before, of_steps) << name;
  // Everything that is heavy moves with the cranks: a pendulum whose speed follows from its height.
  for (const BodyId body : cranks.linkage.scene.bodies) {
    const double spin = simulation.state().spin(body);
    const double crank_spin = simulation.state().spin(crank);
    EXPECT_LE(std::min(std::abs(spin), std::abs(spin - crank_spin)), 1e-5 * std::abs(cranks.spin)) << name;
  }
  if (cranks.gravity > 0.0) return;
  EXPECT_NEAR(simulation.state().angle(crank) - angle, cranks.spin * cranks.end, 16.0 * of_steps) << name;
}

/// True if steps of a multistep method have shrunk to nothing in a position in line, and the error names
/// pins.
bool stops_in_line(const ParallelCranks& cranks, FlowMethod method, const SolverError& error) {
  constexpr double near = 1e-3;  // rows let go within 3e-5 rad, and lose digits before
  const std::string what = error.what();
  if (method != FlowMethod::adams && method != FlowMethod::bdf) return false;
  if (what.find("step_limit") == std::string::npos ||
      what.find("near a singular position of the joints: revolute joint 'pin") == std::string::npos) {
    return false;
  }
  Simulation simulation(cranks.linkage.scene.system, EventDriven{});
  simulation.run_until(error.failure().time + error.failure().step);
  const double angle = simulation.state().angle(cranks.linkage.scene.bodies.front());
  return std::abs(std::sin(angle - cranks.line)) < near;
}

void expect_passages(const carom_test::SeedRange& seeds) {
  int stopped = 0;
  for (std::uint64_t seed = seeds.first; seed < seeds.last; ++seed) {
    const ParallelCranks cranks(seed);
    for (const FlowMethod method : methods) {
      const std::string name = "cranks " + std::to_string(seed) + " by " + label(method);
      try {
        expect_passage(cranks, method, name);
      } catch (const SolverError& error) {
        EXPECT_TRUE(stops_in_line(cranks, method, error)) << name << ": " << error.what();
        ++stopped;
      }
    }
  }
  EXPECT_LE(stopped, seeds.count() / 4);  // seen: 2 and 5 of 29
}
TEST(SingularPositions, RandomParallelCranks) { expect_passages({0, 1}); }
TEST(SingularPositionsLong, RandomParallelCranks) { expect_passages(carom_test::seeds_from(1, 29, 199)); }

/// Against time stepping, of order 2; both pass the position on the branch that they came on.
void expect_kites_pass(const carom_test::SeedRange& seeds) {
  constexpr int steps = 2000;
  int compared = 0;
  for (std::uint64_t seed = seeds.first; seed < seeds.last; ++seed) {
    const std::string name = "kite " + std::to_string(seed);
    const RedundantKite kite(seed);
    Simulation events(kite.linkage.scene.system, options(FlowMethod::explicit_runge_kutta, 1e-9, kite.end));
    const double before = kinetic(events);
    events.run_until(kite.end);
    EXPECT_LE(projected(events, before), of_passages) << name;
    EXPECT_LE(std::abs(events.energy().residual()) / before, 1e-8) << name;
    Simulation steps_of_time(kite.linkage.scene.system, TimeStepping{.step = kite.end / steps});
    try {
      steps_of_time.run_until(kite.end);
    } catch (const SolverError&) {
      continue;  // its iteration does not contract there: an error, not a wrong motion
    }
    for (const BodyId body : kite.linkage.scene.bodies) {
      EXPECT_NEAR(events.state().angle(body), steps_of_time.state().angle(body), 5e-6) << name;
    }
    ++compared;
  }
  EXPECT_GE(2 * compared, seeds.count());
}
TEST(SingularPositions, RandomRedundantKites) { expect_kites_pass({0, 6}); }
TEST(SingularPositionsLong, RandomRedundantKites) { expect_kites_pass(carom_test::seeds_from(6, 34, 194)); }

// With a bound that no projection keeps the error names the joints, and the last good state stays.
TEST(SingularPositions, AProjectionThatTakesTooMuchIsAnError) {
  const ParallelCranks cranks(3);
  Simulation simulation(cranks.linkage.scene.system, {EventDriven{.relative_tolerance = 1e-3,
                                                                  .absolute_tolerance = 1e-11,
                                                                  .interval = 0.01 * cranks.end,
                                                                  .largest_projection = 1e-12}});
  EXPECT_THROWS(SolverError, simulation.run_until(cranks.end), "projecting velocities onto the constraints",
                "J kinetic energy", "largest_projection, 1e-12", "revolute joint 'pin");
  EXPECT_NEAR(simulation.energy().residual(), 0.0, 1e-2 * simulation.energy().scale());
  EXPECT_THROWS(ModelError, simulation.switch_to(EventDriven{.largest_projection = 0.0}),
                "largest_projection is 0", "> 0");
}

}  // namespace
