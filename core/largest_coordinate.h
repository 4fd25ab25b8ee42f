#pragma once

/// \file
/// How far from the origin bodies are.

#include <carom/core/export.h>
#include <carom/core/state.h>

namespace carom {

/// Largest magnitude of a coordinate of a place [m]. \param bodies some, by their place in the order of
/// assembly
[[nodiscard]] CAROM_API double largest_coordinate(const State& state, Range bodies);
/// Of all bodies.
[[nodiscard]] CAROM_API double largest_coordinate(const State& state);

}  // namespace carom
