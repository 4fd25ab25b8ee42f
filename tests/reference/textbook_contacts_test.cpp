// Motions of textbook_contacts.json (closed forms and quadratures with 40 digits, textbook_contacts.py): a
// ladder that slides down a wall and leaves it, a disc over an edge, a ball in a half-pipe, an oscillator
// with dry friction, a break of three discs, a superball. In both modes; in time stepping by both rules, with
// impacts located and at the start of steps.

#include "tests/reference/textbook_contacts.h"

#include "tests/analytic/convergence.h"
#include "tests/energy/ledger_check.h"
#include "tests/integrators/event_run.h"
#include "tests/reference/largest_difference.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <string>
#include <vector>

namespace {

using namespace carom;
using carom_test::largest_difference;
using carom_test::textbook_scenes;
using carom_test::TextbookScene;
using carom_test::tight;

/// Errors of the modes in a family.
struct Expected {
  const char* family;
  double q, v;                    // errors of the event-driven mode [m, rad] and [m/s, rad/s]
  double located;                 // order with impacts located; 0: exact with the trapezoidal rule
  int steps_per_bin;              // of an order
  bool located_is_better = true;  // than at the start of steps, by a factor of ten
};

void PrintTo(const Expected& expected, std::ostream* out) { *out << expected.family; }

constexpr double trapezoidal_rounding = 1e-12;  // 3,000 steps of a few eps, of coordinates up to 100

/// Largest error of the coordinates at the known times. The ledger must close.
double error_of(const TextbookScene& scene, TimeStepping options) {
  options.impact_rules = scene.rules;
  Simulation simulation(scene.system, options);
  double most = 0.0;
  for (const carom_test::KnownState& known : scene.states) {
    simulation.run_until(known.time);
    most = std::max(most, largest_difference(simulation.state().q, known.q));
  }
  EXPECT_TRUE(carom_test::ledger_closes(simulation.energy())) << scene.name << ", step " << options.step;
  return most;
}

class TextbookContacts : public testing::TestWithParam<Expected> {};
class TextbookOrders : public TextbookContacts {};

TEST_P(TextbookContacts, EventDrivenIsExact) {
  for (const TextbookScene& scene : textbook_scenes(GetParam().family)) {
    EventDriven options = tight();
    options.impact_rules = scene.rules;
    Simulation simulation(scene.system, options);
    const carom_test::LedgerWatch watch(simulation, 5.0);
    for (const carom_test::KnownState& known : scene.states) {
      simulation.run_until(known.time);
      EXPECT_LT(largest_difference(simulation.state().q, known.q), GetParam().q)
          << scene.name << ", " << known.time;
      EXPECT_LT(largest_difference(simulation.state().v, known.v), GetParam().v)
          << scene.name << ", " << known.time;
    }
    EXPECT_TRUE(watch.closes()) << scene.name;
    std::vector<EventRecord> events = simulation.events();
    std::erase_if(events, [](const EventRecord& event) { return event.time == 0.0; });
    ASSERT_EQ(events.size(), scene.times.size()) << scene.name;
    for (std::size_t i = 0; i < events.size(); ++i) {
      EXPECT_EQ(to_string(events[i].kind), scene.kinds[i]) << scene.name << ", event " << i;
      // Of the order of the errors of rates over rates of forces, which are not small.
      EXPECT_NEAR(events[i].time, scene.times[i], 3e-11) << scene.name << ", event " << i;
    }
  }
}

TEST_P(TextbookOrders, LocatedHasItsOrder) {
  for (const TextbookScene& scene : textbook_scenes(GetParam().family)) {
    for (const ForceRule rule : {ForceRule::trapezoidal, ForceRule::energy_momentum}) {
      TimeStepping options{.impacts = ImpactTimes::located, .force_rule = rule};
      const std::string name = scene.name + ", " + std::string(to_string(rule));
      if (GetParam().located == 0.0 && rule == ForceRule::trapezoidal) {
        for (const double step : {4e-3, 3e-4}) {
          options.step = step;
          EXPECT_LT(error_of(scene, options), trapezoidal_rounding) << name << ", step " << step;
        }
        continue;
      }
      const double expected = GetParam().located == 0.0 ? 2.0 : GetParam().located;
      const analytic::MeanOrder order =
          analytic::mean_order(2e-3, 3, GetParam().steps_per_bin, [&](double step) {
            options.step = step;
            return error_of(scene, options);
          });
      // The error scatters with where the grid of steps lies, as the deviation says.
      EXPECT_GT(order.slope, 0.9 * expected - 0.1 - order.deviation) << name << ", " << order.deviation;
      EXPECT_LT(order.slope, 1.1 * expected + 0.1 + order.deviation) << name << ", " << order.deviation;
    }
  }
}

TEST_P(TextbookOrders, AtTheStartOfStepsIsOfFirstOrder) {
  for (const TextbookScene& scene : textbook_scenes(GetParam().family)) {
    for (const ForceRule rule : {ForceRule::trapezoidal, ForceRule::energy_momentum}) {
      const std::string name = scene.name + ", " + std::string(to_string(rule));
      const analytic::MeanOrder order = analytic::mean_order(
          1e-3, 3, GetParam().steps_per_bin,
          [&](double step) { return error_of(scene, {.step = step, .force_rule = rule}); });
      EXPECT_GT(order.slope, 0.8 - order.deviation) << name << ", " << order.deviation;
      EXPECT_LT(order.slope, 1.2 + order.deviation) << name << ", " << order.deviation;
      if (!GetParam().located_is_better) continue;
      const double located =
          error_of(scene, {.step = order.steps.back(), .impacts = ImpactTimes::located, .force_rule = rule});
      EXPECT_GT(order.errors.back(), 10.0 * located) << name;
    }
  }
}

// A contact that turns sinks by h times what it turns through times its speed, unless gaps are projected.
TEST(TextbookBowl, ProjectedGapsKeepTheBallOnTheGround) {
  for (const TextbookScene& scene : textbook_scenes("ball_in_a_bowl")) {
    const double projected = error_of(scene, {.step = 1e-3, .project_gaps = true});
    // First order both: 4 to 60 times smaller.
    EXPECT_NEAR(error_of(scene, {.step = 5e-4, .project_gaps = true}), 0.5 * projected, 0.05 * projected)
        << scene.name;
    EXPECT_GT(error_of(scene, {.step = 1e-3}), 3.0 * projected) << scene.name;
  }
}

const Expected short_families[] = {
    // Errors of a second: tolerances of 1e-11 of each step, fewer than 100 steps.
    {"sliding_ladder", 1e-12, 5e-12, 2.0, 4},
    // Parabolas and impacts: rounding.
    {"superball", 3e-13, 1e-13, 0.0, 8}};
// Of longer runs or many cases.
const Expected long_families[] = {
    {"disc_over_an_edge", 1e-12, 2e-12, 2.0, 8},
    // Five periods, over which errors of rates become those of the phase, times an angle of 9 rad.
    {"ball_in_a_bowl", 1e-9, 3e-9, 2.0, 2},
    // Reversals of sliding are not located in time stepping.
    {"rubbed_oscillator", 4e-12, 2e-11, 1.0, 8, false}};

std::string family_of(const testing::TestParamInfo<Expected>& each) { return each.param.family; }

INSTANTIATE_TEST_SUITE_P(Families, TextbookContacts, testing::ValuesIn(short_families), family_of);
INSTANTIATE_TEST_SUITE_P(LongerFamilies, TextbookContacts, testing::ValuesIn(long_families), family_of);
INSTANTIATE_TEST_SUITE_P(Families, TextbookOrders, testing::ValuesIn(short_families), family_of);
INSTANTIATE_TEST_SUITE_P(FamiliesLong, TextbookOrders, testing::ValuesIn(long_families), family_of);

// In its first step of h a disc has the mean of the velocities before and after: it is behind by h/2 times
// the jump. Impacts that are located, or sequential, end there, and nothing is behind.
TEST(TextbookBreak, VelocitiesAreExactInAllModes) {
  for (const TextbookScene& scene : textbook_scenes("break_of_discs")) {
    const carom_test::KnownState& known = scene.states.front();
    EventDriven events = tight();
    events.impact_rules = scene.rules;
    Simulation exact(scene.system, events);
    exact.run_until(known.time);
    // Rounding.
    EXPECT_LT(largest_difference(exact.state().q, known.q), 2e-14) << scene.name;
    EXPECT_LT(largest_difference(exact.state().v, known.v), 2e-14) << scene.name;
    for (const ForceRule rule : {ForceRule::trapezoidal, ForceRule::energy_momentum}) {
      for (const ImpactTimes times : {ImpactTimes::at_step_start, ImpactTimes::located}) {
        constexpr double step = 1e-3;
        Simulation simulation(
            scene.system,
            TimeStepping{.step = step, .impact_rules = scene.rules, .impacts = times, .force_rule = rule});
        const std::vector<double> before = simulation.state().v;
        simulation.run_until(known.time);
        std::vector<double> expected = known.q;
        if (times == ImpactTimes::at_step_start && scene.rules.order == ImpactOrder::simultaneous) {
          for (std::size_t i = 0; i < expected.size(); ++i)
            expected[i] -= 0.5 * step * (known.v[i] - before[i]);
        }
        const std::string name = scene.name + ", " + std::string(to_string(times));
        EXPECT_LT(largest_difference(simulation.state().q, expected), 1e-13)
            << name;  // rounding of 500 steps
        EXPECT_LT(largest_difference(simulation.state().v, known.v), 2e-14) << name;
        EXPECT_TRUE(carom_test::ledger_closes(simulation.energy())) << name;
      }
    }
  }
}

}  // namespace
