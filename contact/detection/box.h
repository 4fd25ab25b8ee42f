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

/// 1 if a comparison holds, else 0: comparisons joined by & have no branches.
[[nodiscard]] constexpr unsigned as_bit(bool holds) { return static_cast<unsigned>(holds); }

/// True if no axis parts two boxes by more than a margin >= 0 [m].
template <int D>
[[nodiscard]] inline bool are_within(const Box<D>& a, const Box<D>& b, double margin) {
  unsigned within = 1;
  for (int k = 0; k < D; ++k) {
    within &= as_bit(a.min[k] - b.max[k] <= margin) & as_bit(b.min[k] - a.max[k] <= margin);
  }
  return within != 0;
}

/// True if two boxes have a point in common.
template <int D>
[[nodiscard]] inline bool overlap(const Box<D>& a, const Box<D>& b) {
  unsigned common = 1;
  for (int k = 0; k < D; ++k) common &= as_bit(a.min[k] <= b.max[k]) & as_bit(b.min[k] <= a.max[k]);
  return common != 0;
}

}  // namespace carom
