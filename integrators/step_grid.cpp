#include <carom/core/errors.h>
#include <carom/core/part_check.h>
#include <carom/integrators/run/time_resolution.h>
#include <carom/integrators/step_grid.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace carom {

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

void StepGrid::refuse_times(const char* call, double time, const Companion& companion, double now) const {
  const double shortest = shortest_step_at(time), longest = this->longest();
  const auto* const stepping = std::get_if<TimeStepping>(mode_);
  const bool controlled = stepping != nullptr && stepping->control;
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

}  // namespace carom
