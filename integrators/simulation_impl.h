#pragma once

/// \file
/// The parts of a Simulation, behind its public header.

#include <carom/integrators/call_guard.h>
#include <carom/integrators/callbacks.h>
#include <carom/integrators/event_driven/impact_list.h>
#include <carom/integrators/run/companion.h>
#include <carom/integrators/running_model.h>
#include <carom/integrators/simulation.h>
#include <carom/integrators/step_grid.h>

#include <cstddef>
#include <cstdint>
#include <exception>
#include <memory>
#include <utility>
#include <vector>

namespace carom {

/// Mode, model and state of a run, and all who wait for its steps.
struct Simulation::Impl {
  Impl(System system, Mode chosen)
      : mode(std::move(chosen)), model(std::make_unique<RunningModel>(std::move(system), mode, stop)) {
    state = model->assembly.initial_state();
    RunningModel::Prepared start = model->prepare(state);
    report.projected = start.projected;
    report.findings = model->findings(std::move(start));
    forget_history();
    companion.ledger.open(model->stored_energies(state));
  }

  /// Books a change of the state from outside. \param stored energies of the new state, asked for before
  /// anything was changed: potentials of the user may throw
  void book_intervention(const StoredEnergies& stored) {
    companion.ledger.book(EnergyFlow::intervention, stored.total() - companion.ledger.total(), stored);
  }
  /// Memory of a run from step to step is void after the state was changed from outside.
  void forget_history() {
    companion.modes.clear();
    companion.rounding.assign(state.v.size(), 0.0);
    companion.history.known = 0;
    companion.joints.clear();
    companion.iterations.clear();
    companion.closings = {};
    companion.loads.valid = false;
    if (model->machines.driver) model->machines.driver->forget();
  }
  /// The grid of times of the mode.
  [[nodiscard]] StepGrid grid() const { return StepGrid(mode); }
  /// True if somebody sees what happens between the times asked for.
  [[nodiscard]] bool looked_at() const {
    return callbacks.has_observers() || progress || stop.asks() || log.enabled(LogLevel::error);
  }
  /// Lists the contacts of a step that nobody has looked at so far.
  void list_impacts() { carom::list_impacts(events, std::exchange(unlisted, 0), report); }
  enum class Stops { on_grid, where_seen };
  void step(Simulation& simulation, double limit, Stops stops);
  void call_actions(Simulation& simulation, std::vector<std::exception_ptr>& thrown);
  void rethrow(const std::vector<std::exception_ptr>& thrown);
  [[nodiscard]] std::int64_t events_counted() const;
  void write_to_log(std::int64_t told);
  void show_findings();

  CallGuard guard;
  StopRequest stop;
  Mode mode;
  std::unique_ptr<RunningModel> model;
  State state;
  Companion companion;
  StepReport report;
  RecordedEvents events;
  std::size_t unlisted = 0;  // of the latest events
  Callbacks callbacks;
  Log log;
  bool report_seen = false, log_taken = false, findings_written = false, progress = false;
};

}  // namespace carom
