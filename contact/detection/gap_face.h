#pragma once

/// \file
/// Narrow phase of a convex outline and one face of a polyline on ground: one-sided, with neighbours, so that
/// nothing snags where two faces join. With the face's normal n, a point E of it, and a vertex V before it,
/// gap = n.(V - E) - r.

#include <carom/contact/detection/gap_features.h>
#include <carom/contact/detection/gap_point.h>
#include <carom/contact/detection/placed_outline.h>
#include <carom/core/export.h>

#include <array>
#include <cstdint>
#include <limits>

namespace carom {

/// Corner in which two faces join.
enum class CornerTurn : std::uint8_t { convex, flat, concave };
/// Turn from one unit direction to the next; to the left it is convex.
[[nodiscard]] inline CornerTurn corner_turn(const Vec<2>& in, const Vec<2>& out) {
  constexpr double flat = 1e-9;  // a corner that nothing can feel [rad]
  const double sine = in[0] * out[1] - in[1] * out[0];
  if (sine > flat) return CornerTurn::convex;
  if (sine < -flat) return CornerTurn::concave;
  return CornerTurn::flat;
}

/// A face from `tail` to `head`: free space is on its right, solid on its left. Its features are the vertices
/// 0 (tail) and 1 (head), and the edge 2. Where two faces join in a convex corner, that belongs to the face
/// whose head it is.
struct GroundFace {
  Vec<2> before = Vec<2>::Zero(), tail = Vec<2>::Zero(), head = Vec<2>::Zero(),
         behind = Vec<2>::Zero();  ///< its ends, and the other ends of its neighbours [m]
  bool tail_is_free = false;       ///< no neighbour at the tail: the solid ends there, at a right angle
  bool head_is_free = false;       ///< no neighbour at the head: the solid ends there, at a right angle
  double depth = std::numeric_limits<double>::infinity();  ///< what is deeper does not touch it [m]
};

/// Entry of the narrow phase: a disc or a polygon, and a face.
struct GapFace {
  /// As NarrowPhase::find.
  ///
  /// The contacts are those with the ground that the face is part of. Normals are that of the face, or, at a
  /// convex corner, between those of the two faces that join there; a corner that is flat or concave touches
  /// nothing itself.
  CAROM_API static int find(const PlacedOutline& a, const PlacedOutline& b, double margin,
                            std::array<GapPoint, 2>& out);
  /// As NarrowPhase::follow.
  static GapPoint follow(const PlacedOutline& a, Index feature_a, const PlacedOutline& b, Index feature_b) {
    const std::array<Vec<2>, 2> ends{b.face->tail, b.face->head};
    return gap_of_features(a.outline, feature_a, {ends, 0.0}, feature_b);
  }
};

}  // namespace carom
