#pragma once

/// \file
/// Is the end that an iteration has found one that the bodies go to? Equations of steps that are too long for
/// their mechanism have other solutions.

#include <carom/core/export.h>
#include <carom/integrators/time_stepping/joint_stage.h>
#include <carom/integrators/time_stepping/step_input.h>
#include <carom/integrators/time_stepping/step_parts.h>

namespace carom {

/// Throws SolverError where the bodies of an island would be moved back onto its joints farther than they go.
CAROM_API void demand_motion(const StepIsland& island, const StepInput& in, StepParts& parts);

/// Throws SolverError where a joint stays open, beyond what rounding and tolerance let it.
CAROM_API void demand_closed(JointStage& joints, const StepInput& in, StepParts& parts);

}  // namespace carom
