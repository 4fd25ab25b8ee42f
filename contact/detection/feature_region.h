#pragma once

/// \file
/// How far a vertex is from where another feature of an outline becomes the nearest one, and what is near.

#include <carom/core/ids.h>

namespace carom {

/// Distance of a vertex from the border of the region in which a feature is the nearest one.
struct FeatureMargin {
  double value = 0.0;   ///< positive inside [m]
  double rate = 0.0;    ///< its rate [m/s]
  Index beyond = none;  ///< the feature beyond the border
};

/// Lengths to which features of outlines are told apart, all of them parts of one [m].
struct FeatureLengths {
  /// How far beyond the end of an edge a sharp corner may stand and still touch it: as far as surfaces may be
  /// apart that touch.
  double corner = 1e-9;

  /// How far beyond the end of an edge a sharp corner is taken to leave it when it slides [m].
  [[nodiscard]] constexpr double corner_leaves() const { return 2.0 * corner; }
  /// How far beyond the end of an edge a sharp corner still has its normal [m].
  [[nodiscard]] constexpr double corner_follows() const { return 4.0 * corner; }
  /// How far beyond the border a rounded feature is taken to be left: where the next one is the nearest, and
  /// its normal has not turned by more than rounding [m].
  [[nodiscard]] constexpr double past_border() const { return 2e-5 * corner; }
  /// How deep in the ground what touches it hardly is [m].
  [[nodiscard]] constexpr double sunk() const { return 1e3 * corner; }
};

/// The nearer border of two.
[[nodiscard]] inline FeatureMargin nearer(const FeatureMargin& a, const FeatureMargin& b) {
  return b.value < a.value || (b.value == a.value && b.rate < a.rate) ? b : a;
}

}  // namespace carom
