#include "validation/measure.h"
#include "validation/pages.h"
#include "validation/scenes.h"

namespace validation {
namespace {

void add_ramp(Page& page, const Mode& mode) {
  const Clock clock;
  Comparison places, times;
  for (const auto& at : reference("contacts_planar.json", "slider_on_ramp", "cases")) {
    const scenes::Downhill body{
        .slope = of(at, "slope"), .friction = of(at, "mu"), .speed = of(at, "v0"), .depth = depth_for(mode)};
    scenes::BodyScene scene = scenes::downhill(body);
    Simulation simulation(std::move(scene.system), mode);
    simulation.run_until(2.0);
    const char* place = at.contains("x_stop") ? "x_stop" : "x_at_2s";
    places(body.distance(simulation.state(), scene.body), of(at, place));
    for (const auto& [key, kind] :
         {std::pair{"t_stop", EventKind::stick}, std::pair{"t_reverse", EventKind::slip}}) {
      const auto events = events_of(simulation, kind);
      if (at.contains(key) && !events.empty()) times(events[0].time, of(at, key));
    }
  }
  page.rows.push_back(row(mode, "place of a block on a ramp after 2 s [m]", places, clock.seconds()));
  if (times.count() > 0)
    page.rows.push_back(row(mode, "times at which it stops or turns round [s]", times, clock.seconds()));
}

std::vector<double> oscillator_places(const Json& data, const Mode& mode) {
  scenes::BodyScene scene = scenes::coulomb_oscillator(depth_for(mode));
  Simulation simulation(std::move(scene.system), mode);
  std::vector<double> places;
  for (const auto& at : data.at("x_at")) {
    simulation.run_until(at[0].get<double>());
    places.push_back(simulation.state().position(scene.body)[0]);
  }
  simulation.run_until(2.0);
  places.push_back(simulation.state().position(scene.body)[0]);
  return places;
}

void add_oscillator(Page& page, const Mode& mode) {
  const Json data = reference("contacts_planar.json", "coulomb_oscillator");
  const Clock clock;
  std::vector<double> expected;
  for (const auto& at : data.at("x_at")) expected.push_back(at[1].get<double>());
  expected.push_back(of(data, "rest_position"));
  const auto error_of = [&](const std::vector<double>& found) {
    double worst = 0.0;
    for (std::size_t i = 0; i < found.size(); ++i) worst = std::max(worst, std::abs(found[i] - expected[i]));
    return worst;
  };
  Comparison places;
  const std::vector<double> found = oscillator_places(data, mode);
  for (std::size_t i = 0; i < found.size(); ++i) places(found[i], expected[i]);
  const double cost = clock.seconds();
  double order = unknown;
  if (has_order(mode)) {
    order = analytic::mean_order(4e-3, 4, 32, [&](double h) {
              return error_of(oscillator_places(data, TimeStepping{.step = h}));
            }).slope;
  }
  page.rows.push_back(row(mode, "place of a block on a spring, at last at rest [m]", places, cost, order));
  if (!std::holds_alternative<EventDriven>(mode)) return;
  scenes::BodyScene scene = scenes::coulomb_oscillator();
  Simulation simulation(std::move(scene.system), mode);
  simulation.run_until(2.0);
  page.rows.push_back(row(mode, "time at which it stops for good [s]",
                          events_of(simulation, EventKind::stick).at(0).time, of(data, "stop_time"), cost));
}

Curve course(const std::string& name, const Mode& mode) {
  scenes::BodyScene scene = scenes::coulomb_oscillator(depth_for(mode));
  Simulation simulation(std::move(scene.system), mode);
  Curve curve{.name = name, .columns = {"time [s]", "place [m]"}, .rows = {}};
  for (int i = 0; i <= 130; ++i) {
    if (i > 0) simulation.run_until(0.01 * i);
    curve.rows.push_back({0.01 * i, simulation.state().position(scene.body)[0]});
  }
  return curve;
}

}  // namespace

Page friction() {
  Page page;
  page.name = "friction";
  page.title = "Blocks with dry friction";
  page.source = "closed forms, `contacts_planar.json`";
  page.text =
      "A block on a ramp that slides, stays, stops or turns round (slope 0.3 rad, μ = 0.2 and 0.5), and a "
      "block of 1 kg on a rough floor (μ = 0.3) held by a spring of 100 N/m: its amplitude falls by 2 μ m "
      "g/k in each half period, and it stops where the spring cannot move it any more, |x| ≤ μ m g/k.";
  page.figures = {{"coulomb_oscillator",
                   "The block on the spring: line, event-driven; circles, time stepping with h = 0.01 s; "
                   "crosses, turning points in closed form; grey, where friction holds it."}};
  add_in_both_modes(page, TimeStepping{.step = 1e-3}, tight(), [](Page& to, const Mode& mode) {
    add_ramp(to, mode);
    add_oscillator(to, mode);
  });
  page.curves = {course("coulomb_events", tight()), course("coulomb_stepping", TimeStepping{.step = 1e-2})};
  const Json data = reference("contacts_planar.json", "coulomb_oscillator");
  Curve turns{.name = "coulomb_reference", .columns = {"time [s]", "place [m]"}, .rows = {}};
  double time = 0.0;
  for (const auto& at : data.at("turning_points")) {
    turns.rows.push_back({time, at.get<double>()});
    time += of(data, "half_period");
  }
  page.curves.push_back(turns);
  page.remarks =
      "Both modes stop the block at the same place. In time stepping the direction of friction is right in "
      "all steps but those in which the block turns.";
  return page;
}

Page ladder() {
  Page page;
  page.name = "ladder";
  page.title = "Ladder against a wall";
  page.source = "statics, `contacts_planar.json`";
  page.text =
      "A uniform ladder (1 kg, 2 m) at 1 rad to the floor leans on a smooth wall. It stands if μ of the "
      "floor is at least 1/(2 tan θ) = 0.32105.";
  page.figures = {{"ladder",
                   "Angle by which the ladder has turned 0.2 s after it was let go, over the friction of the "
                   "floor; dashed: the least friction by statics."}};
  const Json data = reference("contacts_planar.json", "ladder");
  const double theta = of(data, "theta"), least = of(data, "mu_min");
  const auto turned = [&](double friction, double time, const Mode& mode) {
    const double depth = std::holds_alternative<TimeStepping>(mode) ? 1e-9 : 0.0;
    scenes::BodyScene scene = scenes::ladder(friction, theta, depth);
    Simulation simulation(std::move(scene.system), mode);
    simulation.run_until(time);
    return theta + simulation.state().angle(scene.body);
  };
  const std::vector<Mode> modes{TimeStepping{.step = 1e-3}, tight()};
  add_in_both_modes(page, TimeStepping{.step = 1e-3}, tight(), [&](Page& to, const Mode& mode) {
    const Clock clock;
    double low = 0.0, high = 1.0;     // slips, stands
    constexpr double slipped = 1e-9;  // far more than rounding, far less than a slip in that time
    constexpr double time = 0.1;
    for (int i = 0; i < 40; ++i) {
      const double middle = 0.5 * (low + high);
      (std::abs(turned(middle, time, mode)) > slipped ? low : high) = middle;
    }
    to.rows.push_back(
        row(mode, "least friction with which it stands", 0.5 * (low + high), least, clock.seconds()));
    const Clock standing;
    to.rows.push_back(row(mode, "turn in 5 s with 1.001 of that friction [rad]",
                          turned(1.001 * least, 5.0, mode), 0.0, standing.seconds()));
  });
  // Forces of a ladder at rest, as impulses of a step.
  add_with_options(page, TimeStepping{.step = 1e-3}, [&](Page& to, const Mode& mode) {
    const Clock clock;
    const double step = std::get<TimeStepping>(mode).step;
    scenes::BodyScene scene = scenes::ladder(0.5, theta, 1e-9);
    Simulation simulation(std::move(scene.system), mode);
    simulation.run_until(0.1);
    const ObstacleId wall = simulation.system().obstacle("wall");
    for (const ContactRecord& contact : simulation.report().contacts) {
      const double normal = contact.impulse[0] / step, tangential = std::abs(contact.impulse[1]) / step;
      if (contact.obstacle == wall) {
        to.rows.push_back(
            row(mode, "force of the wall, mean of a step [N]", normal, of(data, "wall"), clock.seconds()));
      } else {
        to.rows.push_back(row(mode, "normal force of the floor, mean of a step [N]", normal,
                              of(data, "floor_normal"), clock.seconds()));
        to.rows.push_back(row(mode, "friction of the floor, mean of a step [N]", tangential,
                              of(data, "floor_friction"), clock.seconds()));
      }
    }
  });
  for (const Mode& mode : modes) {
    Curve curve{
        .name = std::string("ladder_") + (std::holds_alternative<EventDriven>(mode) ? "events" : "stepping"),
        .columns = {"friction", "turn [rad]"},
        .rows = {}};
    for (int i = 0; i <= 60; ++i) curve.rows.push_back({0.01 * i, turned(0.01 * i, 0.2, mode)});
    page.curves.push_back(curve);
  }
  page.curves.push_back({.name = "ladder_reference", .columns = {"friction"}, .rows = {{least}}});
  page.remarks =
      "The border is sharp: the accelerations of a ladder that slips go to zero at it, so that the "
      "bisection, which asks whether the ladder has moved after 0.1 s, finds it to the size of what it calls "
      "moved.";
  return page;
}

}  // namespace validation
