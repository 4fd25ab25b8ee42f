#include <carom/core/errors.h>
#include <carom/core/part_check.h>
#include <carom/integrators/run/time_resolution.h>
#include <carom/integrators/step_grid.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace carom {

namespace {

/// An end of a step this close to a wanted time, relative to the step, is that time.
constexpr double snap = 1e-9;

}  // namespace

double StepGrid::length() const {
  const auto* options = std::get_if<TimeStepping>(mode_);
  return options ? options->step : std::get<EventDriven>(*mode_).interval;
}

double StepGrid::closeness(double time) const {
  if (const auto* options = std::get_if<TimeStepping>(mode_)) return snap * options->step;
  // Components can go to any time; only the rounding of k intervals is not to be told apart.
  return 8.0 * std::numeric_limits<double>::epsilon() * std::max(1.0, std::abs(time));
}

double StepGrid::next(const Companion& companion) const {
  return companion.grid_start + static_cast<double>(companion.grid_steps + 1) * length();
}

void StepGrid::skip_to(Companion& companion, double time) const {
  companion.grid_steps = std::llround((time - companion.grid_start) / length());
  match(companion, time);
}

void StepGrid::match(Companion& companion, double time) const {
  const auto* const stepping = std::get_if<TimeStepping>(mode_);
  if (stepping != nullptr && stepping->control) return;  // goes along no grid
  const double present = companion.grid_start + static_cast<double>(companion.grid_steps) * length();
  if (!(std::abs(present - time) <= closeness(time))) restart_grid(companion, time);
}

void StepGrid::demand_times(const char* call, double time, const Companion& companion, double now) const {
  const double shortest = shortest_step_at(time);
  const auto* const stepping = std::get_if<TimeStepping>(mode_);
  const bool controlled = stepping != nullptr && stepping->control;
  const double longest = controlled ? stepping->control->largest : length();
  if (longest >= shortest && companion.rhythms.empty()) return;  // asked before every step
  const auto refuse = [&](const std::string& quantity, double length, double allowed) {
    throw ModelError(std::string(call) + ": " + quantity + " is " + to_text(length) +
                     " s; allowed: at least " + to_text(allowed) +
                     " s, or it is lost in the rounding of times around " + to_text(time) + " s");
  };
  if (longest < shortest) {
    refuse(controlled ? "control.largest" : stepping != nullptr ? "step" : "interval", longest, shortest);
  }
  const double apart = std::max(shortest, closeness(now));
  for (const Rhythm& rhythm : companion.rhythms) {
    if (rhythm.interval < apart) refuse("interval of a periodic event (every)", rhythm.interval, apart);
  }
}

void StepGrid::demand_interval(double interval, double now) const {
  const double shortest = std::max(shortest_step_at(now), closeness(now));
  if (!(std::isfinite(interval) && interval > 0.0)) {
    throw ModelError("every: interval is " + to_text(interval) + " s; allowed: finite and > 0");
  }
  if (interval < shortest) {
    throw ModelError("every: interval is " + to_text(interval) + " s; allowed: at least " +
                     to_text(shortest) + " s, the distance of times that are told apart at " + to_text(now) +
                     " s");
  }
}

void restart_grid(Companion& companion, double time) {
  companion.grid_start = time;
  companion.grid_steps = 0;
}

void skip_events(Companion& companion, double time) {
  for (Rhythm& rhythm : companion.rhythms) {
    // Periodic events keep their rhythm: those that the jump skips are not made up for.
    const double passed = std::floor((time - rhythm.start) / rhythm.interval);
    rhythm.fired = std::max<std::int64_t>(0, static_cast<std::int64_t>(passed));
  }
}

double next_due(const Companion& companion) {
  double next = std::numeric_limits<double>::infinity();
  for (const Rhythm& rhythm : companion.rhythms) next = std::min(next, rhythm.due());
  return next;
}

}  // namespace carom
