#pragma once

/// \file
/// Numbers after a step, by how they changed over the last steps of the same length. Changes are kept as
/// floats: a guess needs no more digits.

#include <carom/core/export.h>
#include <carom/core/ids.h>

#include <array>

namespace carom {

/// Changes over the last step, over the one before it, and over that before.
using LastChanges = std::array<const float*, 3>;

/// Writes the change from `then` to `now`, zero where a float cannot hold it, over `range`.
CAROM_API void record_change(Range range, const double* then, const double* now, float* change);

/// Guesses numbers by the polynomial through the last ones, over `range`. \param now the present ones
/// \param order changes that are known, 0 to 3 \param ratio next step to the last one, where order is 1;
/// steps are of one length where it is larger \param guess out
CAROM_API void extrapolate(Range range, const double* now, const LastChanges& changes, int order,
                           double ratio, double* guess);

}  // namespace carom
