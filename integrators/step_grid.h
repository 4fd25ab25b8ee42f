#pragma once

/// \file
/// Times at which steps end: a grid from a start, cut by periodic events.

#include <carom/core/export.h>
#include <carom/integrators/run/companion.h>
#include <carom/integrators/simulation.h>

namespace carom {

/// Grid of the times of a mode. Start and steps made are those of a companion.
class CAROM_API StepGrid {
public:
  explicit StepGrid(const Mode& mode) : mode_(&mode) {}

  /// Distance of its times [s].
  [[nodiscard]] double length() const;
  /// Times nearer to each other than this are one, at a time [s].
  [[nodiscard]] double closeness(double time) const;
  /// Next time of the grid [s].
  [[nodiscard]] double next(const Companion& companion) const;
  /// Goes along the grid to a time, and begins it anew there if the time is not on it.
  void skip_to(Companion& companion, double time) const;
  /// Begins the grid anew at a time if that is not on it: a checkpoint may come from a run with another step
  /// or interval.
  void match(Companion& companion, double time) const;
  /// Demands that the steps of the mode and all periodic events move times up to this one. Throws ModelError.
  void demand_times(const char* call, double time, const Companion& companion, double now) const;
  /// Demands an interval of a periodic event that is finite, > 0 and moves times on. Throws ModelError.
  void demand_interval(double interval, double now) const;

private:
  const Mode* mode_;
};

/// Begins the grid anew at a time.
CAROM_API void restart_grid(Companion& companion, double time);
/// Moves periodic events to a time: those that the jump skips are not made up for.
CAROM_API void skip_events(Companion& companion, double time);
/// Time of the next periodic event, infinite if there is none [s].
[[nodiscard]] CAROM_API double next_due(const Companion& companion);

}  // namespace carom
