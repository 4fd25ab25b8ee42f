#pragma once

/// \file
/// One clock group from event to event (docs/method.md, section 7):
///
///     flow until an event > impacts, until nothing approaches > modes from accelerations > flow on.
///
/// A clock group goes at its own pace: it makes steps as long as its flow likes, and its output states are
/// computed within them.

#include <carom/contact/detection/detector.h>
#include <carom/core/assembly.h>
#include <carom/core/export.h>
#include <carom/integrators/event_driven/event.h>
#include <carom/integrators/event_driven/event_balance.h>
#include <carom/integrators/event_driven/event_detector.h>
#include <carom/integrators/event_driven/event_instant.h>
#include <carom/integrators/event_driven/group_failure.h>
#include <carom/integrators/event_driven/group_flow.h>
#include <carom/integrators/event_driven/group_limits.h>
#include <carom/integrators/event_driven/group_memory.h>
#include <carom/integrators/event_driven/group_output.h>
#include <carom/integrators/event_driven/impact_stage.h>
#include <carom/integrators/event_driven/mode_selection.h>
#include <carom/integrators/event_driven/projection_stage.h>
#include <carom/integrators/event_driven/smooth_motion.h>
#include <carom/integrators/event_driven/unbounded_forces.h>
#include <carom/integrators/run/event_driven.h>
#include <carom/integrators/run/step_report.h>

#include <utility>
#include <vector>

namespace carom {

/// Modes by contact.
using ContactModes = std::vector<std::pair<ConstraintKey, ContactMode>>;

/// Components that share one time: one, or those whose bodies touch each other.
class CAROM_API ClockGroup {
public:
  /// All must outlive it. Throws ModelError for contact in space.
  ClockGroup(const Assembly& assembly, const Detector& detector, const EventDriven& options,
             const GroupComponents& components, GroupMemory& memory);
  ClockGroup(const ClockGroup&) = delete;
  ClockGroup& operator=(const ClockGroup&) = delete;

  /// Throws ModelError where a contact is deeper in a shape on ground than gap_tolerance: no start.
  void demand_start(const State& state);
  /// Starts at a state; throws as demand_start(). \param present modes of contacts before, if known, by key
  void start(const State& state, const ContactModes& present);
  /// Goes on to a time, not before the present; events at that very time included. Throws SolverError: the
  /// group must then be started anew.
  void advance(double target, EventBalance& balance);
  /// Time last advanced to [s].
  [[nodiscard]] double time() const { return clock_.output; }
  /// Time up to which its motion is decided [s].
  [[nodiscard]] double now() const { return clock_.now; }
  /// Writes the group's part of the state at the time last advanced to, and the modes of closed contacts.
  void write(State& state, ContactModes& modes) const;
  /// Reaction of a joint of the group at the time last advanced to.
  [[nodiscard]] JointReaction reaction(const JointKind& kind, Index slot, JointId joint);

  /// True if its event is not resolved yet.
  [[nodiscard]] bool is_at_event() const { return phase_.kind == Phase::at_event; }
  /// The motion.
  [[nodiscard]] const SmoothMotion& motion() const { return motion_; }

private:
  friend class JoinableGroup;  // the same motion, beside others

  void resolve_event(EventBalance& balance);
  void arrive_at(const Event& event, EventInstant& at);
  void record_event(const Event& event, EventBalance& balance);
  [[nodiscard]] Phase::Kind start_flow(EventInstant& at);
  [[nodiscard]] bool is_at_rest(MotionSample& now);
  void make_step();
  void land(const Event& event);
  void accept_step(EventBalance& balance);
  void output(double target, EventBalance& balance);
  void close_known_contacts(const ContactModes& present);

  GroupMemory* memory_;
  SmoothMotion motion_;
  GroupClock clock_;
  GroupFailure failure_;
  UnboundedForces unbounded_;
  EventDetector detector_;
  ImpactStage impacts_;
  ModeSelection modes_;
  ProjectionStage projection_;
  GroupLimits limits_;
  GroupFlow flow_;
  GroupOutput output_;
  std::vector<double> y_;  // at clock_.now
  Phase phase_;
};

}  // namespace carom
