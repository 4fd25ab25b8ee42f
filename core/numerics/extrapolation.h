#pragma once

/// \file
/// Numbers after a step, by those of the last steps of the same length.

#include <carom/core/export.h>
#include <carom/core/ids.h>

#include <array>
#include <cstddef>

namespace carom {

/// Most steps that a guess follows. More hardly help: what they add is lost in rounding.
inline constexpr std::size_t most_extrapolated = 10;

/// Numbers of the last steps, the last first: arrays that `range` indexes.
using LastNumbers = std::array<const double*, most_extrapolated>;

/// Guesses the numbers of the next step over `range` by the polynomial through those of the last steps,
/// 4 a - 6 b + 4 c - d of four. \param steps how many are known, 1 to most_extrapolated; the others are not
/// read \param guess out
CAROM_API void extrapolate(Range range, const LastNumbers& last, std::size_t steps, double* guess);

/// How many of the last steps the guess of the next should follow: as many as would have guessed the last one
/// best, by the sum of the errors times `weight`. A longer guess follows smooth numbers better, and magnifies
/// rounding and what changes within few steps. \param steps how many are known, 1 to most_extrapolated
/// \param weight by number
[[nodiscard]] CAROM_API std::size_t best_steps(Range range, const LastNumbers& last, std::size_t steps,
                                               const double* weight);

}  // namespace carom
