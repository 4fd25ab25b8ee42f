#pragma once

/// \file
/// Problem: a crank and its rod in line hold the slider fast, and friction on it does not know where to. In
/// such a position, a dead point, forces along the slide move nothing: starting there from rest the slider
/// has neither velocity nor acceleration along it, and sticking as well as sliding to either side obey the
/// law of friction at that instant. A moment later it slides, and where it sticks in equations that follow
/// from others the mechanism is locked, or slides without friction. So the direction is taken from the motion
/// of the mechanism a moment later.

#include <carom/core/export.h>
#include <carom/integrators/event_driven/event_instant.h>
#include <carom/integrators/event_driven/mode_decision.h>

#include <span>

namespace carom {

/// Gives candidates that joints hold fast at a dead point the direction in which they will slide, as a slip
/// of no size. Those that stay held, as friction in a joint of a framework, are left as they are. Returns
/// true if there is one that got a direction: its friction acts then, and the decision is to be made anew.
/// \param made the decision for the candidates
[[nodiscard]] CAROM_API bool leave_dead_points(const ModeDecision& made, const EventInstant& at,
                                               std::span<Candidate> candidates);

}  // namespace carom
