// Problem: the distance between the two modes as a function of the step.

#include <carom/analysis/cross_check.h>
#include <carom/core/text_table.h>
#include <carom/integrators/simulation.h>
#include <carom/integrators/time_resolution.h>

#include <algorithm>
#include <cmath>
#include <ostream>

namespace carom {

namespace {

[[noreturn]] void refuse(const char* option, const std::string& value, const char* allowed) {
  throw ModelError(std::string("cross check: ") + option + " is " + value + "; allowed: " + allowed);
}

void check(const CrossCheckOptions& options) {
  if (!(std::isfinite(options.end) && options.end > 0.0)) {
    refuse("end", to_text(options.end), "finite and > 0 s");
  }
  if (options.steps.size() < 5)
    refuse("the number of steps", std::to_string(options.steps.size()), "at least 5");
  for (const double step : options.steps) {
    if (!(step > 0.0 && step < options.end)) refuse("a step", to_text(step), "> 0 s and below the end");
    if (step < shortest_step_at(options.end)) {
      refuse("a step", to_text(step), "> 0 s and not lost in the rounding of the end");
    }
  }
  if (options.time_stepping.control) refuse("time_stepping.control", "given", "steps of fixed length");
}

/// Slope of the least-squares line through logarithms; NaN where an error is at rounding.
double order(const std::vector<CrossCheckLevel>& levels, double CrossCheckLevel::*error) {
  double x = 0.0, y = 0.0;
  for (const CrossCheckLevel& level : levels) {
    if (!(level.*error > 0.0)) return std::numeric_limits<double>::quiet_NaN();
    x += std::log(level.step);
    y += std::log(level.*error);
  }
  x /= static_cast<double>(levels.size());
  y /= static_cast<double>(levels.size());
  double xx = 0.0, xy = 0.0;
  for (const CrossCheckLevel& level : levels) {
    const double dx = std::log(level.step) - x;
    xx += dx * dx;
    xy += dx * (std::log(level.*error) - y);
  }
  return xy / xx;
}

}  // namespace

std::vector<double> spread_steps(double largest, double smallest, int count) {
  if (!(smallest > 0.0 && largest > smallest && std::isfinite(largest))) {
    refuse("the range of steps", to_text(smallest) + " to " + to_text(largest),
           "0 < smallest < largest, in s");
  }
  if (count < 2) refuse("the number of steps", std::to_string(count), "at least 2");
  constexpr double golden = 0.6180339887498949;
  std::vector<double> steps;
  steps.reserve(static_cast<std::size_t>(count));
  const double spacing = std::log(smallest / largest) / count;
  for (int i = 0; i < count; ++i) {
    steps.push_back(largest * std::exp(spacing * (i + std::fmod(golden * i, 1.0))));
  }
  return steps;
}

CrossCheck cross_check(const System& system, const CrossCheckOptions& options) {
  check(options);
  CrossCheck result;
  for (const double step : options.steps) {
    TimeStepping stepping = options.time_stepping;
    stepping.step = step;
    EventDriven events = options.event_driven;
    events.record_events = false;
    Simulation stepped(system, stepping);
    Simulation exact(system, events);
    for (Simulation* const run : {&stepped, &exact}) run->stop_when(options.stop_when);
    const std::vector<double> lengths = stepped.assembly().length_scales();
    CrossCheckLevel& level = result.levels.emplace_back();
    level.step = step;
    while (stepped.time() < options.end) {
      stepped.run_until(std::min(stepped.time() + step, options.end));
      exact.run_until(stepped.time());
      double fastest = 0.0;
      for (const BodySlot& body : stepped.assembly().layout()->bodies()) {
        for (Index i = 0; i < body.v_size; ++i) {
          const double length = lengths[body.v + i];
          const double speed = std::abs(stepped.state().v[body.v + i] - exact.state().v[body.v + i]) * length;
          fastest = std::max(fastest, speed);
          // Coordinates and velocities correspond one to one wherever bodies have angles, not quaternions.
          if (i >= body.q_size) continue;
          const double apart = std::abs(stepped.state().q[body.q + i] - exact.state().q[body.q + i]) * length;
          level.position_error = std::max(level.position_error, apart);
        }
      }
      level.velocity_error += step * fastest;
    }
  }
  result.position_order = order(result.levels, &CrossCheckLevel::position_error);
  result.velocity_order = order(result.levels, &CrossCheckLevel::velocity_error);
  return result;
}

std::ostream& operator<<(std::ostream& out, const CrossCheck& check) {
  TextTable table({"step [s]", "positions [m]", "velocities, over time [m]"});
  for (const CrossCheckLevel& level : check.levels) {
    table.add({cell(level.step, 4), cell(level.position_error, 4), cell(level.velocity_error, 4)});
  }
  out << table.text();
  return out << "order observed: positions " << cell(check.position_order, 4) << ", velocities "
             << cell(check.velocity_order, 4) << '\n';
}

}  // namespace carom
