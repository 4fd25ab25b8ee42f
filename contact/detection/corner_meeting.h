#pragma once

/// \file
/// Two sharp corners that meet: the directions in which one can push the other.
///
/// The limit of rounded corners. Let corners have a radius r. Where the arcs of two of them touch, their
/// common normal n (from b to a) is in the normal cone of b's corner, and -n in that of a's. As r goes to 0,
/// n may be any direction in both cones while the corners stand in one place, and forces of contact are what
/// all these normals and their friction cones span: as much as two rows span along the two ends of what the
/// cones have in common. An end is the normal of an edge, of either outline; both ends are edges of one
/// outline where its corner is the blunter one: a point on a ridge, a needle on a box.

#include <carom/contact/detection/convex_outline.h>
#include <carom/contact/detection/gap_point.h>
#include <carom/core/export.h>
#include <carom/core/ids.h>
#include <carom/core/space.h>

#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

namespace carom {

/// The side of a corner that a neighbour covers: the edge that ends there, or that begins there. It is no
/// face to be met: the other edge goes on in a face of the neighbour (covered_side.h). Both where two
/// neighbours cover one each: the corner meets nothing.
enum class HiddenSide : std::uint8_t { neither, before, behind, both };

/// Sides that two neighbours hide together, whichever comes first.
[[nodiscard]] inline HiddenSide hidden_by_both(HiddenSide one, HiddenSide other) {
  if (one == HiddenSide::neither || one == other) return other;
  return other == HiddenSide::neither ? one : HiddenSide::both;
}

/// A vertex of a sharp outline with its neighbours, counter-clockwise around the outline, and the numbers of
/// these features in the outline.
struct SharpCorner {
  Vec<2> before = Vec<2>::Zero();           ///< the vertex before it [m]
  Vec<2> at = Vec<2>::Zero();               ///< [m]
  Vec<2> behind = Vec<2>::Zero();           ///< the vertex behind it [m]
  bool is_point = false;                    ///< the outline has no edges: all directions are normals
  Index vertex = none;                      ///< number of the vertex
  Index edge_before = none;                 ///< of the edge that ends there
  Index edge_behind = none;                 ///< of the edge that begins there
  HiddenSide hidden = HiddenSide::neither;  ///< the side that a neighbour covers

  /// A corner of an outline.
  [[nodiscard]] static SharpCorner of(const ConvexOutline& outline, Index vertex) {
    const Index before = outline.before(vertex), n = outline.size();
    return {outline.vertices[before],
            outline.vertices[vertex],
            outline.vertices[outline.after(vertex)],
            n == 1,
            vertex,
            n + before,
            n + vertex};
  }
};

/// The end of an edge of an outline that is nearer to a point. \param edge feature number
[[nodiscard]] inline Index nearer_end(const ConvexOutline& outline, Index edge, const Vec<2>& point) {
  const Index tail = edge - outline.size(), head = outline.after(tail);
  const Vec<2> from_tail = point - outline.vertices[tail], from_head = point - outline.vertices[head];
  return from_head.squaredNorm() < from_tail.squaredNorm() ? head : tail;
}

/// Numbers of the vertices of two outlines that are nearest to a contact of them, of a and of b.
[[nodiscard]] inline std::pair<Index, Index> nearest_corners(const ConvexOutline& a, const ConvexOutline& b,
                                                             const GapPoint& contact) {
  Index i = contact.feature_a, j = contact.feature_b;
  if (contact.kind == GapKind::edge_of_a) i = nearer_end(a, i, b.vertices[j]);
  if (contact.kind == GapKind::edge_of_b) j = nearer_end(b, j, a.vertices[i]);
  return {i, j};
}

/// An end of the directions that are normals of both corners: the normal of an edge that ends at a corner.
struct ConeEnd {
  Vec<2> normal = Vec<2>::Zero();  ///< from b to a
  bool is_of_a = false;            ///< the edge is one of outline a
  bool is_behind = false;          ///< the edge begins at the corner; else it ends there
};

/// The directions that are normals of two corners: from `lower` counter-clockwise to `upper`.
struct CommonCone {
  ConeEnd lower, upper;

