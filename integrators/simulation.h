#pragma once

/// \file
/// The simulation of a model: its state, all that influences later steps, and the mode that advances them.

#include <carom/core/dynamics/joint_closure.h>
#include <carom/core/energy_ledger.h>
#include <carom/core/export.h>
#include <carom/core/log.h>
#include <carom/core/owner.h>
#include <carom/core/state.h>
#include <carom/core/system.h>
#include <carom/integrators/callback_id.h>
#include <carom/integrators/run/event_driven.h>
#include <carom/integrators/run/event_log.h>
#include <carom/integrators/run/step_report.h>
#include <carom/integrators/run/stop_request.h>
#include <carom/integrators/run/time_stepping.h>

#include <functional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace carom {

class Assembly;
struct Companion;
struct LastingContact;

/// The modes of integration, as values.
using Mode = std::variant<TimeStepping, EventDriven>;

/// Takes a copy of a system and runs it. A step works on a trial state, which replaces the state when the
/// step succeeds: after an error the simulation is at its last good state and can be saved, inspected and
/// continued.
///
/// One thread at a time may use a simulation. Functions that it calls (laws, elements, observers, actions,
/// sinks) may not destroy, move or assign it, which cannot be noticed; which of its own functions they may
/// call is in docs/errors.md, others throw ModelError.
class CAROM_API Simulation {
public:
  using Observer = carom::Observer;
  using Action = carom::Action;

  /// Assembles `system`, with its described positions and velocities, at time 0. If these do not satisfy the
  /// joints they are corrected (joint_closure.h); report().projected has the largest displacement, and
  /// report().findings what System::check() found, which the first step writes to the standard error stream,
  /// or to log() if that was called before. Throws
  /// ModelError for an invalid model or option, and in the event-driven mode for bodies deeper in shapes on
  /// ground than EventDriven::gap_tolerance; so do edit() and set_state().
  Simulation(System system, Mode mode);
  /// Assembles `system` for time stepping, as Simulation(System, Mode); the variant is made in the library.
  Simulation(System system, const TimeStepping& mode);
  /// Assembles `system` for the event-driven mode, as Simulation(System, Mode); the variant is made in the
  /// library.
  Simulation(System system, const EventDriven& mode);
  ~Simulation();
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;

  /// Makes one step of the mode's length (EventDriven: of its interval), shorter where a periodic event is
  /// due before its end. Throws SolverError, Cancelled; the simulation then stands where it stood. ModelError
  /// where such steps are lost in the rounding of time.
  const StepReport& step();
  /// Runs until exactly `time` [s]. Throws ModelError, before any work, for a time that is not finite or in
  /// the past, or where steps or intervals of every() are lost in the rounding of time; SolverError and
  /// Cancelled as step(): the simulation then stands at the last good state.
  void run_until(double time);

  /// Calls `observer` after every accepted step. Observers cannot change the run. Where one throws, the
  /// others and the actions are called all the same; then the (first) exception comes out of step().
  CallbackId observe(Observer observer);
  /// Calls `action` when `interval` [s], twice `interval`, ... have passed from now; steps end exactly there.
  /// Actions may change the state or edit the model. Throws ModelError for an interval that is not > 0, or
  /// too short for the times around the present to be told apart.
  CallbackId every(double interval, Action action);
  /// Ends what observe() or every() began. Throws ModelError for what this simulation does not call.
  void remove_callback(const CallbackId& callback);
  /// Asks `stop` again and again within steps; when it returns true they end with Cancelled, at the last good
  /// state. An empty function ends the asking. What it throws comes out unchanged.
  void stop_when(StopFunction stop);
  /// Asks `stop` as often as stop_when() does, for somebody who waits at a keyboard: nobody looks at the run
  /// for it, which has the same bits and steps as without (EventDriven::interval). A run of the event-driven
  /// mode that it ends leaves the simulation at a time that was reached a moment of the clock on the wall
  /// before, so that little is lost of a long run. `reached` gets, now and then, times [s] that such a run
  /// has reached and state() has not. Empty functions end the asking.
  void interrupt_when(StopFunction stop, ReachedFunction reached = {});

