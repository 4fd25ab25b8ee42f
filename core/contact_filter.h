#pragma once

/// \file
/// Filter of contacts: which things may touch.

#include <cstdint>

namespace carom {

/// Groups that a thing belongs to, and groups that it touches, a bit for each. Two things may touch where
/// each belongs to a group that the other touches. By default everything is of the first group and touches
/// all.
struct ContactFilter {
  std::uint32_t groups = 1;             ///< groups that it belongs to; at least one of a part
  std::uint32_t touches = 0xffffffffU;  ///< groups that it touches; at least one of a part

  /// True of the same groups on both sides.
  friend constexpr bool operator==(const ContactFilter&, const ContactFilter&) = default;
};

/// True if two things may touch, the same in either order.
[[nodiscard]] constexpr bool may_touch(const ContactFilter& a, const ContactFilter& b) {
  return (a.groups & b.touches) != 0 && (b.groups & a.touches) != 0;
}

}  // namespace carom
