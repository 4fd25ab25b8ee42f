#pragma once

/// \file
/// A straight segment between two points, or a capsule: its ends touch a half-plane.

#include <carom/bodies/shape_features.h>
#include <carom/core/space.h>

#include <limits>
#include <string_view>
#include <vector>

namespace carom::planar {

/// A straight segment between two points; with a radius a capsule. Its ends touch a half-plane. Fixed to a
/// planar rigid body.
struct Segment {
  static constexpr Role role = Role::shape;
  static constexpr int dimension = 2;
  static constexpr std::string_view label = "segment";
  using Kind = generic::FeatureShapeKind<Segment>;

  BodyId body{};  ///< the body (required)
  Vec<2> from =
      Vec<2>::Constant(std::numeric_limits<double>::quiet_NaN());  ///< one end, in the body's frame [m]
  Vec<2> to = Vec<2>::Constant(std::numeric_limits<double>::quiet_NaN());  ///< the other end [m]
  MaterialId material{};                                                   ///< for laws between materials
  double radius = 0.0;                                                     ///< >= 0: rounds it off [m]
  ContactFilter filter{};                                                  ///< what it may touch

  /// Throws ModelError for invalid values.
  void check(const PartCheck& check) const {
    check.finite({from.data(), 2}, "from", "m");
    check.finite({to.data(), 2}, "to", "m");
    check.non_negative(radius, "radius", "m");
    if (from == to) check.refuse("to", "the same point as from", "another point");
  }
  /// Appends the points that can touch a half-plane.
  void features(std::vector<RoundedPoint>& out) const {
    out.push_back({{from[0], from[1], 0.0}, radius});
    out.push_back({{to[0], to[1], 0.0}, radius});
  }
  /// Set with which it touches other bodies.
  [[nodiscard]] Outline outline(const PartCheck& /*check*/) const { return {{from, to}, radius}; }
};

}  // namespace carom::planar
