#pragma once

/// \file
/// Boxes along the axes, which bound shapes or the motion of shapes.

#include <carom/core/ids.h>
#include <carom/core/space.h>

#include <compare>

namespace carom {

/// A closed box along the axes [m].
template <int D>
struct Box {
  Vec<D> min = Vec<D>::Zero();  ///< least coordinates
  Vec<D> max = Vec<D>::Zero();  ///< largest coordinates
};

/// Two boxes that overlap, first < second.
struct BoxPair {
  Index first = none;   ///< the box of the lower index
  Index second = none;  ///< the other
  friend constexpr auto operator<=>(const BoxPair&, const BoxPair&) = default;
};

/// True if no axis parts two boxes by more than a margin >= 0 [m].
template <int D>
[[nodiscard]] inline bool are_within(const Box<D>& a, const Box<D>& b, double margin) {
  bool within = true;
  for (int k = 0; k < D; ++k) {
    within = within & (a.min[k] - b.max[k] <= margin) & (b.min[k] - a.max[k] <= margin);
  }
  return within;
}

/// True if two boxes have a point in common.
template <int D>
[[nodiscard]] inline bool overlap(const Box<D>& a, const Box<D>& b) {
  bool common = true;
  for (int k = 0; k < D; ++k) common = common & (a.min[k] <= b.max[k]) & (b.min[k] <= a.max[k]);
  return common;
}

}  // namespace carom
