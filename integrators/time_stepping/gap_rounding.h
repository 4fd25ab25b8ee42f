#pragma once

/// \file
/// Gaps that are rounding in time stepping, and turns of contacts.

#include <carom/core/export.h>
#include <carom/integrators/run/time_stepping.h>

namespace carom {

class Assembly;

/// A body that was hit where a gap closed, or was moved out of the ground, stands on it to rounding: on
/// either side of it, by up to this [m]. It is what positions are iterated to, TimeStepping::tolerance, so
/// that it has the size of the model as that has; 1e-12 m where that is 0. Where bodies are described far
/// from the origin it is what their places are known to, if that is more: four roundings of the largest
/// coordinate, of which a gap has two.
[[nodiscard]] CAROM_API double gap_rounding(const Assembly& assembly, const TimeStepping& options);

/// Change of the gap of a contact that lasts, by turning in a step, that does not count [m]: a million of
/// such steps stay below TimeStepping::tolerance. Bodies at rest turn by rounding.
[[nodiscard]] CAROM_API double turning_rounding(const TimeStepping& options);

}  // namespace carom
