#pragma once

/// \file
/// The time of what does not happen.

#include <limits>

namespace carom {

/// Later than every time [s].
inline constexpr double never = std::numeric_limits<double>::infinity();

}  // namespace carom
