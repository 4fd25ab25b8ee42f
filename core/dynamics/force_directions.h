#pragma once

/// \file
/// Forces along the line between two ends, where these stand at one place: no motion follows from there.

#include <carom/core/assembly.h>
#include <carom/core/export.h>
#include <carom/core/ids.h>

#include <string>

namespace carom {

/// The first element of a component whose force has a size but no direction
/// (ForceKind::first_without_direction); invalid if there is none. The position group of `evaluation` must be
/// up to date. \param fastest ends that part faster give the line themselves [m/s]
[[nodiscard]] CAROM_API ElementId find_without_direction(const Assembly& assembly, Index component,
                                                         const StateView& state, const Evaluation& evaluation,
                                                         double fastest);

/// "force of spring-damper #0 has no direction: its ends on particle 'a' and particle 'b' stand at one
/// place".
[[nodiscard]] CAROM_API std::string tell_without_direction(const Assembly& assembly, ElementId element);

/// Demands that all forces have a direction where a run begins, however bodies move. Throws ModelError naming
/// the element and its bodies.
CAROM_API void demand_directions(const Assembly& assembly, const State& state);

}  // namespace carom
