// Steps of low order, with which adams and bdf begin after each event: gaps of lasting contacts, and of what
// has just lifted off, fall by up to the tolerance while their rates say that they do not close.

#include "tests/integrators/mixed_scenes.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <string>

namespace {

using namespace carom;
using carom_test::MixedScene;

/// Runs scenes, which fail where one drift makes event after event (event_limit).
void expect_ends(FlowMethod method, std::initializer_list<std::uint64_t> numbers) {
  for (const std::uint64_t number : numbers) {
    SCOPED_TRACE("scene " + std::to_string(number));
    Simulation simulation(MixedScene(number).system(), EventDriven{.method = method, .interval = 0.1});
    simulation.run_until(1.0);
    // Multistep methods spend all of their tolerance, 1e-9 a step, in some hundred steps.
    EXPECT_LE(std::abs(simulation.energy().residual()), 5e-7 * simulation.energy().scale());
    EXPECT_GT(simulation.statistics().impacts, 0);
  }
}

// Two round ends that touch have several gaps that are the same: one is closed, and the others drift with it.
// After a lift-off without acceleration, bodies of two groups, and of one, drift into each other.
TEST(EventDrift, MakesNoClosingsWithAdams) { expect_ends(FlowMethod::adams, {2, 95, 196, 352, 845, 996}); }

TEST(EventDrift, MakesNoClosingsWithBdf) { expect_ends(FlowMethod::bdf, {2, 62, 95, 196, 352}); }

}  // namespace
