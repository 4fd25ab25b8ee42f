#pragma once

/// \file
/// Bodies that turn or move far within a step, against the size of what they belong to.

#include <carom/core/export.h>
#include <carom/core/ids.h>
#include <carom/integrators/time_stepping/step_input.h>

#include <vector>

namespace carom {

/// The body of a component that turns farthest in a step, as fast as at its start.
struct FastestTurn {
  BodyId body{};       ///< not valid: none turns
  double angle = 0.0;  ///< [rad]
};

/// Finds the body of a component that turns farthest in a step, as fast as at its start.
[[nodiscard]] CAROM_API FastestTurn fastest_turn(const StepInput& in, Index component);

/// Longest way of a body in a step, by its speeds at both ends; angles times the radius of gyration [m].
/// \param v velocities of some bodies \param lengths Assembly::length_scales()
[[nodiscard]] CAROM_API double longest_way(const StepInput& in, Range v, const std::vector<double>& lengths,
                                           const State& end);

/// Size of some bodies and of where they are: their largest coordinate and radius of gyration [m].
/// \param lengths Assembly::length_scales()
[[nodiscard]] CAROM_API double size_of(const Assembly& assembly, Range bodies,
                                       const std::vector<double>& lengths, const State& at);

/// True if a body goes a thousandth of the size of the model in a step, by its speeds at both ends.
[[nodiscard]] CAROM_API bool moves_far(const StepInput& in, const State& end);

}  // namespace carom
