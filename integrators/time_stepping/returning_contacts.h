#pragma once

/// \file
/// Contacts, and limits, that open at the start of a step while loads bring the bodies back within it:
/// strained couplings, or such with h^2 k/(4 m) > 1, whose steps turn velocities round. The gap opens by h
/// (y- + y+)/2, y- > 0. Were it stopped at y+ = -e_n y-, the contact would do the work (1 - e_n) P_n y-/2 > 0
/// and leave the coupling more strained than it can have been, which multiplies from step to step. With y+ >=
/// -y- the contact does no work, and the gap is closed again at the end; the next step begins with y- < 0 and
/// has the impact.

#include <carom/contact/island_problem.h>
#include <carom/core/constraint.h>
#include <carom/core/export.h>
#include <carom/integrators/time_stepping/step_input.h>
#include <carom/integrators/time_stepping/step_rule.h>
#include <carom/integrators/time_stepping/step_trial.h>

#include <span>

namespace carom {

/// True if a contact has an impulse in a step that begins while it opens, beyond rounding, and it has that by
/// the loads, which would bring it back without the others; either they change that much within the step, or
/// it opens faster than what constant loads press. \param lasting_speed at which that opens at the most [m/s]
/// \param trial a converged iterate
[[nodiscard]] CAROM_API bool any_returns(const StepInput& in, std::span<const IslandProblem> problems,
                                         const StepRule& rule, double lasting_speed, const StepTrial& trial);

/// Lets contacts that open at the start of a step come back as fast as they left.
CAROM_API void allow_return(const StepInput& in, std::span<Constraint> constraints);

}  // namespace carom
