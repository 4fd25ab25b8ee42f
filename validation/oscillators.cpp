#include "validation/measure.h"
#include "validation/pages.h"
#include "validation/scenes.h"

namespace validation {
namespace {

scenes::ImpactOscillator oscillator_of(const Json& run) {
  return {.force = of(run, "F"),
          .frequency = of(run, "w"),
          .wall = of(run, "wall"),
          .restitution = of(run, "e"),
          .position = of(run, "x0"),
          .speed = of(run, "v0")};
}

std::vector<Impact> oscillator_impacts(const Json& run, double end, const Mode& mode) {
  scenes::BodyScene scene = scenes::impact_oscillator(oscillator_of(run));
  Simulation simulation(std::move(scene.system), mode);
  return impacts_until(simulation, end);
}

void add_oscillator(Page& page, const std::string& name, const Json& run, const Mode& mode) {
  const Json& impacts = run.at("impacts_t_vminus_vplus");
  const bool stepping = std::holds_alternative<TimeStepping>(mode);
  // Errors of time stepping grow from impact to impact: the first three are compared.
  const std::size_t compared = stepping ? 3 : impacts.size();
  const double end = impacts[compared - 1][0].get<double>() + 0.05;
  const auto errors = [&](const Mode& how, Comparison& times, Comparison& speeds) {
    const std::vector<Impact> found = oscillator_impacts(run, end, how);
    for (std::size_t i = 0; i < std::min(compared, found.size()); ++i) {
      times(found[i].time, impacts[i][0].get<double>());
      speeds(-found[i].after[0], impacts[i][2].get<double>());
    }
  };
  const Clock clock;
  Comparison times, speeds;
  errors(mode, times, speeds);
  const double cost = clock.seconds();
  double order = unknown;
  if (has_order(mode)) {
    order = analytic::mean_order(4e-3, 3, 32, [&](double h) {
              Comparison late, slow;
              errors(TimeStepping{.step = h}, late, slow);
              return std::abs(slow.obtained() - slow.reference());
            }).slope;
  }
  std::string title = name;
  std::replace(title.begin(), title.end(), '_', ' ');
  page.rows.push_back(row(mode, "time of impact, " + title + " [s]", times, cost));
  page.rows.push_back(row(mode, "speed after impact, " + title + " [m/s]", speeds, cost, order));
}

void add_grazing(Page& page) {
  const Clock clock;
  Comparison forces;
  // On the steady response x = F/(1 - w^2) cos(w t) a stop at s is met if F > s |1 - w^2|: by bisection.
  for (const auto& at : reference("contacts_planar.json", "impact_oscillator", "grazing_values")) {
    const double w = of(at, "w"), exact = of(at, "F_grazing");
    double low = 0.9 * exact, high = 1.1 * exact;
    for (int i = 0; i < 40; ++i) {
      const double middle = 0.5 * (low + high), amplitude = middle / (1.0 - w * w);
      // From half a period before the top.
      scenes::BodyScene scene = scenes::impact_oscillator({.force = amplitude > 0.0 ? -middle : middle,
                                                           .frequency = w,
                                                           .wall = of(at, "wall"),
                                                           .restitution = 0.8,
                                                           .position = -std::abs(amplitude)});
      Simulation simulation(std::move(scene.system), tight());
      simulation.run_until(1.2 * pi / w);
      (simulation.events().empty() ? low : high) = middle;
    }
    forces(0.5 * (low + high), exact);
  }
  page.rows.push_back(row(tight(), "force at which the stop is grazed [N]", forces, clock.seconds()));
}

Curve oscillator_course(const Json& run) {
  scenes::BodyScene scene = scenes::impact_oscillator(oscillator_of(run));
  Simulation simulation(std::move(scene.system), tight());
  Curve curve{.name = "oscillator_course", .columns = {"time [s]", "place [m]"}, .rows = {}};
  for (int i = 0; i <= 1200; ++i) {
    if (i > 0) simulation.run_until(0.02 * i);
    curve.rows.push_back({0.02 * i, simulation.state().position(scene.body)[0]});
  }
  return curve;
}

scenes::VibratingTable table_of(const Json& at) {
  // Thrown so that it lands at the first impact of the file with the speed of the orbit.
  const double down = -of(at, "take_off_speed"), back = of(at, "first_impact_time");
  return {.amplitude = of(at, "A"),
          .frequency = of(at, "w"),
          .restitution = of(at, "e"),
          .height = of(at, "A") * std::sin(of(at, "w") * back) - down * back - 0.5 * g * back * back,
          .speed = down + g * back};
}

void add_table(Page& page, const Json& at, const Mode& mode, int flights) {
  const double start = of(at, "first_impact_time"), period = of(at, "period");
  const double table = of(at, "A") * of(at, "w") * std::cos(of(at, "w") * start);
  const auto errors = [&](const Mode& how, Comparison& times, Comparison& speeds) {
    scenes::BodyScene scene = scenes::vibrating_table(table_of(at));
    Simulation simulation(std::move(scene.system), how);
    const std::vector<Impact> impacts = impacts_until(simulation, start + (flights - 0.5) * period);
    for (std::size_t i = 0; i < impacts.size(); ++i) {
      times(impacts[i].time, start + static_cast<double>(i) * period);
      speeds(impacts[i].after[0] + table, of(at, "take_off_speed"));
    }
  };
  const Clock clock;
  Comparison times, speeds;
  errors(mode, times, speeds);
  const double cost = clock.seconds();
  double order = unknown;
  if (has_order(mode)) {
    order = analytic::mean_order(1e-3, 4, 32, [&](double h) {
              Comparison late, fast;
              errors(TimeStepping{.step = h}, late, fast);
              return std::abs(late.obtained() - late.reference());
            }).slope;
  }
  page.rows.push_back(row(mode, "time of impact of the stable orbit [s]", times, cost, order));
  page.rows.push_back(row(mode, "take-off speed against the ground [m/s]", speeds, cost));
}

/// By how much a small error of the take-off speed grows over `flights` flights of a period-1 orbit.
double growth(double e, int n, double gamma, int flights) {
  constexpr double error = 1e-6, w = 50.0;
  const double c = n * pi * (1.0 - e) / ((1.0 + e) * gamma);
  const double size = gamma * g / (w * w), phase = std::acos(c), speed = n * pi * g / w;
  scenes::BodyScene scene = scenes::vibrating_table({.amplitude = size,
                                                     .frequency = w,
                                                     .phase = phase,
                                                     .restitution = e,
                                                     .height = size * std::sin(phase),
                                                     .speed = speed * (1.0 + error)});
  Simulation simulation(std::move(scene.system), tight());
  simulation.run_until((flights + 0.5) * n * 2.0 * pi / w);
  const EventRecord& last = simulation.events().back();
  const double table = size * w * std::cos(w * last.time + phase);
  return std::abs((last.velocity_after[0] + table) / speed - 1.0) / error;
}

void add_stability(Page& page, const Json& rows) {
  const Clock clock;
  Comparison borders;
  for (const auto& at : rows) {
    const double e = of(at, "e");
    const int n = at.at("n").get<int>();
    // The orbit is stable where errors shrink from flight 40 to flight 60.
    double low = 0.95 * of(at, "Gamma_high"), high = 1.05 * of(at, "Gamma_high");
    for (int i = 0; i < 14; ++i) {
      const double middle = 0.5 * (low + high);
      (growth(e, n, middle, 60) < growth(e, n, middle, 40) ? low : high) = middle;
    }
    borders(0.5 * (low + high), of(at, "Gamma_high"));
  }
  page.rows.push_back(
      row(tight(), "Γ at which the orbit of period 1 loses its stability", borders, clock.seconds()));
}

Curve table_course(const Json& at) {
  scenes::BodyScene scene = scenes::vibrating_table(table_of(at));
  Simulation simulation(std::move(scene.system), tight());
  Curve curve{.name = "table_course", .columns = {"time [s]", "ball [m]", "table [m]"}, .rows = {}};
  for (int i = 0; i <= 600; ++i) {
    if (i > 0) simulation.run_until(1e-3 * i);
    curve.rows.push_back({1e-3 * i, simulation.state().position(scene.body)[1],
                          of(at, "A") * std::sin(of(at, "w") * 1e-3 * i)});
  }
  return curve;
}

}  // namespace

Page impact_oscillator() {
  Page page;
  page.name = "impact_oscillator";
  page.title = "Impact oscillator";
  page.source = "exact piecewise solution, roots to 40 digits, `contacts_planar.json`";
  page.text =
      "x″ + x = F cos(ω t) with a rigid stop: three runs of six to twelve impacts, of which one comes near "
      "to grazing, and the force at which the steady motion grazes the stop. Impacts are up to 160 s from "
      "the start.";
  page.figures = {
      {"impact_oscillator", "The run *impacting*: event-driven; dots: impacts of the reference."}};
  const Json runs = reference("contacts_planar.json", "impact_oscillator", "runs");
  add_in_both_modes(page, TimeStepping{.step = 1e-4}, tight(), [&](Page& to, const Mode& mode) {
    for (const auto& [name, run] : runs.items()) add_oscillator(to, name, run, mode);
  });
  add_grazing(page);
  const Json& shown = runs.at("impacting");
  Curve impacts{.name = "oscillator_impacts", .columns = {"time [s]", "place [m]"}, .rows = {}};
  for (const auto& at : shown.at("impacts_t_vminus_vplus"))
    impacts.rows.push_back({at[0].get<double>(), of(shown, "wall")});
  page.curves = {oscillator_course(shown), impacts};
  page.remarks =
      "Of time stepping only the first three impacts are compared: every impact multiplies the error of the "
      "one before.";
  return page;
}

Page vibrating_table() {
  Page page;
  page.name = "vibrating_table";
  page.title = "Ball on a vibrating table";
  page.source = "Holmes, J. Sound Vib. 84 (1982) 173; exact map, `contacts_planar.json`";
  page.text =
      "A ball bounces on a table y = A sin(ω t), Γ = A ω²/g. Its orbit with one bounce in n periods of the "
      "table is known in closed form, and so is the Γ at which it loses its stability by period doubling.";
  page.figures = {{"vibrating_table",
                   "The orbit with one bounce per period, e = 0.8, Γ = 0.6, ω = 50 rad/s; event-driven."}};
  const Json data = reference("contacts_planar.json", "vibrating_table");
  add_with_options(page, TimeStepping{.step = 1e-4},
                   [&](Page& to, const Mode& mode) { add_table(to, data.at("example"), mode, 3); });
  add_table(page, data.at("example"), tight(), 11);
  add_stability(page, data.at("rows"));
  page.curves = {table_course(data.at("example"))};
  page.remarks =
      "The border of stability is found by asking whether an error of 1e-6 shrinks from the 40th to the 60th "
      "flight; near the border it shrinks slowly, and terms of second order shift the answer a little.";
  return page;
}

}  // namespace validation
