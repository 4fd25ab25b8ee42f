// Errors of event-driven runs with the tolerances as they come: those that docs/events.md tells (Which
// tolerance?).

#include "tests/reference/coupled_impacts.h"
#include "tests/reference/incline_run.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace {

using namespace carom;
using namespace carom_test;

/// The largest error at the end of the runs of a file, of bars or pairs [m, rad].
double worst_on_inclines(const std::string& file, bool is_bar, const EventDriven& options) {
  double worst = 0.0;
  const Json all = reference_data(file).at(is_bar ? "bar" : "pair");
  for (const auto& [name, data] : all.items()) {
    const Json& last = data.at("state_at_end");
    const Json& parameters = data.contains("parameters") ? data.at("parameters") : data;
    const double end = data.contains("t_end") ? data.at("t_end").get<double>() : last.at("t").get<double>();
    const InclineRun run = run_incline(incline_of(parameters), is_bar, end, options);
    worst = std::max(worst, distance(run.q, reference_end(last, is_bar)));
  }
  return worst;
}

double worst_of(const std::string& family) {
  double worst = 0.0;
  for (const CoupledScene& scene : coupled_scenes(family)) {
    Simulation simulation(scene.system, EventDriven{});
    simulation.run_until(scene.end);
    for (std::size_t i = 0; i < scene.q.size(); ++i)
      worst = std::max(worst, std::abs(simulation.state().q[i] - scene.q[i]));
  }
  return worst;
}

TEST(DefaultTolerances, GiveWhatThePageTells) {
  const EventDriven finer{.relative_tolerance = 1e-11, .absolute_tolerance = 1e-13};
  for (const char* file : {"incline_bodies.json", "open_variants.json"}) {
    EXPECT_LT(worst_on_inclines(file, true, {}), 1e-12) << file;
    // Twice what the page tells: rounding decides where steps lie, and so which errors they have.
    EXPECT_LT(worst_on_inclines(file, false, {}), 4e-6) << file;
    EXPECT_GT(worst_on_inclines(file, false, {}), 1e-7) << file;  // else the page tells too much
    EXPECT_LT(worst_on_inclines(file, false, finer), 2e-7) << file;
  }
  for (const char* flight : {"moved_tables", "bar_in_a_corner", "boxes_that_meet"})
    EXPECT_LT(worst_of(flight), 1e-12) << flight;
  for (const char* coupled : {"string_on_a_floor", "net_on_an_incline", "chain_against_a_wall"})
    EXPECT_LT(worst_of(coupled), 2e-9) << coupled;
}

}  // namespace
