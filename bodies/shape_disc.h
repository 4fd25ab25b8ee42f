#pragma once

/// \file
/// A disc (the outline of a disc, a sphere or a shell).

#include <carom/core/export.h>
#include <carom/core/part.h>
#include <carom/core/shape_kind.h>
#include <carom/core/space.h>

#include <limits>
#include <string_view>
#include <vector>

namespace carom::planar {

/// A disc (the outline of a disc, a sphere or a shell). Fixed to a planar rigid body.
struct CAROM_API Disc {
  static constexpr Role role = Role::shape;
  static constexpr int dimension = 2;
  static constexpr std::string_view label = "disc";
  /// Its type, for System::add().
  [[nodiscard]] static PartType<ShapeKind> part_type();

  BodyId body{};                                             ///< the body (required)
  double radius = std::numeric_limits<double>::quiet_NaN();  ///< > 0 [m]
  Vec<2> centre = filled<2>(0.0);  ///< in the body's frame, from the centre of mass [m]
  MaterialId material{};           ///< for laws between materials
  ContactFilter filter{};          ///< what it may touch

  /// Throws ModelError for invalid values.
  void check(const PartCheck& check) const;
  /// Appends the points that can touch a half-plane.
  void features(std::vector<RoundedPoint>& out) const;
  /// Set with which it touches other bodies.
  [[nodiscard]] Outline outline(const PartCheck& check) const;
};

}  // namespace carom::planar
