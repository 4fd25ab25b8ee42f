#pragma once

/// \file
/// Motions of the bodies of a constraint, as records of events list them.

#include <carom/core/assembly.h>
#include <carom/core/constraint.h>
#include <carom/core/export.h>
#include <carom/core/state.h>
#include <carom/integrators/run/event_log.h>

#include <array>

namespace carom {

/// Motions of the bodies of one constraint.
using EventMotions = std::array<EventMotion, std::size_t{Constraint::max_bodies}>;

/// Motions in one state, with its velocities before and after.
[[nodiscard]] CAROM_API EventMotions motions_of(const Constraint& constraint, const StateView& state,
                                                const Assembly& assembly);

/// Sets the velocities after. \param velocities of the model
CAROM_API void set_after(const Constraint& constraint, const double* velocities, const Assembly& assembly,
                         EventMotions& motions);

}  // namespace carom
