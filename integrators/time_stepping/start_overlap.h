#pragma once

/// \file
/// Overlaps of bodies with each other and with shapes on ground where a run begins.

#include <carom/contact/detection/detector.h>
#include <carom/core/assembly.h>
#include <carom/core/export.h>
#include <carom/core/state.h>
#include <carom/integrators/run/time_stepping.h>

namespace carom {

/// Moves bodies apart and out of the ground where `OverlapRules::separate_at_start` asks for it, as
/// GapProjection does, and demands that none is left deeper than `largest_at_start`. Returns the largest
/// displacement of a body, angles weighed by its size [m]. Throws ModelError naming a pair, its depth, and
/// what is allowed; the state has not changed then.
CAROM_API double prepare_overlaps(const Assembly& assembly, const Detector& detector,
                                  const TimeStepping& options, State& state);

}  // namespace carom
