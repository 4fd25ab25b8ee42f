#pragma once

/// \file
/// A clock group among others, which it may meet (GroupMeetings).

#include <carom/core/export.h>
#include <carom/core/state.h>
#include <carom/integrators/event_driven/clock_group.h>
#include <carom/integrators/event_driven/event_balance.h>
#include <carom/integrators/event_driven/motion_sample.h>

#include <span>

namespace carom {

/// A clock group that goes on event by event, becomes part of another one where bodies touch, and parts where
/// nothing lasting connects them. Refers to the group. All throw as ClockGroup::advance().
class CAROM_API JoinableGroup {
public:
  /// The group must outlive it.
  explicit JoinableGroup(ClockGroup& group) : group_(&group.parts()) {}

  /// Takes a state to be looked at by sample(), before ClockGroup::start().
  void place(const State& state);
  /// True if it is at forces without bound: a matter of its own.
  [[nodiscard]] bool has_unbounded_force() const;
  /// Makes a step ahead, if it stands where modes are decided and moves. \param target that is asked for [s]
  void go_ahead(double target);
  /// Time at which something is to be done: the end of the step ahead, or its event; infinity at rest [s].
  [[nodiscard]] double due();
  /// Goes on to that time: to an event that is to be resolved then, or to the end of the step.
  void reach_due(EventBalance& balance);
  /// Notes what ends at its event, before others are joined to it.
  void arrive(EventBalance& balance);
  /// Resolves its event: impacts, modes. False if nothing lasting connects its components any more: they are
  /// to go on as other groups then, by part().
  [[nodiscard]] bool resolve(EventBalance& balance);
  /// Becomes the motion of some groups, which end there, at a time within the steps of all. Their bodies
  /// touch: that is an event. \param output time of the last good state [s] \param state memory
  void join(std::span<ClockGroup* const> groups, double time, double output, State& state,
            EventBalance& balance);
  /// Counts the meeting that it began with; fails where its components have too many events.
  void count_meeting();
  /// Becomes the motion of some components of a group whose resolve() was false. \param state memory
  void part(const ClockGroup& last, State& state, EventBalance& balance);
  /// Writes the output state, as ClockGroup::advance() does.
  void output(double target, EventBalance& balance);
  /// The motion at a time of the step ahead, or at rest. \param landed as accurate as steps, not by
  /// interpolation \param forces that accelerations follow from
  void sample(double time, bool landed, Forces forces, MotionSample& out);

private:
  void book_end(EventBalance& balance);
  void end(double time, State& state, EventBalance& balance);

  GroupParts* group_;
};

}  // namespace carom
