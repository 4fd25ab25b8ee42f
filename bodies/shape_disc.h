#pragma once

/// \file
/// A disc (the outline of a disc, a sphere or a shell).

#include <carom/bodies/shape_features.h>
#include <carom/core/space.h>

#include <limits>
#include <string_view>
#include <vector>

namespace carom::planar {

/// A disc (the outline of a disc, a sphere or a shell). Fixed to a planar rigid body.
struct Disc {
  static constexpr Role role = Role::shape;
  static constexpr int dimension = 2;
  static constexpr std::string_view label = "disc";
  using Kind = generic::FeatureShapeKind<Disc>;

  BodyId body{};                                             ///< the body (required)
  double radius = std::numeric_limits<double>::quiet_NaN();  ///< > 0 [m]
  Vec<2> centre = Vec<2>::Zero();  ///< in the body's frame, from the centre of mass [m]
  MaterialId material{};           ///< for laws between materials
  ContactFilter filter{};          ///< what it may touch

  /// Throws ModelError for invalid values.
  void check(const PartCheck& check) const {
    check.positive(radius, "radius", "m");
    check.finite({centre.data(), 2}, "centre", "m");
  }
  /// Appends the points that can touch a half-plane.
  void features(std::vector<RoundedPoint>& out) const {
    out.push_back({{centre[0], centre[1], 0.0}, radius});
  }
  /// Set with which it touches other bodies.
  [[nodiscard]] Outline outline(const PartCheck& /*check*/) const { return {{centre}, radius}; }
};

}  // namespace carom::planar
