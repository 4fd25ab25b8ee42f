#pragma once

/// \file
/// One clock group from event to event (docs/method.md, section 7):
///
///     flow until an event > impacts, until nothing approaches > modes from accelerations > flow on.
///
/// A clock group goes at its own pace: it makes steps as long as its flow likes, and its output states are
/// computed within them.

#include <carom/core/export.h>
#include <carom/integrators/event_driven/event_balance.h>
#include <carom/integrators/event_driven/group_parts.h>
#include <carom/integrators/run/companion.h>
#include <carom/integrators/run/lasting_contact.h>
#include <carom/integrators/run/step_report.h>

#include <vector>

namespace carom {

/// Components that share one time: one, or those whose bodies touch each other.
class CAROM_API ClockGroup {
public:
  /// All must outlive it. Throws ModelError for contact in space.
  ClockGroup(const Assembly& assembly, const Detector& detector, const EventDriven& options,
             const GroupComponents& components, GroupMemory& memory)
      : parts_(assembly, detector, options, components, memory) {}
  ClockGroup(const ClockGroup&) = delete;
  ClockGroup& operator=(const ClockGroup&) = delete;

  /// Throws ModelError where a contact is deeper in a shape on ground than gap_tolerance: no start.
  void demand_start(const State& state);
  /// Starts at a state; throws as demand_start(). \param present modes of contacts before, if known, by key
  void start(const State& state, const ContactModes& present);
  /// Goes on to a time, not before the present; events at that very time included. Throws SolverError: the
  /// group must then be started anew. \param output true: its output state is the one then
  void advance(double target, bool output, EventBalance& balance);
  /// Writes the state and the modes at a time last advanced to without output, which changes nothing of the
  /// group. \param balance gets the works up to there
  void look_at(double time, State& state, ContactModes& modes, EventBalance& balance);
  /// Time of the last output [s].
  [[nodiscard]] double time() const { return parts_.clock.output; }
  /// Time up to which its motion is decided [s].
  [[nodiscard]] double now() const { return parts_.clock.now; }
  /// Writes the group's part of the state at the time last advanced to, and the modes of closed contacts.
  void write(State& state, ContactModes& modes) const;
  /// Reaction of a joint of the group at the time last advanced to.
  [[nodiscard]] JointReaction reaction(const JointKind& kind, Index slot, JointId joint);
  /// Appends the forces of the closed contacts of the group at the time last advanced to.
  void list_forces(std::vector<LastingContact>& out);

  /// True if its event is not resolved yet.
  [[nodiscard]] bool is_at_event() const { return parts_.phase.kind == Phase::at_event; }
  /// The motion.
  [[nodiscard]] const SmoothMotion& motion() const { return parts_.motion; }

  /// Its parts, for those that join and part groups (joinable_group.h).
  [[nodiscard]] GroupParts& parts() { return parts_; }
  [[nodiscard]] const GroupParts& parts() const { return parts_; }

private:
  void close_known_contacts(const ContactModes& present);
  void leave_flow();

  GroupParts parts_;
};

/// Resolves the event at which a group stands: impacts until nothing approaches, modes, projection; then it
/// flows on, rests, or is parted.
CAROM_API void resolve_event(GroupParts& group, EventBalance& balance);

}  // namespace carom
