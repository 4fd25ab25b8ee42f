#pragma once

/// \file
/// Rules of an impact beside its contact problem, the same in both modes: which law, which contacts, how much
/// restitution.

#include <carom/contact/impulse_map.h>
#include <carom/contact/island_problem.h>
#include <carom/core/constraint.h>
#include <carom/core/export.h>
#include <carom/core/function_ref.h>
#include <carom/core/surface.h>

#include <optional>
#include <span>
#include <vector>

namespace carom {

/// Law of the contacts of an impact, Newton's where all are limits of joints or friction in them, which take
/// the law of the contacts. Nothing where contacts differ.
[[nodiscard]] CAROM_API std::optional<ImpactLaw> law_of_impact(std::span<const Constraint> constraints);

/// Leaves of the constraints of an impact the one that approaches fastest, those as fast up to 1e-9 of its
/// speed, and friction in joints. \param velocities of all bodies
CAROM_API void keep_fastest(std::vector<Constraint>& constraints, const double* velocities);

/// Work of the answer of an impact, and its scale. \param problem with free velocities, which are those
/// before
[[nodiscard]] CAROM_API ImpulseWork work_of_impact(const IslandProblem& problem);

/// Scales the restitution of all constraints of an impact that gains energy by the largest factor, to 1/64 at
/// least, that does not. Returns the factor; 1, and nothing done, where there is no gain.
/// \param solve states and solves the impact of the constraints as they are; false where it is not solved,
/// which ends the search
[[nodiscard]] CAROM_API double limit_gain(const IslandProblem& problem, std::span<Constraint> constraints,
                                          FunctionRef<bool()> solve);

}  // namespace carom
