#pragma once

/// \file
/// A straight segment between two points, or a capsule: its ends touch a half-plane.

#include <carom/core/export.h>
#include <carom/core/part.h>
#include <carom/core/shape_kind.h>
#include <carom/core/space.h>

#include <limits>
#include <string_view>
#include <vector>

namespace carom::planar {

/// A straight segment between two points; with a radius a capsule. Its ends touch a half-plane. Fixed to a
/// planar rigid body.
struct CAROM_API Segment {
  static constexpr Role role = Role::shape;
  static constexpr int dimension = 2;
  static constexpr std::string_view label = "segment";
  /// Its type, for System::add().
  [[nodiscard]] static PartType<ShapeKind> part_type();

  BodyId body{};                                                      ///< the body (required)
  Vec<2> from = filled<2>(std::numeric_limits<double>::quiet_NaN());  ///< one end, in the body's frame [m]
  Vec<2> to = filled<2>(std::numeric_limits<double>::quiet_NaN());    ///< the other end [m]
  MaterialId material{};                                              ///< for laws between materials
  double radius = 0.0;                                                ///< >= 0: rounds it off [m]
  ContactFilter filter{};                                             ///< what it may touch

  /// Throws ModelError for invalid values.
  void check(const PartCheck& check) const;
  /// Appends the points that can touch a half-plane.
  void features(std::vector<RoundedPoint>& out) const;
  /// Set with which it touches other bodies.
  [[nodiscard]] Outline outline(const PartCheck& check) const;
};

}  // namespace carom::planar
