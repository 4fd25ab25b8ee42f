#pragma once

/// \file
/// A polygon, sharp or rounded: its vertices touch a half-plane, all of it touches other bodies.

#include <carom/bodies/shape_features.h>
#include <carom/core/export.h>
#include <carom/core/space.h>

#include <string>
#include <string_view>
#include <vector>

namespace carom::planar {

/// A polygon, in either orientation. Its vertices touch half-planes, whatever its form; to touch other bodies
/// it must be convex. Fixed to a planar rigid body.
struct Polygon {
  static constexpr Role role = Role::shape;
  static constexpr int dimension = 2;
  static constexpr std::string_view label = "polygon";
  using Kind = generic::FeatureShapeKind<Polygon>;

  BodyId body{};                   ///< the body (required)
  std::vector<Vec<2>> vertices{};  ///< at least three, in the body's frame [m]
  MaterialId material{};           ///< for laws between materials
  double radius = 0.0;             ///< >= 0: widens it all around, with rounded corners [m]
  ContactFilter filter{};          ///< what it may touch

  /// Throws ModelError for invalid values.
  void check(const PartCheck& check) const {
    if (vertices.size() < 3)
      check.refuse("number of vertices", std::to_string(vertices.size()), "at least 3");
    for (const Vec<2>& vertex : vertices) check.finite({vertex.data(), 2}, "vertex", "m");
    check.non_negative(radius, "radius", "m");
    check_area(check);
  }
  /// Throws ModelError for vertices that all lie on one line but for rounding: a polygon has an area.
  CAROM_API void check_area(const PartCheck& check) const;
  /// Appends the points that can touch a half-plane.
  void features(std::vector<RoundedPoint>& out) const {
    for (const Vec<2>& vertex : vertices) out.push_back({{vertex[0], vertex[1], 0.0}, radius});
  }
  /// Set with which it touches other bodies: counter-clockwise, beginning with the first vertex that is a
  /// corner, without those that repeat another one or lie between their neighbours on one line. Throws
  /// ModelError if it is not convex or crosses itself.
  [[nodiscard]] CAROM_API Outline outline(const PartCheck& check) const;
};

}  // namespace carom::planar
