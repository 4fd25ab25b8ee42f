// Runs whose every term is kept in tests/energy/traces. A change of the numbers is a change of the method: if
// it is meant, store the new ones with CAROM_REWRITE_TRACES=1 and say in the commit why.

#include "examples/scenes/incline.h"
#include "tests/paths.h"

#include <carom/carom.h>
#include <carom/testing/matchers.h>

#include <gtest/gtest.h>

#include <limits>
#include <string>

namespace {

using namespace carom;
using namespace carom::planar;
using namespace carom::energy_test;

constexpr double eps = std::numeric_limits<double>::epsilon();

std::string stored(const std::string& name) { return carom_test::source_file("tests/energy/traces/" + name); }

/// Compilers differ in the rounding of the step (order of sums, sine and cosine). Each of n steps rounds
/// velocities and positions by some eps, impacts magnify what came before by a few, and the spring (w = 45/s)
/// keeps it bounded: n eps, times 4 for the impacts.
TraceTolerances round_off_of(int steps) { return {.relative = 4.0 * steps * eps}; }

/// Iterated down to rounding: a tolerance would let what is left depend on the guess.
EnergyTrace run(System system, double end, double interval) {
  Simulation simulation(std::move(system), TimeStepping{.step = 1.0 / 1200, .tolerance = 0.0});
  const EnergyRecorder recorder(simulation, {.interval = interval});
  simulation.run_until(end);
  return recorder.trace();
}

/// The paper's bodies from 2 m instead of 20 m, so that impacts come early.
System on_the_incline(bool is_bar, double e) {
  const scenes::Incline incline{
      .angle = 0.3, .height = 2.0, .normal_restitution = e, .tangential_restitution = e};
  System system;
  scenes::add_plane(system, incline);
  if (is_bar) {
    scenes::add_bar(system, incline);
  } else {
    scenes::add_pair(system, incline);
  }
  return system;
}

TEST(StoredTraces, BarOnTheIncline) {
  const EnergyTrace trace = run(on_the_incline(true, 1.0), 1.0, 0.05);
  EXPECT_GE(trace.events().size(), 1u);
  EXPECT_THAT(trace, matches_stored_trace(stored("bar_on_the_incline.csv"), round_off_of(1200)));
  EXPECT_THAT(trace, ledger_closes_within(1e3 * eps));
}

TEST(StoredTraces, PairOnTheIncline) {
  const EnergyTrace trace = run(on_the_incline(false, 1.0), 0.6, 0.03);
  EXPECT_GE(trace.events().size(), 2u);
  EXPECT_THAT(trace, matches_stored_trace(stored("pair_on_the_incline.csv"), round_off_of(720)));
  EXPECT_THAT(trace, ledger_closes_within(1e3 * eps));
}

TEST(StoredTraces, BodiesOnSpringsAndDashpots) {
  // Every way but contact: gravity, springs off the centre, dashpots, drag, a load and an actuator.
  System system;
  system.add(Gravity{{0.0, -9.81}});
  const BodyId plate = system.add(
      RigidBody{
          .mass = disc(2.0, 0.5), .position = {0.0, 0.0}, .angle = 0.2, .velocity = {1.0, 0.5}, .spin = 3.0},
      "plate");
  const BodyId ball =
      system.add(Particle{.mass = 0.5, .position = {1.5, 0.3}, .velocity = {0.0, -1.0}}, "ball");
  system.add(SpringDamper{
      .from = ground, .to = {plate, {0.5, 0.0}}, .stiffness = 80.0, .damping = 0.5, .free_length = 0.2});
  system.add(
      Cable{.from = {plate, {0.0, 0.5}}, .to = ball, .stiffness = 60.0, .damping = 0.3, .free_length = 1.0});
  system.add(TorsionalSpring{.from = ground, .to = plate, .stiffness = 4.0, .damping = 0.1});
  system.add(Drag{.on = ball, .linear = 0.1, .quadratic = 0.05});
  system.add(AppliedForce{.on = ball, .force = [](double t) { return Vec<2>(3.0 * t, 1.0); }});
  const EnergyTrace trace = run(std::move(system), 1.0, 0.05);
  EXPECT_THAT(trace, matches_stored_trace(stored("bodies_on_springs.csv"), round_off_of(1200)));
  EXPECT_THAT(trace, ledger_closes_within(1e3 * eps));
}

}  // namespace