  /// True if both ends are edges of one outline.
  [[nodiscard]] bool is_of_one() const { return lower.is_of_a == upper.is_of_a; }
};

/// Directions that the normal cones of two corners have in common. None where that is no more than one
/// direction, as of edges that lie on each other, or all but a half circle, as of a point and the end of a
/// segment: its two sides push across it only. Nothing either where a neighbour covers a side of one: such a
/// corner has the normal of its other edge.
[[nodiscard]] CAROM_API std::optional<CommonCone> common_cone(const SharpCorner& a, const SharpCorner& b);

/// The gap of two corners along one end of their common cone, of the corner of one outline and an edge of the
/// other.
[[nodiscard]] CAROM_API GapPoint gap_along(const ConeEnd& end, const SharpCorner& a, const SharpCorner& b);

/// Which of two contacts of corners that meet comes first, where both are of edges of one outline: that
/// along the lower end if the gaps are the same, else that with the larger gap. It has the name of the corner
/// that has no edge there. \param same gaps that differ by no more are the same [m]
[[nodiscard]] inline bool is_lower_first(const GapPoint& lower, const GapPoint& upper, double same) {
  return upper.gap - lower.gap <= same;
}

/// Two sharp corners near a contact that has been found.
struct CornerMeeting {
  SharpCorner a, b;
  double same_place = 0.0;           ///< how far apart places are that count as one [m]
  bool lasts = false;                ///< the corners touched along both ends in the step before
  Vec<2> velocity = Vec<2>::Zero();  ///< of corner a against corner b [m/s]
};

/// The contact along the other one of two faces that lie on each other, where outlines that overlap are
/// separated by the same along both faces: nothing but the order of the outlines tells whose normal is that
/// of a contact then, and forces may be along both. \param contact at the other end of the overlap than that
/// where corners meet, of one corner and an edge
[[nodiscard]] CAROM_API std::optional<GapPoint> along_other_face(const GapPoint& contact,
                                                                 const CornerMeeting& meeting);

/// False of a contact that is so far from the corners at hand that these do not meet, as nearly always.
/// \param same_place how far apart places are that count as one [m]
[[nodiscard]] inline bool is_near_corner(const GapPoint& contact, double same_place) {
  if (contact.kind == GapKind::vertices) return true;
  // Farther from a corner than this many depths nothing overlaps along another edge, but of corners so blunt
  // that nobody can tell them from edges.
  constexpr double far = 64.0;
  return contact.within <= same_place + far * std::abs(contact.gap);
}

/// Sees to it that a contact of two corners is not one with a side that a neighbour covers: there it becomes
/// one along the normal of the edge that goes on in the neighbour. \returns false where they do not touch:
/// the other corner does not stand before that edge yet; or both have a hidden side, and the other edges look
/// not against each other, as of three corners in one place, of which the third one's outline bears both.
/// \param contact of the two, or of one and an edge
[[nodiscard]] CAROM_API bool leave_hidden_side(GapPoint& contact, const CornerMeeting& meeting);

/// The second contact of two sharp corners that meet: along the other end of their common cone. Nothing where
/// one corner just stands before an edge of the other outline. Where both contacts are of edges of one
/// outline, features of the second one are the two vertices (key_of(), outline_features.h), and the first one
/// becomes that which comes first. \param first contact of one corner and an edge that has been found
///
/// Corners meet where gaps along both ends are the same; where they touched along both in the step before;
/// and where they came from one place with the velocity that they have: overlap after a step is no edge's.
[[nodiscard]] CAROM_API std::optional<GapPoint> second_contact(GapPoint& first, const CornerMeeting& meeting);

}  // namespace carom
