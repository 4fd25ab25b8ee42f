#pragma once

/// \file
/// Velocities that bodies would end a step with if no constraint acted,
///     v_free = v_j + M^-1 h (F_j + F_{j+1})/2,
/// of bodies that constraints act on. Each writes StepTrial::free, and clears StepTrial::dv_impulses there.

#include <carom/core/constraint.h>
#include <carom/core/dynamics/body_response.h>
#include <carom/core/export.h>
#include <carom/integrators/time_stepping/step_input.h>
#include <carom/integrators/time_stepping/step_trial.h>

#include <span>

namespace carom {

/// Of one body. \param loads0,loads1 at the start and at the end, over all velocities
CAROM_API void free_body(const StepInput& in, const double* loads0, const double* loads1, Index body,
                         StepTrial& trial);
/// Of one body under constant loads. \param response by masses alone \param body its velocities
CAROM_API void free_alone(const StepInput& in, const double* loads, const MassResponse& response,
                          const Constraint::Block& body, StepTrial& trial);
/// Of some bodies under constant loads: as many at a time as follow one another. \param bodies ascending
CAROM_API void free_bodies(const StepInput& in, const double* loads, std::span<const Index> bodies,
                           StepTrial& trial);

}  // namespace carom
