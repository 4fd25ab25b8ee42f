#pragma once

/// \file
/// Scalar products in twice the working precision.

#include <carom/core/export.h>

#include <span>

namespace carom {

/// sum a_i b_i + start as if computed in twice the precision and rounded once (Ogita, Rump, Oishi 2005,
/// algorithm 5.3). The spans have the same size.
[[nodiscard]] CAROM_API double accurate_dot(std::span<const double> a, std::span<const double> b,
                                            double start);

}  // namespace carom
