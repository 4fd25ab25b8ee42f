#pragma once

/// \file
/// Length of a short vector. Not API.

#include <carom/core/space.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace carom {

/// Length of a vector of finite numbers; their squares may over- or underflow. The bits depend on the numbers
/// only: Eigen's stableNorm() scales anew at the first aligned number, so that they depend on the address
/// too.
template <int D>
[[nodiscard]] double length_of(const Vec<D>& vector) {
  const double scale = std::max(vector.cwiseAbs().maxCoeff(), std::numeric_limits<double>::min());
  const Vec<D> scaled = vector * (1.0 / scale);
  return scale * std::sqrt(scaled.squaredNorm());
}

}  // namespace carom
