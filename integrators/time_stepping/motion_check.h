#pragma once

/// \file
/// Is the end that an iteration has found one that the bodies go to? Equations of steps that are too long for
/// their mechanism have other solutions.

#include <carom/core/export.h>
#include <carom/integrators/time_stepping/joint_stage.h>
#include <carom/integrators/time_stepping/step_input.h>
#include <carom/integrators/time_stepping/step_model.h>

namespace carom {

/// Throws SolverError where the bodies of a component would be moved back onto its joints by more than a
/// fifth of the longest way of one. \param trial the end of the step
CAROM_API void demand_motion(const JointStage& joints, const StepInput& in, const StepModel& model,
                             StepTrial& trial);

/// Throws SolverError where a joint stays open, beyond what rounding and tolerance let it. \param trial
/// the end of the step
CAROM_API void demand_closed(const JointStage& joints, const StepInput& in, const StepModel& model,
                             StepTrial& trial);

}  // namespace carom
