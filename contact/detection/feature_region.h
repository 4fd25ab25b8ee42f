#pragma once

/// \file
/// How far a vertex is from where another feature of an outline becomes the nearest one.

#include <carom/core/ids.h>

namespace carom {

/// Distance of a vertex from the border of the region in which a feature is the nearest one.
struct FeatureMargin {
  double value = 0.0;   ///< positive inside [m]
  double rate = 0.0;    ///< its rate [m/s]
  Index beyond = none;  ///< the feature beyond the border

  /// How far beyond the end of an edge a sharp corner may stand and still touch it, is taken to leave it when
  /// it slides, and still has its normal [m].
  static constexpr double corner_touches = 1e-9, corner_leaves = 2e-9, corner_follows = 4e-9;
};

/// The nearer border of two.
[[nodiscard]] inline FeatureMargin nearer(const FeatureMargin& a, const FeatureMargin& b) {
  return b.value < a.value || (b.value == a.value && b.rate < a.rate) ? b : a;
}

}  // namespace carom
