#pragma once

/// \file
/// Clock groups that may meet each other, in the order of time.
///
/// A group is what shares a time: one component, or several that closed contacts connect. Each is ahead of
/// the time reached by one step of its own. All that is still to happen is in a queue: ends of steps, own
/// events, horizons of volumes (body_flights.h), meetings. When two meet they are joined, with all that
/// touches them, the impact is solved, and what nothing lasting connects goes on by itself. So an impact
/// costs what its neighbourhood costs, however many bodies there are.

#include <carom/contact/detection/detector.h>
#include <carom/core/assembly.h>
#include <carom/core/export.h>
#include <carom/integrators/event_driven/body_flights.h>
#include <carom/integrators/event_driven/event_balance.h>
#include <carom/integrators/event_driven/group_set.h>
#include <carom/integrators/event_driven/meeting_queue.h>
#include <carom/integrators/event_driven/meeting_search.h>
#include <carom/integrators/run/event_driven.h>

#include <vector>

namespace carom {

/// The order of things among groups whose bodies may touch each other.
class CAROM_API GroupMeetings {
public:
  /// All must outlive it.
  GroupMeetings(const Assembly& assembly, const Detector& detector, const EventDriven& options,
                GroupMemory& memory, GroupSet& groups);

  /// Makes the groups of a state: components that touch are joined.
  void regroup(const State& state);
  /// Begins at a time at which all groups were started.
  void start(double time);
  /// Begins an advance of all groups to a time [s].
  void aim_at(double to);
  /// Goes on to a time, events at that very time included. \param reached time up to which all is decided
  /// [s], written as it goes on: where this throws, it says how far it came
  void advance(double to, EventBalance& balance, double& reached);
  /// The output states at the time last advanced to.
  void output(double to, EventBalance& balance);

private:
  void keep(const Appointment& at, EventBalance& balance);
  ClockGroup& join(double time, EventBalance& balance);
  void resolve(ClockGroup& group, EventBalance& balance);
  void part(ClockGroup& group, EventBalance& balance);
  void go_on(double time);
  [[nodiscard]] double near() const;

  const Assembly* assembly_;
  const EventDriven* options_;
  GroupMemory* memory_;
  GroupSet* groups_;
  BodyFlights flights_;
  MeetingSearch search_;
  MeetingQueue queue_;
  MotionSample now_, end_;
  State joined_;                      // of groups that are joined or parted
  std::vector<ClockGroup*> list_;     // groups that are joined, or go on
  double from_ = 0.0, target_ = 0.0;  // of the advance [s]
};

}  // namespace carom
