#pragma once

/// \file
/// Narrow phase of a convex outline and one face of a polyline on ground: one-sided, with neighbours, so that
/// nothing snags where two faces join.

#include <carom/contact/detection/convex_outline.h>
#include <carom/contact/detection/gap_point.h>
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
  Vec<2> before, tail, head, behind;  ///< its ends, and the other ends of its neighbours [m]
  bool tail_is_free = false;          ///< no neighbour at the tail: the solid ends there, at a right angle
  bool head_is_free = false;          ///< no neighbour at the head: the solid ends there, at a right angle
  double depth = std::numeric_limits<double>::infinity();  ///< what is deeper does not touch it [m]
};

/// Finds the contacts of a body's outline a with a face (b of the gaps) with gap <= `margin` [m], the one
/// with the least gap first. \returns how many
///
/// They are those of find_gaps() with the ground that the face is part of. Normals are that of the face, or,
/// at a convex corner, between those of the two faces that join there; a corner that is flat or concave
/// touches nothing itself.
[[nodiscard]] CAROM_API int find_face_gaps(const ConvexOutline& a, const GroundFace& face, double margin,
                                           std::array<GapPoint, 2>& out);

}  // namespace carom
