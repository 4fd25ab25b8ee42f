#pragma once

/// \file
/// Typed identities of parts. An identity names one part of one system and is never reused.

#include <compare>
#include <cstdint>

namespace carom {

/// Sizes, offsets and serial numbers.
using Index = std::uint32_t;

/// Invalid index: no part has it.
inline constexpr Index none = 0xffffffffU;

/// Identity of a part: serial number within its system and the token of that system.
/// A copy of a system keeps the token, so identities are valid in the copy.
template <class Tag>
struct Id {
  Index serial = none;  ///< serial number, `none` for an identity that was never given
  Index token = 0;      ///< token of the system that gave it

  /// True if it was given by a system (or is `ground`).
  [[nodiscard]] constexpr bool valid() const { return serial != none; }
  friend constexpr auto operator<=>(const Id&, const Id&) = default;
};

using BodyId = Id<struct BodyTag>;          ///< a body
using ElementId = Id<struct ElementTag>;    ///< a force element
using ShapeId = Id<struct ShapeTag>;        ///< a shape fixed to a body
using JointId = Id<struct JointTag>;        ///< a joint
using ObstacleId = Id<struct ObstacleTag>;  ///< an obstacle: a shape on ground, fixed or moved as prescribed
using MaterialId = Id<struct MaterialTag>;  ///< a material

/// The fixed frame. An end of a force element or joint may be on it; it belongs to every system.
inline constexpr BodyId ground{0xfffffffeU, 0};

/// A contiguous range of indices, [begin, end).
struct Range {
  Index begin = 0;  ///< first index
  Index end = 0;    ///< one past the last

  /// Number of indices.
  [[nodiscard]] constexpr Index size() const { return end - begin; }
  /// True if there is none.
  [[nodiscard]] constexpr bool empty() const { return begin == end; }
};

}  // namespace carom
