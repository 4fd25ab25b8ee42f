#pragma once

/// \file
/// Books of an advance of clock groups: the energy that left them, and the events that happened.

#include <carom/contact/impulse_map.h>
#include <carom/contact/island_problem.h>
#include <carom/core/constraint.h>
#include <carom/core/energy_term.h>
#include <carom/core/export.h>
#include <carom/integrators/event_driven/event_motions.h>
#include <carom/integrators/event_driven/group_model.h>
#include <carom/integrators/event_driven/joint_reactions.h>
#include <carom/integrators/event_driven/motion_sample.h>
#include <carom/integrators/run/event_log.h>
#include <carom/integrators/run/packed_events.h>
#include <carom/integrators/run/step_report.h>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace carom {

/// An impact that was solved and applied.
struct SolvedImpact {
  EventKind kind = EventKind::impact;
  double time = 0.0;             ///< [s]
  const IslandProblem& problem;  ///< the problem and its answer
  const double* velocity;        ///< of the model, after
  ImpactNote note{};             ///< without its works
  double energy_before = 0.0;    ///< kinetic energy of the island before the impact [J]
  double energy_after = 0.0;     ///< kinetic energy of the island after the impact [J]
  double accumulation_time = std::numeric_limits<double>::quiet_NaN();  ///< EventRecord::accumulation_time
};

/// Which records of events are kept.
struct EventKeeping {
  bool records = true;        ///< false: none
  std::size_t limit = 0;      ///< at most so many, the latest; 0: all
  bool zero_impulses = true;  ///< false: none of contacts without impulse in an impact
};

/// Counts for the statistics, of the records of events.
struct EventTally {
  std::int64_t impacts = 0;  ///< of contacts with an impulse
  std::int64_t several_solutions = 0;
  std::int64_t forces_not_unique = 0;
  std::int64_t cut_sequences = 0;
  std::int64_t scaled_impacts = 0;
  std::int64_t plastic_jams = 0;  ///< contact problems solved with e = 0, since they had no answer
  double worst_residual = 0.0;
};

/// Sums of an advance of one clock group. Groups that go each to the end have their own, so that a sum does
/// not depend on how often they take turns.
struct GroupBooks {
  EnergyFlows flows;         ///< energy that left it
  double energy_gain = 0.0;  ///< by its impacts [J]
};

/// Energy that left clock groups, and what happened to them, since it was last cleared.
struct CAROM_API EventBalance {
  EventBalance() = default;
  explicit EventBalance(const EventKeeping& kept);

  EventKeeping keeping;
  EnergyFlows flows;
  std::vector<EventRecord> fresh;  ///< records of the instant at hand
  PackedEvents events;             ///< records that are settled and kept
  EventCounts counts{};
  EventTally tally;                          ///< of all that is settled
  std::vector<JointImpulse> joint_impulses;  ///< of impacts
  double energy_gain = 0.0;                  ///< by impacts [J]
  double shift = 0.0;                        ///< largest displacement by projection [m]

  /// Begins anew. Memory stays.
  void clear();
  /// Exchanges the sums with those of a group, which goes on.
  void exchange(GroupBooks& books) {
    std::swap(flows, books.flows);
    std::swap(energy_gain, books.energy_gain);
  }
  /// Adds the sums of a group.
  void add(const GroupBooks& books);
  /// Copies what was booked so far, but for records, which have times.
  void copy_totals(const EventBalance& from);
  /// Lets go of what is later than the copy of an earlier time [s], and of what was begun.
  void return_to(const EventBalance& earlier, double time);
  /// The records so far are complete, and of one instant: counts them, and lets go of those that are not to
  /// be kept.
  void settle();
  /// Groups advance one after the other: puts their events in the order of time, then as they were booked.
  void order_events();
  /// Settles and orders what there is, and numbers the instants.
  void finish();
  /// Records an event, which the caller completes. \param contact without bodies: of no contact
  EventRecord& record(EventKind kind, double time, const ConstraintHead& contact, const Assembly& assembly);
  /// Notes how bodies move before an impact, for its records.
  void note_before(const IslandProblem& problem, const StateView& state, const Assembly& assembly);
  /// Books the works of an impact and records it, an event for each contact. Returns the energy that it
  /// added, beyond rounding [J].
  /// note_before() was called with its problem.
  double book(const SolvedImpact& impact, const Assembly& assembly);
  /// Books what joints did in an impact. \param joints brought to `at`
  void book_joints(const SolvedImpact& impact, const GroupModel& model, JointReactions& joints,
                   const MotionSample& at);
  /// Lists impulses of joints by the multipliers of their rows, where there are any.
  void list_joint_impulses(std::span<const double> multipliers, double time, const GroupModel& model,
                           const MotionSample& at);

private:
  void keep_latest();
  void book_without_normal(const SolvedImpact& impact, std::size_t c, ImpulseWork& sum);

  std::int64_t instant_ = 0;           // being recorded
  std::vector<EventMotions> motions_;  // of note_before(), by constraint
  PackedEvents::OrderMemory order_;
};

}  // namespace carom
