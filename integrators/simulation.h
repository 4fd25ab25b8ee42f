#pragma once

/// \file
/// A model that runs: state, companion, and the mode that advances them.

#include <carom/core/assembly.h>
#include <carom/core/export.h>
#include <carom/core/joint_closure.h>
#include <carom/core/log.h>
#include <carom/core/state.h>
#include <carom/core/system.h>
#include <carom/integrators/companion.h>
#include <carom/integrators/event_driven.h>
#include <carom/integrators/event_log.h>
#include <carom/integrators/step_report.h>
#include <carom/integrators/time_stepping.h>

#include <functional>
#include <memory>
#include <string>
#include <variant>
#include <vector>

namespace carom {

/// The modes of integration, as values.
using Mode = std::variant<TimeStepping, EventDriven>;

/// Takes a copy of a system and runs it. Every advance works on a trial and commits it when accepted: after
/// an error the simulation stands at the last good state and can be saved, inspected and continued.
class CAROM_API Simulation {
public:
  using Observer = std::function<void(const Simulation&)>;
  using Action = std::function<void(Simulation&)>;

  /// Assembles `system`, with its described positions and velocities, at time 0. Where these do not obey the
  /// joints they are corrected (joint_closure.h); report().projected tells the largest displacement. Throws
  /// ModelError for a model or options that cannot be, in the event-driven mode for bodies deeper in
  /// obstacles than EventDriven::gap_tolerance too; so do edit() and set_state().
  Simulation(System system, Mode mode);
  ~Simulation();
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;

  /// Makes one step of the mode's length (EventDriven: of its interval), shorter where a periodic event is
  /// due before its end. Throws SolverError; the simulation then stands where it stood.
  const StepReport& step();
  /// Runs until exactly `time` [s]. Throws ModelError for a time that is not finite or in the past,
  /// SolverError as step(): the simulation then stands at the last good state.
  void run_until(double time);

  /// Calls `observer` after every accepted step. Observers cannot change the run.
  void observe(Observer observer);
  /// Calls `action` when `interval` [s], twice `interval`, ... have passed from now; steps end exactly there.
  /// Actions may change the state or edit the model. Throws ModelError for an interval that is not > 0.
  void every(double interval, Action action);

  /// Changes a copy of the model, assembles it and maps the state by identity; new bodies start as described.
  /// An error changes nothing. Energy brought in or taken out is booked as `intervention`.
  void edit(const std::function<void(System&)>& change);
  /// Replaces the state (time included); positions and velocities are corrected to obey the joints. Throws
  /// ModelError naming the body for numbers that are not finite. Energy brought in or taken out is booked as
  /// `intervention`. Which contacts stuck and slipped is forgotten: in the event-driven mode it is decided
  /// from the state, in time stepping a contact sticks if its speed is exactly zero.
  void set_state(const State& state);
  /// Goes on in another mode, or with other options, from the same state. From time stepping to the
  /// event-driven mode, bodies may have sunk into obstacles: contacts that approach there are resolved by an
  /// impact, then bodies are moved out by the smallest displacement in the sense of their masses; energies
  /// are booked as `mode_switch`, the largest displacement is told by report().projected. Throws as the
  /// constructor, and SolverError where bodies cannot be moved out; the mode then stays as it is.
  void switch_to(Mode mode);

  /// Counts the degrees of freedom that joints leave at the present state, and names redundant joints.
  [[nodiscard]] Mobility mobility() const;

  /// What a joint does to its body `to`, forces at the present time. In time stepping the mean over the last
  /// step. Before the first step no contact is known: forces are those without. Of a redundant joint one of
  /// many possible ones. Throws ModelError for a joint that is not of this model or only limits.
  [[nodiscard]] JointReaction reaction(JointId joint) const;

  [[nodiscard]] const System& system() const;          ///< the model
  [[nodiscard]] const Assembly& assembly() const;      ///< the model, made ready to run
  [[nodiscard]] const State& state() const;            ///< the state
  [[nodiscard]] double time() const;                   ///< [s]
  [[nodiscard]] const EnergyLedger& energy() const;    ///< the energy ledger
  [[nodiscard]] const StepReport& report() const;      ///< what happened in the last step
  [[nodiscard]] const Statistics& statistics() const;  ///< counts since the start
  /// Counts of the contact solvers since the start, over all sweeps of accepted steps.
  [[nodiscard]] const ChainStatistics& contact_statistics() const;
  /// Events of the event-driven mode so far, in time (EventDriven::record_events).
  [[nodiscard]] const std::vector<EventRecord>& events() const;
  /// Forgets these.
  void clear_events();
  /// Writes these as CSV (event_log.h). Throws FileError.
  void write_events(const std::string& path) const;
  [[nodiscard]] const Companion& companion() const;  ///< all that can influence a later step
  [[nodiscard]] const Mode& mode() const;            ///< the mode and its options

  /// "particle 'lower' on half-plane #0".
  [[nodiscard]] std::string name(const ContactKey& key) const;
  /// The part of an event of any kind: its contact, as above; the force element with its bodies, "cable
  /// 'rope' between ground and particle 'ball'"; the driver or obstacle whose law of time jumps.
  [[nodiscard]] std::string name(const EventRecord& event) const;

  /// Where worthwhile news is written; quiet until given a sink.
  [[nodiscard]] Log& log();
  /// Draws a progress bar during run_until() where the standard error is a terminal and the run is long.
  void show_progress(bool on);

  /// Saves state and companion with a fingerprint of the model. Throws FileError.
  void save(const std::string& path) const;
  /// Loads what save() wrote; a time-stepping run then continues bit for bit, an event-driven one starts its
  /// integrators anew and continues within their tolerance. Periodic events must have been
  /// set up as they were. Throws FileError for a file that cannot be read or is of another model; the
  /// simulation then stands where it stood.
  void load(const std::string& path);

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace carom
