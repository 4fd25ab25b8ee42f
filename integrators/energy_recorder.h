#pragma once

/// \file
/// Records the trace of a run.

#include <carom/core/energy_trace.h>
#include <carom/core/export.h>
#include <carom/integrators/callback_id.h>

#include <memory>
#include <vector>

namespace carom {

class Simulation;

/// Records a simulation into an EnergyTrace: a row for the state at which it is attached, then rows at chosen
/// times, and every impact of every step as an event. Recording does not change the run, except that steps
/// end exactly at the times of an interval (Simulation::every(), so it counts as a periodic event in
/// checkpoints). Rows must not go back in time: after set_state() or load() to an earlier time, the next row
/// is refused with a ModelError; use a new recorder.
class CAROM_API EnergyRecorder {
public:
  /// When to record. By default at every step; give at most one of the two.
  struct Options {
    int every_steps = 0;  ///< after every so many steps; 0: not by steps, unless no interval is given either
    double interval = 0.0;  ///< when this time has passed, twice this time, ... from now; 0: no interval [s]
  };

  /// Records at every step until the simulation ends or detach().
  explicit EnergyRecorder(Simulation& simulation);
  /// Records at chosen times until the simulation ends or detach(). Throws ModelError for a negative or not
  /// finite option or if both are given.
  EnergyRecorder(Simulation& simulation, const Options& options);

  /// The trace recorded so far.
  [[nodiscard]] const EnergyTrace& trace() const;
  /// Ends the recording of this simulation, and that its steps end at the times of the interval. Throws
  /// ModelError if the simulation is not the one that is recorded, or no longer is.
  void detach(Simulation& simulation);

private:
  struct Impl;
  std::shared_ptr<Impl> impl_;
  CallbackId observer_;
  CallbackId action_;  // of an interval, else of no function
};

/// Runs to each of the listed times in turn, steps ending exactly there, and records a row at the present and
/// at each of them, and the impacts between. Throws ModelError, before the run, for times that are not
/// finite, not increasing or not later than the present; otherwise as Simulation::run_until().
[[nodiscard]] CAROM_API EnergyTrace record_at(Simulation& simulation, const std::vector<double>& times);

}  // namespace carom
