#pragma once

/// \file
/// A walk over points of bodies that keeps the order of the bodies.

#include <carom/contact/detection/body_features.h>
#include <carom/core/ids.h>

#include <algorithm>
#include <vector>

namespace carom {

/// Walks over the points of one component in step with its bodies.
class PointsInOrder {
public:
  PointsInOrder(const std::vector<BodyFeature>& points, Range range) : points_(points), range_(range) {}

  /// Calls f(number of the point) for those of bodies before `body` that did not come yet.
  template <class F>
  void before(Index body, F&& f) {
    for (; range_.begin < range_.end && points_[range_.begin].body < body; ++range_.begin) f(range_.begin);
  }
  /// Leaves out all before a point.
  void skip_to(Index point) { range_.begin = std::max(range_.begin, point); }

private:
  const std::vector<BodyFeature>& points_;
  Range range_;  // still to come
};

}  // namespace carom
