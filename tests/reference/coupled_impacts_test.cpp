// Impacts of coupled_impacts.json (40 digits, coupled_impacts.py): a ball between tables that move, a bar in
// a corner, boxes that meet, a string and a net on springs, a chain against a wall. In both modes; in time
// stepping by both rules, with impacts located and at the start of steps.

#include "tests/reference/coupled_impacts.h"

#include "tests/analytic/convergence.h"
#include "tests/energy/ledger_check.h"
#include "tests/integrators/event_run.h"
#include "tests/reference/largest_difference.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace {

using namespace carom;
using carom_test::coupled_scenes;
using carom_test::CoupledScene;
using carom_test::largest_difference;
using carom_test::tight;

/// Error of the coordinates at the end. The ledger must close.
double error_of(const CoupledScene& scene, const TimeStepping& options) {
  Simulation simulation(scene.system, options);
  simulation.run_until(scene.end);
  EXPECT_TRUE(carom_test::ledger_closes(simulation.energy())) << scene.name << ", step " << options.step;
  return largest_difference(simulation.state().q, scene.q);
}

double shortest_interval(const CoupledScene& scene) {
  double shortest = scene.end;
  for (std::size_t i = 1; i < scene.times.size(); ++i)
    shortest = std::min(shortest, scene.times[i] - scene.times[i - 1]);
  return shortest;
}

class CoupledImpacts : public testing::TestWithParam<const char*> {};
class CoupledOrders : public CoupledImpacts {};

TEST_P(CoupledImpacts, EventsAreExact) {
  for (const CoupledScene& scene : coupled_scenes(GetParam())) {
    Simulation simulation(scene.system, tight());
    const carom_test::LedgerWatch watch(simulation, 5.0);
    simulation.run_until(scene.end);
    const auto impacts = carom_test::events_of(simulation, EventKind::impact);
    ASSERT_EQ(impacts.size(), scene.times.size()) << scene.name;
    for (std::size_t i = 0; i < impacts.size(); ++i) {
      // Tolerances of 1e-11, which the impacts before multiply.
      EXPECT_NEAR(impacts[i].time, scene.times[i], 1e-11) << scene.name << ", impact " << i;
      if (!scene.modes.empty()) {
        EXPECT_EQ(to_string(impacts[i].mode), scene.modes[i]) << scene.name << ", impact " << i;
      }
    }
    EXPECT_LT(largest_difference(simulation.state().q, scene.q), 1e-10) << scene.name;
    EXPECT_LT(largest_difference(simulation.state().v, scene.v), 1e-9) << scene.name;
    EXPECT_TRUE(watch.closes()) << scene.name;
  }
}

TEST_P(CoupledOrders, LocatedAreExactOrOfSecondOrder) {
  for (const CoupledScene& scene : coupled_scenes(GetParam())) {
    for (const ForceRule rule : {ForceRule::trapezoidal, ForceRule::energy_momentum}) {
      TimeStepping options{.impacts = ImpactTimes::located, .force_rule = rule};
      const std::string name = scene.name + ", " + std::string(to_string(rule));
      if (scene.constant_loads && rule == ForceRule::trapezoidal) {
        for (const double step : {4e-3, 3e-4}) {
          options.step = step;
          // Flights are exact; instants of bodies that meet are found to 1e-12 m, which later impacts
          // multiply.
          EXPECT_LT(error_of(scene, options), 1e-10) << name << ", step " << step;
        }
        continue;
      }
      const analytic::MeanOrder order = analytic::mean_order(2e-3, 3, 8, [&](double step) {
        options.step = step;
        return error_of(scene, options);
      });
      // 2; the error scatters with where the grid of steps lies, as the deviation says.
      EXPECT_GT(order.slope, 1.8 - order.deviation) << name << ", deviation " << order.deviation;
      EXPECT_LT(order.slope, 2.4 + order.deviation) << name;
    }
  }
}

// Up to a step late: the mean error falls with the step, and is much larger.
TEST_P(CoupledOrders, AtTheStartOfStepsAreOfFirstOrder) {
  for (const CoupledScene& scene : coupled_scenes(GetParam())) {
    // Impacts of one body within one step have no order yet.
    if (scene.constant_loads && shortest_interval(scene) < 1e-3) continue;
    for (const ForceRule rule : {ForceRule::trapezoidal, ForceRule::energy_momentum}) {
      const std::string name = scene.name + ", " + std::string(to_string(rule));
      const analytic::MeanOrder order = analytic::mean_order(
          1e-3, 3, 10, [&](double step) { return error_of(scene, {.step = step, .force_rule = rule}); });
      EXPECT_GT(order.slope, 0.8 - order.deviation) << name << ", deviation " << order.deviation;
      EXPECT_LT(order.slope, 1.2 + order.deviation) << name << ", deviation " << order.deviation;
      const double located =
          error_of(scene, {.step = order.steps.back(), .impacts = ImpactTimes::located, .force_rule = rule});
      EXPECT_GT(order.errors.back(), 10.0 * located) << name;
    }
  }
}

std::string name_of(const testing::TestParamInfo<const char*>& family) { return family.param; }

INSTANTIATE_TEST_SUITE_P(Families, CoupledImpacts,
                         testing::Values("moved_tables", "bar_in_a_corner", "boxes_that_meet",
                                         "string_on_a_floor", "net_on_an_incline", "chain_against_a_wall"),
                         name_of);
INSTANTIATE_TEST_SUITE_P(Families, CoupledOrders, testing::Values("bar_in_a_corner", "string_on_a_floor"),
                         name_of);
INSTANTIATE_TEST_SUITE_P(FamiliesLong, CoupledOrders,
                         testing::Values("moved_tables", "boxes_that_meet", "net_on_an_incline",
                                         "chain_against_a_wall"),
                         name_of);

}  // namespace
