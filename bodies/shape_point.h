#pragma once

/// \file
/// A point of a body.

#include <carom/bodies/shape_features.h>
#include <carom/core/space.h>

#include <string_view>
#include <vector>

namespace carom::planar {

/// A point of a body. Fixed to a planar rigid body.
struct Point {
  static constexpr Role role = Role::shape;
  static constexpr int dimension = 2;
  static constexpr std::string_view label = "point";
  using Kind = generic::FeatureShapeKind<Point>;

  BodyId body{};                     ///< the body (required)
  Vec<2> position = Vec<2>::Zero();  ///< in the body's frame, from the centre of mass [m]
  MaterialId material{};             ///< for laws between materials
  ContactFilter filter{};            ///< what it may touch

  /// Throws ModelError for invalid values.
  void check(const PartCheck& check) const { check.finite({position.data(), 2}, "position", "m"); }
  /// Appends the points that can touch a half-plane.
  void features(std::vector<RoundedPoint>& out) const {
    out.push_back({{position[0], position[1], 0.0}, 0.0});
  }
  /// Set with which it touches other bodies.
  [[nodiscard]] Outline outline(const PartCheck& /*check*/) const { return {{position}, 0.0}; }
};

}  // namespace carom::planar
