#pragma once

/// \file
/// Boxes along the axes, which bound shapes or the motion of shapes.

#include <carom/core/ids.h>
#include <carom/core/numerics/never.h>
#include <carom/core/space.h>

#include <compare>
#include <span>

namespace carom {

/// A closed box along the axes [m].
template <int D>
struct Box {
  Vec<D> min = Vec<D>::Zero();  ///< least coordinates
  Vec<D> max = Vec<D>::Zero();  ///< largest coordinates

  /// A box around nothing, to be extended.
  [[nodiscard]] static Box none() { return {Vec<D>::Constant(never), Vec<D>::Constant(-never)}; }
  /// Takes another box in.
  void extend(const Box& other) {
    min = min.cwiseMin(other.min);
    max = max.cwiseMax(other.max);
  }
};

/// The box around some points, one at least, wider by some distance on all sides [m].
[[nodiscard]] inline Box<2> box_around(std::span<const Vec<2>> points, double wider) {
  Box<2> box{points[0], points[0]};
  for (const Vec<2>& point : points.subspan(1)) {
    box.min = box.min.cwiseMin(point);
    box.max = box.max.cwiseMax(point);
  }
  box.min.array() -= wider;
  box.max.array() += wider;
  return box;
}

/// Two boxes that overlap, first < second.
struct BoxPair {
  Index first = none;   ///< the box of the lower index
  Index second = none;  ///< the box of the higher index
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
