#pragma once

/// \file
/// The stages of a clock group's course: what is done between its events, and at them (clock_group.h has the
/// page that calls them).

#include <carom/core/export.h>
#include <carom/integrators/event_driven/event_balance.h>
#include <carom/integrators/event_driven/event_instant.h>
#include <carom/integrators/event_driven/group_parts.h>

namespace carom {

/// Makes a step ahead of a flowing group, and looks for its first event.
CAROM_API void make_step(GroupParts& group);
/// Goes to an event within the step ahead.
CAROM_API void land(const Event& event, GroupParts& group);
/// Goes to the end of the step ahead, in which nothing happens.
CAROM_API void accept_step(GroupParts& group, EventBalance& balance);
/// Follows an event on which the flow landed, before anything touches or parts by it.
CAROM_API void arrive_at(const Event& event, GroupParts& group, EventInstant& at);
/// Starts the flow in the modes selected, unless nothing moves. Returns which of both. Throws SolverError
/// where the forces of closed contacts contradict each other.
[[nodiscard]] CAROM_API Phase::Kind start_flow(GroupParts& group, EventInstant& at);
/// Writes the output state: the present one, or one within the last step, projected onto the joints.
CAROM_API void write_output(double target, GroupParts& group, EventBalance& balance);
/// True if closed contacts connect all components of a group; GroupMemory::components has what they connect,
/// unless there is but one component.
[[nodiscard]] CAROM_API bool is_connected(const GroupParts& group);

}  // namespace carom
