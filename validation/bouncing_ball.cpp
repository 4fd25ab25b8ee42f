#include "validation/measure.h"
#include "validation/pages.h"
#include "validation/scenes.h"

#include <algorithm>

namespace validation {
namespace {

constexpr double restitution = 0.8;

Simulation dropped(const Mode& mode) { return {scenes::ball_above_floor(1.0, restitution).system, mode}; }

double height_at(double time, const Mode& mode) {
  Simulation simulation = dropped(mode);
  simulation.run_until(time);
  return simulation.state().position(simulation.system().body("ball"))[1];
}

void add_states(Page& page, const Json& data, const Mode& mode) {
  const Clock clock;
  Comparison heights, speeds;
  for (const auto& [time, at] : data.at("states").items()) {
    Simulation simulation = dropped(mode);
    simulation.run_until(std::stod(time));
    const BodyId ball = simulation.system().body("ball");
    heights(simulation.state().position(ball)[1], of(at, "y"));
    speeds(simulation.state().velocity(ball)[1], of(at, "v"));
  }
  double order = unknown;
  if (has_order(mode)) {
    const double exact = of(data.at("states").at("2.0"), "y");
    order = analytic::mean_order(2e-3, 4, 40, [&](double h) {
              return std::abs(height_at(2.0, TimeStepping{.step = h}) - exact);
            }).slope;
  }
  page.rows.push_back(row(mode, "height at ten times up to 5 s [m]", heights, clock.seconds(), order));
  page.rows.push_back(row(mode, "velocity at ten times up to 5 s [m/s]", speeds, clock.seconds()));
}

Curve path(const std::string& name, const Mode& mode, double interval, double from, double to) {
  Curve curve{.name = name, .columns = {"time [s]", "height [m]"}, .rows = {}};
  Simulation simulation = dropped(mode);
  const BodyId ball = simulation.system().body("ball");
  const auto count = static_cast<int>((to - from) / interval + 0.5);
  for (int i = 0; i <= count; ++i) {
    const double time = from + i * interval;
    if (time > 0.0) simulation.run_until(time);
    curve.rows.push_back({time, simulation.state().position(ball)[1]});
  }
  return curve;
}

}  // namespace

Page bouncing_ball() {
  Page page;
  page.name = "bouncing_ball";
  page.title = "Bouncing ball";
  page.source = "closed form, `impacts_planar.json`";
  page.text =
      "A particle falls 1 m on a floor, e_n = 0.8. Its impacts accumulate (Zeno) at √(2 h0/g) (1 + e)/(1 − "
      "e) = 4.0637 "
      "s, after which it rests.";
  page.figures = {{"bouncing_ball",
                   "Height over time, and its last tenth of a second before rest, where the steps of 1 ms no "
                   "longer resolve the flights."}};
  const Json data = reference("impacts_planar.json", "bouncing_ball");
  add_in_both_modes(page, TimeStepping{.step = 1e-3}, tight(),
                    [&](Page& to, const Mode& mode) { add_states(to, data, mode); });
  const Clock clock;
  Simulation simulation = dropped(tight());
  const std::vector<Impact> impacts = impacts_until(simulation, 5.0);
  Comparison times, speeds;
  for (std::size_t i = 0; i < data.at("impacts").size(); ++i) {
    times(impacts.at(i).time, of(data.at("impacts")[i], "t"));
    speeds(impacts[i].after[0], of(data.at("impacts")[i], "v_plus"));
  }
  const double cost = clock.seconds();
  page.rows.push_back(row(tight(), "time of impact [s]", times, cost));
  page.rows.push_back(row(tight(), "speed after impact [m/s]", speeds, cost));
  page.rows.push_back(row(tight(), "time at which the impacts accumulate [s]",
                          events_of(simulation, EventKind::accumulation).at(0).accumulation_time,
                          of(data, "zeno_time"), cost));
  page.curves = {path("ball_stepping", TimeStepping{.step = 1e-3}, 5e-3, 0.0, 4.5),
                 path("ball_events", tight(), 5e-3, 0.0, 4.5),
                 path("ball_stepping_late", TimeStepping{.step = 1e-3}, 1e-3, 3.96, 4.1),
                 path("ball_events_late", tight(), 2e-4, 3.96, 4.1)};
  page.remarks =
      "Event-driven, only the energy of the last approach, below the capture speed of 1e-4 m/s, is thrown "
      "away, and the time of accumulation follows from the ratio of the intervals. In time stepping flights "
      "shorter than two steps cannot be told apart and the ball comes to rest by itself, at a depth of the "
      "order of g h²; its largest error in height is that of impacts that are up to one step late.";
  return page;
}

}  // namespace validation
