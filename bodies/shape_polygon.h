#pragma once

/// \file
/// A polygon: its vertices touch a half-plane.

#include <carom/bodies/shape_features.h>
#include <carom/core/export.h>
#include <carom/core/space.h>

#include <string>
#include <string_view>
#include <vector>

namespace carom::planar {

/// A polygon: its vertices touch a half-plane. Fixed to a planar rigid body.
struct Polygon {
  static constexpr Role role = Role::shape;
  static constexpr int dimension = 2;
  static constexpr std::string_view label = "polygon";
  using Kind = generic::FeatureShapeKind<Polygon>;

  BodyId body{};                   ///< the body (required)
  std::vector<Vec<2>> vertices{};  ///< at least three, in the body's frame [m]
  MaterialId material{};           ///< for laws between materials
  ContactFilter filter{};          ///< what it may touch

  /// Throws ModelError for invalid values.
  void check(const PartCheck& check) const {
    if (vertices.size() < 3)
      check.refuse("number of vertices", std::to_string(vertices.size()), "at least 3");
    for (const Vec<2>& vertex : vertices) check.finite({vertex.data(), 2}, "vertex", "m");
    check_area(check);
  }
  /// Throws ModelError for vertices that all lie on one line but for rounding: a polygon has an area.
  CAROM_API void check_area(const PartCheck& check) const;
  /// Appends the points that can touch a half-plane.
  void features(std::vector<RoundedPoint>& out) const {
    for (const Vec<2>& vertex : vertices) out.push_back({{vertex[0], vertex[1], 0.0}, 0.0});
  }
};

}  // namespace carom::planar
