#pragma once

/// \file
/// The machine of the event-driven mode: all clock groups of a model, each at its own pace, met at times
/// asked for.

#include <carom/contact/detection/detector.h>
#include <carom/core/assembly.h>
#include <carom/core/export.h>
#include <carom/integrators/event_driven/clock_group.h>
#include <carom/integrators/event_driven/event_balance.h>
#include <carom/integrators/event_driven/group_meetings.h>
#include <carom/integrators/event_driven/group_memory.h>
#include <carom/integrators/event_driven/group_set.h>
#include <carom/integrators/event_driven/law_continuity.h>
#include <carom/integrators/event_driven/overlap_check.h>
#include <carom/integrators/event_driven/reached_motion.h>
#include <carom/integrators/run/companion.h>
#include <carom/integrators/run/event_driven.h>
#include <carom/integrators/run/recorded_events.h>
#include <carom/integrators/run/step_report.h>

#include <memory>
#include <vector>

namespace carom {

/// Advances states of one assembly. Clock groups are ahead of the state by what their last step covers; that
/// is memory only: from any state the same motion follows within the tolerance.
class CAROM_API EventDriver {
public:
  /// Throws ModelError for impossible options, a contact without a law, contact in space.
  /// \param stop asked within the work, may be null; must outlive this
  EventDriver(const Assembly& assembly, const EventDriven& options, const StopRequest* stop = nullptr);

  /// Throws ModelError naming the contact where a body is too deep in another one, or in a shape on ground,
  /// for a start, SolverError for more evaluations than the options allow.
  void demand_start(const State& state);
  /// Advances to a time, not before the state's. On success state and companion are those then, `report`
  /// tells what happened and `events` got what there was; on an error none of them has changed. Throws
  /// ModelError where bodies are too deep in shapes on ground at a start, SolverError where anything is too
  /// deep in anything at the end (OverlapCheck).
  /// Returns how many records `events` got: those of impacts are still to be listed in the report
  /// (list_impacts()).
  /// \param may_be_interrupted keep what is reached on the way, for stand_where_reached()
  std::size_t advance(State& state, Companion& companion, double target, StepReport& report,
                      RecordedEvents& events, bool may_be_interrupted = false);
  /// After an advance that was interrupted (StopRequest::interrupt_when()): state, companion, report and
  /// events are those of the latest time at which it had looked around, if it got there. Returns as
  /// advance().
  std::size_t stand_where_reached(State& state, Companion& companion, StepReport& report,
                                  RecordedEvents& events);
  /// Where the last advance() failed, the time up to which the motion was decided before, not before the
  /// state's [s]. Advances to earlier times succeed, but for what their own ends bring to light.
  [[nodiscard]] double good_until() const { return reached_.good_until; }
  /// Reaction of a joint at a state last advanced to, or changed to since.
  [[nodiscard]] JointReaction reaction(const State& state, const Companion& companion, JointId joint);
  /// Forces of closed contacts at a state last advanced to, or changed to since, in the order of their keys.
  [[nodiscard]] std::vector<LastingContact> contact_forces(const State& state, const Companion& companion);
  /// The state was changed from outside: start anew from it.
  void forget() { started_ = false; }

  /// The flows that clock groups share.
  [[nodiscard]] const FlowPool& flows() const { return memory_.flows; }
  /// Names of contacts.
  [[nodiscard]] const Detector& detector() const { return detector_; }

private:
  void start(const State& state, const Companion& companion);
  template <class F>
  auto within_limit(double time, F&& evaluate) const;
  void count(Companion& companion);
  static void count_solved(Companion& companion, const ChainStatistics& solved);
  void demand_laws(double from, double to);
  void advance_groups(double from, double to, bool keeps_reached);
  void move_groups(double to, bool is_end);
  void look_around(double time);
  [[nodiscard]] StoredEnergies account(double from, double target);
  std::size_t commit(State& state, Companion& companion, const StoredEnergies& stored, StepReport& report,
                     RecordedEvents& events);
  void write_report(double from, double to, StepReport& out) const;
  [[noreturn]] void fail_energy(double from, double to);

  const Assembly* assembly_;
  EventDriven options_;
  Detector detector_;
  LawContinuity laws_;
  OverlapCheck overlaps_;
  GroupMemory memory_;
  GroupSet groups_;
  std::unique_ptr<GroupMeetings> meetings_;  // null where no two bodies may touch
  State trial_;
  ContactModes modes_;
  EventBalance balance_;
  FlowCounts counted_;  // of the flows, in the statistics so far
  ReachedMotion reached_;
  const StopRequest* stop_;  // null: nobody interrupts
  bool started_ = false;
};

}  // namespace carom
