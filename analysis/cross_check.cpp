// Problem: the distance between the two modes as a function of the step.

#include <carom/analysis/cross_check.h>
#include <carom/core/assembly.h>
#include <carom/core/text_table.h>
#include <carom/integrators/run/time_resolution.h>
#include <carom/integrators/simulation.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <ostream>

namespace carom {

namespace {

// Numbers of runs that somebody may wait for.
constexpr int most_steps = 100'000;

[[noreturn]] void refuse(const char* option, const std::string& value, const std::string& allowed) {
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
  if (options.probes < 0 || options.probes > most_steps) {
    refuse("probes", std::to_string(options.probes), "0 to " + std::to_string(most_steps));
  }
  if (options.time_stepping.control) refuse("time_stepping.control", "given", "steps of fixed length");
}

/// Slope of the least-squares line through logarithms, outliers left out; NaN where an error is at rounding.
double order(const CrossCheck& check, double CrossCheckLevel::*error) {
  std::vector<const CrossCheckLevel*> levels;
  for (const CrossCheckLevel& level : check.levels) {
    const bool out =
        std::any_of(check.outliers.begin(), check.outliers.end(),
                    [&](const CrossCheckOutlier& outlier) { return outlier.level.step == level.step; });
    if (!out) levels.push_back(&level);
  }
  double x = 0.0, y = 0.0;
  for (const CrossCheckLevel* level : levels) {
    if (!(level->*error > 0.0)) return std::numeric_limits<double>::quiet_NaN();
    x += std::log(level->step);
    y += std::log(level->*error);
  }
  x /= static_cast<double>(levels.size());
  y /= static_cast<double>(levels.size());
  double xx = 0.0, xy = 0.0;
  for (const CrossCheckLevel* level : levels) {
    const double dx = std::log(level->step) - x;
    xx += dx * dx;
    xy += dx * (std::log(level->*error) - y);
  }
  return xy / xx;
}

/// \param numbers not empty
double median(std::vector<double> numbers) {
  const auto middle = numbers.begin() + static_cast<std::ptrdiff_t>(numbers.size() / 2);
  std::nth_element(numbers.begin(), middle, numbers.end());
  return *middle;
}

/// Both modes up to the end, the event-driven one looked at where steps end.
CrossCheckLevel compare(const System& system, const CrossCheckOptions& options, double step) {
  TimeStepping stepping = options.time_stepping;
  stepping.step = step;
  EventDriven events = options.event_driven;
  events.record_events = false;
  Simulation stepped(system, stepping);
  Simulation exact(system, events);
  for (Simulation* const run : {&stepped, &exact}) run->stop_when(options.stop_when);
  const Layout& layout = *stepped.assembly().layout();
  const std::vector<double> lengths = stepped.assembly().length_scales();
  CrossCheckLevel level;
  level.step = step;
  Index worst = none;
  while (stepped.time() < options.end) {
    stepped.run_until(std::min(stepped.time() + step, options.end));
    exact.run_until(stepped.time());
    double fastest = 0.0;
    for (Index place = 0; place < static_cast<Index>(layout.bodies().size()); ++place) {
      const BodySlot body = layout.bodies()[place];
      for (Index i = 0; i < body.v_size; ++i) {
        const double length = lengths[body.v + i];
        const double speed = std::abs(stepped.state().v[body.v + i] - exact.state().v[body.v + i]) * length;
        fastest = std::max(fastest, speed);
        // Coordinates and velocities correspond one to one wherever bodies have angles, not quaternions.
        if (i >= body.q_size) continue;
        const double apart = std::abs(stepped.state().q[body.q + i] - exact.state().q[body.q + i]) * length;
        if (!(apart > level.position_error)) continue;
        level.position_error = apart;
        worst = place;
      }
    }
    level.velocity_error += step * fastest;
  }
  if (worst != none) level.body = system.name(layout.id(worst));
  return level;
}

}  // namespace

std::vector<double> spread_steps(double largest, double smallest, int count) {
  if (!(smallest > 0.0 && largest > smallest && std::isfinite(largest))) {
    refuse("the range of steps", to_text(smallest) + " to " + to_text(largest),
           "0 < smallest < largest, in s");
  }
  if (count < 2 || count > most_steps) {
    refuse("the number of steps", std::to_string(count), "2 to " + std::to_string(most_steps));
  }
  constexpr double golden = 0.6180339887498949;
  std::vector<double> steps;
  steps.reserve(static_cast<std::size_t>(count));
  const double spacing = std::log(smallest / largest) / count;
  for (int i = 0; i < count; ++i) {
    steps.push_back(largest * std::exp(spacing * (i + std::fmod(golden * i, 1.0))));
  }
  return steps;
}

std::vector<CrossCheckOutlier> find_outliers(const std::vector<CrossCheckLevel>& all) {
  std::vector<const CrossCheckLevel*> levels;
  for (const CrossCheckLevel& level : all) {
    if (level.position_error > 0.0) levels.push_back(&level);
  }
  std::vector<double> slopes, heights;
  for (const CrossCheckLevel* const a : levels) {
    for (const CrossCheckLevel* const b : levels) {
      if (!(a->step < b->step)) continue;
      slopes.push_back(std::log(b->position_error / a->position_error) / std::log(b->step / a->step));
    }
  }
  if (slopes.empty()) return {};
  const double slope = median(slopes);
  const auto height = [slope](const CrossCheckLevel& level) {
    return std::log(level.position_error) - slope * std::log(level.step);
  };
  for (const CrossCheckLevel* const level : levels) heights.push_back(height(*level));
  const double line = median(heights);
  std::vector<CrossCheckOutlier> outliers;
  for (const CrossCheckLevel* const level : levels) {
    if (height(*level) - line <= std::log(outlier_factor)) continue;
    outliers.push_back({*level, std::exp(line + slope * std::log(level->step))});
  }
  const auto excess = [](const CrossCheckOutlier& outlier) {
    return outlier.level.position_error / outlier.expected;
  };
  std::stable_sort(
      outliers.begin(), outliers.end(),
      [&](const CrossCheckOutlier& a, const CrossCheckOutlier& b) { return excess(a) > excess(b); });
  return outliers;
}

CrossCheck cross_check(const System& system, const CrossCheckOptions& options) {
  check(options);
  CrossCheck result;
  for (const double step : options.steps) result.levels.push_back(compare(system, options, step));
  if (options.probes > 0) {
    constexpr double range = 4.0;
    const double largest = *std::max_element(options.steps.begin(), options.steps.end());
    const int count = std::max(options.probes, 2);  // the first is the largest step itself
    for (const double step : spread_steps(largest, largest / range, count)) {
      const bool done = std::find(options.steps.begin(), options.steps.end(), step) != options.steps.end();
      if (!done) result.probes.push_back(compare(system, options, step));
    }
  }
  std::vector<CrossCheckLevel> all = result.levels;
  all.insert(all.end(), result.probes.begin(), result.probes.end());
  result.outliers = find_outliers(all);
  result.position_order = order(result, &CrossCheckLevel::position_error);
  result.velocity_order = order(result, &CrossCheckLevel::velocity_error);
  return result;
}

std::ostream& operator<<(std::ostream& out, const CrossCheck& check) {
  TextTable table({"step [s]", "positions [m]", "velocities, over time [m]"});
  for (const CrossCheckLevel& level : check.levels) {
    table.add({cell(level.step, 4), cell(level.position_error, 4), cell(level.velocity_error, 4)});
  }
  out << table.text();
  out << "order observed: positions " << cell(check.position_order, 4) << ", velocities "
      << cell(check.velocity_order, 4) << '\n'
      << "outliers: ";
  if (check.outliers.empty()) out << "none";
  if (!check.outliers.empty()) out << check.outliers.size();
  out << " of " << check.levels.size() + check.probes.size() << " steps\n";
  for (const CrossCheckOutlier& outlier : check.outliers) {
    out << "  step " << cell(outlier.level.step, 4) << " s: positions "
        << cell(outlier.level.position_error, 4) << " m apart at " << outlier.level.body << ", "
        << cell(outlier.expected, 4) << " m expected\n";
  }
  return out;
}

}  // namespace carom
