#pragma once

/// \file
/// Joints are closed at the end of every step of the flow, at every event and in every output state, but for
/// what tolerances leave: bodies that have come apart are an error that names the joint, never a motion.

#include <carom/core/export.h>
#include <carom/integrators/event_driven/group_failure.h>
#include <carom/integrators/event_driven/motion_sample.h>
#include <carom/integrators/event_driven/smooth_motion.h>

namespace carom {

/// Throws SolverError naming the joint of a clock group that is open most, where one is too far. \param at
/// the sample that the motion made last, before it is projected
CAROM_API void demand_closed(const SmoothMotion& motion, const MotionSample& at, const GroupFailure& failure);

}  // namespace carom
