#pragma once

/// \file
/// A polygon, sharp or rounded: its vertices touch a half-plane, all of it touches other bodies.

#include <carom/core/export.h>
#include <carom/core/part.h>
#include <carom/core/shape_kind.h>
#include <carom/core/space.h>

#include <string_view>
#include <vector>

namespace carom::planar {

/// A polygon, in either orientation. Its vertices touch half-planes, whatever its form; to touch other bodies
/// it must be convex. Fixed to a planar rigid body.
struct CAROM_API Polygon {
  static constexpr Role role = Role::shape;
  static constexpr int dimension = 2;
  static constexpr std::string_view label = "polygon";
  /// Its type, for System::add().
  [[nodiscard]] static PartType<ShapeKind> part_type();

  BodyId body{};                   ///< the body (required)
  std::vector<Vec<2>> vertices{};  ///< at least three, in the body's frame [m]
  MaterialId material{};           ///< for laws between materials
  double radius = 0.0;             ///< >= 0: widens it all around, with rounded corners [m]
  ContactFilter filter{};          ///< what it may touch

  /// Throws ModelError for invalid values.
  void check(const PartCheck& check) const;
  /// Throws ModelError for vertices that all lie on one line but for rounding: a polygon has an area.
  void check_area(const PartCheck& check) const;
  /// Appends the points that can touch a half-plane.
  void features(std::vector<RoundedPoint>& out) const;
  /// Set with which it touches other bodies: counter-clockwise, beginning with the first vertex that is a
  /// corner, without those that repeat another one or lie between their neighbours on one line. Throws
  /// ModelError if it is not convex or crosses itself.
  [[nodiscard]] Outline outline(const PartCheck& check) const;
};

}  // namespace carom::planar
