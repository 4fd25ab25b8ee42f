// Energy that steps of lasting contact add: told by the report and the statistics, to rounding; of first
// order in total.

#include "tests/integrators/lasting_scenes.h"
#include "tests/temporary_folder.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

namespace {

using namespace lasting_scenes;

/// A box that tumbles without restitution: it falls on a corner and goes on from corner to corner.
System tumbling(double friction = 0.3) {
  System system;
  system.add(Gravity{{0.0, -9.81}});
  system.add(HalfPlane{.normal = {0.0, 1.0}},
             Surface{.friction = friction, .normal_restitution = 0.0, .tangential_restitution = 0.0},
             "floor");
  const BodyId body = system.add(RigidBody{.mass = box(1.0, 0.4, 0.3),
                                           .position = {0.0, 0.4},
                                           .angle = 0.4,
                                           .velocity = {2.0, 0.0},
                                           .spin = -6.0},
                                 "box");
  system.add(Polygon{.body = body, .vertices = {{-0.2, -0.15}, {0.2, -0.15}, {0.2, 0.15}, {-0.2, 0.15}}});
  return system;
}

struct Rise {
  double most = 0.0, sum = 0.0;  // of one step, of all that rise [J]
  std::int64_t steps = 0;
};

/// Every rise of T + V is told by its step, and by nothing else.
Rise run_and_compare(Simulation& simulation, double end) {
  // Sums of a few joules, each rounded.
  constexpr double rounding = 1e-14;
  Rise rise;
  while (simulation.time() < end) {
    const double before = simulation.energy().total();
    const StepReport& report = simulation.step();
    const double change = simulation.energy().total() - before;
    EXPECT_NEAR(report.energy_gain, std::max(change, 0.0), rounding) << simulation.time();
    EXPECT_EQ(report.lasting_gain, report.energy_gain);  // one e everywhere: impacts gain nothing
    rise.most = std::max(rise.most, report.lasting_gain);
    rise.sum += report.lasting_gain;
    rise.steps += report.lasting_gain > 0.0 ? 1 : 0;
  }
  EXPECT_EQ(simulation.statistics().lasting_gains, rise.steps);
  EXPECT_NEAR(simulation.statistics().lasting_gained, rise.sum, rounding);
  EXPECT_EQ(simulation.statistics().energy_gains, 0);
  return rise;
}

TEST(LastingGain, OfATumblingBoxIsTold) {
  double before = 0.0;
  for (const double step : {4e-3, 1e-3, 2.5e-4}) {
    Simulation simulation(tumbling(), TimeStepping{.step = step});
    const Rise rise = run_and_compare(simulation, 2.0);
    RecordProperty("step_" + std::to_string(step), std::to_string(rise.sum));
    EXPECT_GT(rise.steps, 0) << step;
    if (before > 0.0) {
      EXPECT_LT(rise.sum, before) << step;
    }
    before = rise.sum;
  }
}

TEST(LastingGain, IsNoneAtRest) {
  // Rounding of what rests or slides is no gain.
  for (const double friction : {0.0, 0.3}) {
    for (const double slope : {0.0, 0.2}) {
      System system;
      system.add(Gravity{{0.0, -9.81}});
      system.add(HalfPlane{.normal = incline(slope)},
                 Surface{.friction = friction, .normal_restitution = 0.0});
      const BodyId body = system.add(RigidBody{.mass = box(1.0, 0.4, 0.3),
                                               .position = 0.15 * incline(slope),
                                               .angle = slope,
                                               .velocity = 3.0 * Vec<2>(std::cos(slope), std::sin(slope))});
      system.add(Polygon{.body = body, .vertices = {{-0.2, -0.15}, {0.2, -0.15}, {0.2, 0.15}, {-0.2, 0.15}}});
      Simulation simulation(system, TimeStepping{.step = 1e-3});
      simulation.run_until(1.0);
      EXPECT_EQ(simulation.statistics().lasting_gains, 0) << friction << ' ' << slope;
    }
  }
}

TEST(LastingGain, IsSavedWithTheStatistics) {
  const carom_test::TemporaryFolder folder;
  const std::string file = folder / "gain.checkpoint";
  Simulation simulation(tumbling(), TimeStepping{});
  simulation.run_until(1.0);
  ASSERT_GT(simulation.statistics().lasting_gains, 0);
  simulation.save(file);
  Simulation loaded(tumbling(), TimeStepping{});
  loaded.load(file);
  EXPECT_EQ(loaded.statistics().lasting_gains, simulation.statistics().lasting_gains);
  EXPECT_EQ(loaded.statistics().lasting_gained, simulation.statistics().lasting_gained);
}

// It is no gain of the law, which alone is refused.
TEST(LastingGain, IsNotRefused) {
  Simulation simulation(tumbling(), TimeStepping{.impact_rules = {.energy_gain = EnergyGain::refuse}});
  EXPECT_NO_THROW(simulation.run_until(1.0));
  EXPECT_GT(simulation.statistics().lasting_gains, 0);
}

}  // namespace
