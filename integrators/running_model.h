#pragma once

/// \file
/// A model assembled for a run, with the machines of its mode; an edit replaces it as a whole.

#include <carom/core/assembly.h>
#include <carom/integrators/event_driven/event_driver.h>
#include <carom/integrators/run/stop_request.h>
#include <carom/integrators/simulation.h>
#include <carom/integrators/time_stepping/phased_steps.h>
#include <carom/integrators/time_stepping/step_controller.h>
#include <carom/integrators/time_stepping/time_stepper.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace carom {

/// A run as a machine advances it: state, companion, and what is told of it.
struct Run {
  const Mode& mode;
  State& state;
  Companion& companion;
  StepReport& report;
  RecordedEvents& events;
  std::size_t& unlisted;  ///< latest events, whose impacts the report is still to list (list_impacts())
};

/// Machines of a mode, over one assembly.
struct ModeMachines {
  ModeMachines(const Assembly& assembly, const Mode& mode, const StopRequest& request);
  /// Detector of contacts.
  [[nodiscard]] const Detector& detector() const {
    return stepper ? stepper->detector() : driver->detector();
  }

  /// One step, to the next time of the grid (StepGrid), or to a time before it [s].
  void advance(const Run& run, double limit);
  /// In the event-driven mode: to a time at once, without output in between. Impacts are left unlisted. Where
  /// that fails, the state is that of the last interval before the failure; where it is interrupted, the run
  /// stands at a time that was reached before.
  void advance_unseen(const Run& run, double limit);

  std::unique_ptr<TimeStepper> stepper;        ///< null in the event-driven mode
  std::unique_ptr<StepController> controller;  ///< null in the event-driven mode
  std::unique_ptr<PhasedSteps> phased;         ///< null where steps have one phase
  std::unique_ptr<EventDriver> driver;         ///< null in time stepping
  const StopRequest* stop;                     ///< asked within steps

private:
  void advance_while_good(const Run& run, double limit);
  void stand_where_reached(const Run& run);
};

/// Assembly and machines.
struct RunningModel {
  RunningModel(System system, const Mode& mode, const StopRequest& stop)
      : assembly(std::move(system)), machines(assembly, mode, stop) {}
  /// A state that a run may start from, now.
  struct Prepared {
    double projected = 0.0;               ///< largest displacement of a body to get there [m]
    std::optional<ModelFinding> finding;  ///< joints that were open
  };
  /// Brings a state onto the joints, and refuses one that a run cannot start from.
  [[nodiscard]] Prepared prepare(State& start) const;
  /// A state of this model: bodies and elements of another one go on by identity, new ones start as
  /// described.
  [[nodiscard]] State continued(const State& other) const;
  /// Findings of System::check(), and that of prepare().
  [[nodiscard]] std::vector<ModelFinding> findings(Prepared start) const;
  /// Energies that are stored in a state.
  [[nodiscard]] StoredEnergies stored_energies(const State& state) const;
  /// Reaction of a joint (Simulation::reaction). Throws ModelError.
  [[nodiscard]] JointReaction reaction(const State& state, const Companion& companion,
                                       const StepReport& report, JointId joint) const;

  Assembly assembly;
  ModeMachines machines;
};

}  // namespace carom