  /// Changes a copy of the model, assembles it and transfers the state by identity; new bodies start as
  /// described. An error changes nothing. The change of the energy is booked as `intervention`. Throws
  /// ModelError for an empty function, and where another system was put in the place of the model.
  void edit(const std::function<void(System&)>& change);
  /// Replaces the state (time included) by one of any simulation of this model; positions and velocities are
  /// projected onto the joints. Throws ModelError naming the body for numbers that are not finite, and for a
  /// state of another model, or of this one before an edit that moved the places of its numbers. The change
  /// of the energy is booked as `intervention`. The modes of contacts (stick, slip) are discarded: in the
  /// event-driven mode they are computed from the state, in time stepping a contact sticks if its speed is
  /// exactly zero.
  void set_state(const State& state);
  /// Continues in another mode, or with other options, from the same state. At a change from time stepping to
  /// the event-driven mode, bodies may have penetrated shapes on ground and each other: an impact is solved
  /// for contacts with ground that approach, then bodies are moved out and apart by the smallest displacement
  /// in the mass norm; energies are booked as `mode_switch`, and report().projected has the largest
  /// displacement. Throws as the constructor, and SolverError naming contacts of bodies that have no room;
  /// the mode then does not change.
  void switch_to(Mode mode);

  /// Counts the degrees of freedom that joints leave at the present state, and names redundant joints.
  [[nodiscard]] Mobility mobility() const;

  /// Reaction of a joint on its body `to`: forces at the present time, in time stepping the mean over the
  /// last step. Before the first step contacts are not known, and forces are those without contact. For a
  /// redundant joint one of many possible reactions. Throws ModelError for a joint that is not of this model,
  /// or a limit.
  [[nodiscard]] JointReaction reaction(JointId joint) const;
  /// Forces of the contacts that last (contact_forces.h: force_on() sums those on one part): at the present
  /// time, in time stepping the mean over the last step. None before the first step. Forces that are not
  /// unique are one of many possible sets.
  [[nodiscard]] std::vector<LastingContact> contact_forces() const;

  [[nodiscard]] const System& system() const;          ///< the model
  [[nodiscard]] const Assembly& assembly() const;      ///< the model, made ready to run
  [[nodiscard]] const State& state() const;            ///< the state
  [[nodiscard]] double time() const;                   ///< [s]
  [[nodiscard]] const EnergyLedger& energy() const;    ///< the energy ledger
  [[nodiscard]] const StepReport& report() const;      ///< report of the last step
  [[nodiscard]] const Statistics& statistics() const;  ///< counts since the start
  /// Counts of the contact solvers since the start, over all sweeps of accepted steps.
  [[nodiscard]] const ChainStatistics& contact_statistics() const;
  /// Events of the event-driven mode so far, in order of time (EventDriven::record_events).
  [[nodiscard]] const std::vector<EventRecord>& events() const;
  /// Deletes the records of events.
  void clear_events();
  /// Writes the records of events as CSV (event_log.h). Throws FileError.
  void write_events(const std::string& path) const;
  [[nodiscard]] const Companion& companion() const;  ///< all that can influence a later step
  [[nodiscard]] const Mode& mode() const;            ///< the mode and its options

  /// Name of a contact: "particle 'lower' on half-plane #0". Parts that were removed since keep their names;
  /// of a key made by default "no contact". Throws ModelError for a key of parts that this model never had.
  [[nodiscard]] std::string name(const ConstraintKey& key) const;
  /// The part of an event of any kind: its contact, as name(ConstraintKey); the force element with its
  /// bodies, "cable 'rope' between ground and particle 'ball'"; the driver or shape on ground whose law of
  /// time jumps. Throws ModelError for parts of another model.
  [[nodiscard]] std::string name(const EventRecord& event) const;

  /// Log of warnings and notes; nothing is written until it has a sink. Whoever calls this before the first
  /// step takes the findings too: they go to this log, and not to the standard error stream.
  [[nodiscard]] Log& log();
  /// Draws a progress bar during run_until() where the standard error is a terminal and the run is long.
  void show_progress(bool on);

  /// Saves state and companion with a fingerprint of the model; an event-driven run restarts its integrators
  /// then, so that it goes on as one that loads them. Throws FileError.
  void save(const std::string& path) const;
  /// Loads what save() wrote; the run continues bit for bit like the one that was saved. The periodic actions
  /// (every()) must be the same. Throws FileError for a file that cannot be read or is of another model; the
  /// simulation is then unchanged.
  void load(const std::string& path);
  /// The bytes that save() writes.
  [[nodiscard]] std::string checkpoint() const;
  /// Loads what checkpoint() gave, as load() does a file. Throws FileError.
  void restore(std::string_view checkpoint);
  /// A simulation of the same model and mode in the same state, which continues bit for bit as this one does.
  /// It has no observers, actions, events or log of this one. An event-driven run restarts its integrators,
  /// as by save(). Throws ModelError where the model cannot begin at its described positions (after edits).
  [[nodiscard]] Simulation copy() const;

private:
  void restore_from(std::string_view content, const std::string& origin, const char* call);

  struct Impl;
  Owner<Impl> impl_;
};

}  // namespace carom
