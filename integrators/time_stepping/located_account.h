#pragma once

/// \file
/// Bodies that are hit within a step, under constant loads.

#include <carom/integrators/time_stepping/step_input.h>
#include <carom/integrators/time_stepping/step_parts.h>

#include <span>

namespace carom {

/// Moves on bodies that are hit within the step, under constant loads. Throws SolverError where an impact is
/// not solved. \param components which have moved as if nothing were hit \param contacts of theirs at the
/// start
void locate_under_constant_loads(Range components, std::span<const Constraint> contacts, const StepInput& in,
                                 StepParts& parts);
/// Completes the account of components with bodies that were hit in the trial, whose works are along mean
/// velocities.
void add_work_of_flights(Range components, const StepInput& in, StepParts& parts);

}  // namespace carom
