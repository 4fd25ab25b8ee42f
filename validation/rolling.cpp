#include "validation/measure.h"
#include "validation/pages.h"
#include "validation/scenes.h"

namespace validation {
namespace {

using scenes::Downhill;

struct Rolled {
  double distance = 0.0, speed = 0.0, surface_speed = 0.0;  // the last r times the forward spin
  double sticks_at = unknown;
};
Rolled rolled(const Downhill& at, double time, const Mode& mode) {
  scenes::BodyScene scene = scenes::downhill(at);
  Simulation simulation(std::move(scene.system), mode);
  simulation.run_until(time);
  const State& state = simulation.state();
  Rolled result{at.distance(state, scene.body), at.speed_of(state, scene.body),
                -at.radius * state.spin(scene.body)};
  const auto stick = events_of(simulation, EventKind::stick);
  if (!stick.empty()) result.sticks_at = stick[0].time;
  return result;
}

void add_inclines(Page& page, const Mode& mode) {
  const Clock clock;
  Comparison distance, speed, spin;
  for (const auto& at : reference("impacts_planar.json", "body_on_incline", "cases")) {
    constexpr double r = 0.1;
    const Rolled found = rolled({.slope = of(at, "slope"),
                                 .friction = of(at, "mu"),
                                 .inertia = of(at, "inertia_over_m_r2") * r * r,
                                 .radius = r,
                                 .depth = depth_for(mode)},
                                1.0, mode);
    distance(found.distance, of(at, "distance_after_1s"));
    speed(found.speed, of(at, "centre_acceleration"));
    spin(found.surface_speed, of(at, "r_times_angular_acceleration"));
  }
  page.rows.push_back(row(mode, "way down an incline in 1 s from rest [m]", distance, clock.seconds()));
  page.rows.push_back(row(mode, "speed down an incline after 1 s [m/s]", speed, clock.seconds()));
  page.rows.push_back(row(mode, "r times spin down an incline after 1 s [m/s]", spin, clock.seconds()));
}

Downhill slider(const Json& at, const Mode& mode) {
  const double r = of(at, "r");
  return {.friction = of(at, "mu"),
          .inertia = of(at, "I_over_m_r2") * r * r,
          .radius = r,
          .speed = of(at, "v0"),
          .forward_spin = of(at, "spin0"),
          .depth = depth_for(mode)};
}

void add_slides(Page& page, const Mode& mode) {
  const Clock clock;
  Comparison times, distance, speed;
  const bool stepping = std::holds_alternative<TimeStepping>(mode);
  for (const char* file : {"impacts_planar.json", "open_variants.json"}) {
    const Json all = reference(file, "slide_to_roll");
    for (const auto& at : all.is_array() ? all : all.at("cases")) {
      const double end = of(at, "t_roll") + 1.0;
      const Rolled found = rolled(slider(at, mode), end, mode);
      if (!stepping) times(found.sticks_at, of(at, "t_roll"));
      distance(found.distance, of(at, "x_roll") + of(at, "v_roll"));
      speed(found.speed, of(at, "v_roll"));
    }
  }
  const double cost = clock.seconds();
  double order = unknown;
  if (has_order(mode)) {
    const Json at = reference("impacts_planar.json", "slide_to_roll", "cases")[0];
    order = analytic::mean_order(2e-2, 4, 32, [&](double h) {
              return std::abs(rolled(slider(at, mode), 2.0, TimeStepping{.step = h}).distance -
                              of(at, "x_at_2s"));
            }).slope;
  }
  if (!stepping) page.rows.push_back(row(mode, "time at which sliding turns into rolling [s]", times, cost));
  page.rows.push_back(row(mode, "way 1 s after sliding has turned into rolling [m]", distance, cost, order));
  page.rows.push_back(row(mode, "speed of rolling [m/s]", speed, cost));
}

void add_bounces(Page& page, const Mode& mode) {
  const Clock clock;
  Comparison times, distance, speed;
  constexpr double r = 0.1;
  for (const auto& at : reference("impacts_planar.json", "bounce_then_roll", "cases")) {
    scenes::BodyScene scene = scenes::round_body(
        {.mass = 1.0, .inertia = 0.5 * r * r}, r,
        {.friction = of(at, "mu"), .normal_restitution = of(at, "e_n")}, 0.5, {2.0, 0.0}, 0.0);
    Simulation simulation(std::move(scene.system), mode);
    const std::vector<Impact> impacts = impacts_until(simulation, 10.0);
    const Json& first = at.at("first_impacts");
    for (std::size_t i = 0; i < std::min(first.size(), impacts.size()); ++i)
      times(impacts[i].time, of(first[i], "t"));
    distance(simulation.state().position(scene.body)[0], of(at, "x_at_10s"));
    speed(simulation.state().velocity(scene.body)[0], of(at, "v_roll"));
  }
  page.rows.push_back(
      row(mode, "times of impact of a disc that bounces, then rolls [s]", times, clock.seconds()));
  page.rows.push_back(row(mode, "place of that disc after 10 s [m]", distance, clock.seconds()));
  page.rows.push_back(row(mode, "speed of that disc after 10 s [m/s]", speed, clock.seconds()));
}

Curve speeds(const std::string& name, const Mode& mode) {
  const Json at = reference("impacts_planar.json", "slide_to_roll", "cases")[0];
  const Downhill body = slider(at, mode);
  scenes::BodyScene scene = scenes::downhill(body);
  Simulation simulation(std::move(scene.system), mode);
  Curve curve{.name = name, .columns = {"time [s]", "speed [m/s]", "r spin [m/s]"}, .rows = {}};
  for (int i = 0; i <= 100; ++i) {
    if (i > 0) simulation.run_until(0.01 * i);
    const State& state = simulation.state();
    curve.rows.push_back({0.01 * i, body.speed_of(state, scene.body), -body.radius * state.spin(scene.body)});
  }
  return curve;
}

}  // namespace

Page rolling() {
  Page page;
  page.name = "rolling";
  page.title = "Sliding and rolling";
  page.source = "closed forms, `impacts_planar.json`, `open_variants.json`";
  page.text =
      "Rings, discs and spheres of several inertias on inclines from rest (16 cases: they roll where μ ≥ tan "
      "φ/(1 + m r²/I)), thrown along a level floor until sliding turns into rolling (8 cases), and dropped "
      "with a horizontal speed so that they bounce, slide and roll (3 cases). e_t = 0.";
  page.figures = {
      {"rolling",
       "A disc thrown at 5 m/s along a floor, μ = 0.3: speed of the centre and of the rim; lines: "
       "event-driven, circles: time stepping with h = 0.02 s, dashed: the time in closed form."}};
  add_in_both_modes(page, TimeStepping{.step = 1e-3}, tight(), [](Page& to, const Mode& mode) {
    add_inclines(to, mode);
    add_slides(to, mode);
    add_bounces(to, mode);
  });
  page.curves = {speeds("rolling_events", tight()), speeds("rolling_stepping", TimeStepping{.step = 2e-2})};
  const Json at = reference("impacts_planar.json", "slide_to_roll", "cases")[0];
  page.curves.push_back({.name = "rolling_reference",
                         .columns = {"time [s]", "speed [m/s]"},
                         .rows = {{of(at, "t_roll"), of(at, "v_roll")}}});
  page.remarks =
      "Constant accelerations are followed exactly by both modes; where sliding ends, only the one step of "
      "time stepping in which it ends is wrong: order 2 in the mean. Of a disc that bounces each impact is "
      "noticed up to a step late, which changes the flights that follow; its final speed is right all the "
      "same, since it depends on the sum of the impulses only.";
  return page;
}

}  // namespace validation
