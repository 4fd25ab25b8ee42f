#pragma once

/// \file
/// Names of the two contacts that corners which meet have with each other (corner_meeting.h).

#include <carom/core/constraint.h>

namespace carom {

/// True of names of the two contacts that two corners which meet have with each other: each names another
/// vertex of the same two outlines.
[[nodiscard]] inline bool may_be_of_corners(const ConstraintKey& one, const ConstraintKey& other) {
  const auto differ = [](const FeatureKey& a, const FeatureKey& b) {
    return a.owner == b.owner && a.serial == b.serial && a.feature != b.feature;
  };
  return differ(one.a, other.a) && differ(one.b, other.b);
}

}  // namespace carom
