#pragma once

/// \file
/// Times at which steps end: a grid from a start, cut by periodic events.

#include <carom/core/export.h>
#include <carom/integrators/run/companion.h>
#include <carom/integrators/run/time_resolution.h>
#include <carom/integrators/simulation.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

namespace carom {

/// Grid of the times of a mode. Start and steps made are those of a companion.
class CAROM_API StepGrid {
public:
  explicit StepGrid(const Mode& mode) : mode_(&mode) {}

  /// Distance of its times [s].
  [[nodiscard]] double length() const {
    const auto* const stepping = std::get_if<TimeStepping>(mode_);
    return stepping != nullptr ? stepping->step : std::get_if<EventDriven>(mode_)->interval;
  }
  /// Times nearer to each other than this are one, at a time [s].
  [[nodiscard]] double closeness(double time) const {
    // An end of a step this close to a wanted time, relative to the step, is that time.
    constexpr double snap = 1e-9;
    if (const auto* const stepping = std::get_if<TimeStepping>(mode_)) return snap * stepping->step;
    // Components can go to any time; only the rounding of k intervals is not to be told apart.
    return 8.0 * std::numeric_limits<double>::epsilon() * std::max(1.0, std::abs(time));
  }
  /// Next time of the grid [s].
  [[nodiscard]] double next(const Companion& companion) const {
    return companion.grid_start + static_cast<double>(companion.grid_steps + 1) * length();
  }
  /// Goes along the grid to a time, and begins it anew there if the time is not on it.
  void skip_to(Companion& companion, double time) const;
  /// Begins the grid anew at a time if that is not on it: a checkpoint may come from a run with another step
  /// or interval.
  void match(Companion& companion, double time) const;
  /// Demands that the steps of the mode and all periodic events move times up to this one. Throws ModelError.
  void demand_times(const char* call, double time, const Companion& companion, double now) const {
    const double shortest = shortest_step_at(time);
    if (longest() >= shortest && companion.rhythms.empty()) return;  // asked before every step
    refuse_times(call, time, companion, now);
  }
  /// Demands an interval of a periodic event that is finite, > 0 and moves times on. Throws ModelError.
  void demand_interval(double interval, double now) const;

private:
  // The longest step of the mode, as described [s].
  [[nodiscard]] double longest() const {
    const auto* const stepping = std::get_if<TimeStepping>(mode_);
    return stepping != nullptr && stepping->control ? stepping->control->largest : length();
  }
  // Demands times, one by one.
  void refuse_times(const char* call, double time, const Companion& companion, double now) const;

  const Mode* mode_;
};

/// Begins the grid anew at a time.
CAROM_API void restart_grid(Companion& companion, double time);
/// Moves periodic events to a time: those that the jump skips are not made up for.
CAROM_API void skip_events(Companion& companion, double time);
/// Time of the next periodic event, infinite if there is none [s].
[[nodiscard]] inline double next_due(const Companion& companion) {
  double next = std::numeric_limits<double>::infinity();
  for (const Rhythm& rhythm : companion.rhythms) next = std::min(next, rhythm.due());
  return next;
}

}  // namespace carom
