#pragma once

/// \file
/// The account of bodies that are hit within a step.

#include <carom/integrators/time_stepping/step_input.h>
#include <carom/integrators/time_stepping/step_islands.h>
#include <carom/integrators/time_stepping/step_parts.h>

namespace carom {

/// Bodies that are hit within the step, under constant loads: they are moved again, and booked anew in the
/// account of the trial. Throws SolverError where an impact is not solved. \param components of the island,
/// which have moved as if nothing were hit \param island with the contacts at the start
void locate_under_constant_loads(Range components, const StepIsland& island, const StepInput& in,
                                 StepParts& parts);

}  // namespace carom
