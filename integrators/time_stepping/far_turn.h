#pragma once

/// \file
/// Bodies that turn far within a step.

#include <carom/core/export.h>
#include <carom/core/ids.h>
#include <carom/integrators/time_stepping/step_input.h>

namespace carom {

/// The body of a component that turns farthest in a step, as fast as at its start.
struct FastestTurn {
  BodyId body{};       ///< not valid: none turns
  double angle = 0.0;  ///< [rad]
};

/// Finds it.
[[nodiscard]] CAROM_API FastestTurn fastest_turn(const StepInput& in, Index component);

}  // namespace carom
