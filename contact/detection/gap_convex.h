#pragma once

/// \file
/// Narrow phase of two convex outlines: where they meet.
///
/// Every contact is of two vertices, or of a vertex and an edge, so that its gap is a smooth function of the
/// motion (gap_vertex_vertex.h, gap_vertex_edge.h). Edge on edge is two contacts, the ends of the overlap of
/// the two edges.

#include <carom/contact/detection/convex_outline.h>
#include <carom/contact/detection/gap_point.h>
#include <carom/contact/detection/gap_vertex_vertex.h>
#include <carom/core/export.h>

#include <array>

namespace carom {

/// find_gaps() of outlines of which at least one has edges.
[[nodiscard]] CAROM_API int find_gaps_of_edges(const ConvexOutline& a, const ConvexOutline& b, double margin,
                                               std::array<GapPoint, 2>& out);

/// Finds the contacts of two outlines with gap <= `margin` [m], the one with the least gap first. \returns
/// how many
///
/// The first is of the closest features or, where the hulls of the vertices overlap, along the normal of that
/// edge of either outline along which the overlap is least; so its gap is the distance between the sets, or
/// minus the least way that separates them. The second one is the other end of the overlap of the two edges
/// that face each other. With the outlines in the other order the answer is the same with roles swapped, but
/// where directions are chosen by rule: of two centres in one place (normal_of_coincident_centres), and of
/// edges that coincide.
[[nodiscard]] inline int find_gaps(const ConvexOutline& a, const ConvexOutline& b, double margin,
                                   std::array<GapPoint, 2>& out) {
  if (a.size() > 1 || b.size() > 1) return find_gaps_of_edges(a, b, margin, out);
  const double x = a.vertices[0][0] - b.vertices[0][0], y = a.vertices[0][1] - b.vertices[0][1];
  const double reach = a.radius + b.radius + margin;
  // Discs far from each other need no root; the last digits are left to the comparison below.
  if (x * x + y * y > 1.0001 * (reach * reach) || reach < 0.0) return 0;
  out[0] = gap_of_vertices(a, 0, b, 0);
  return out[0].gap <= margin ? 1 : 0;
}

/// The gap of two given features, whether or not they are the ones that meet (GapPoint::within says that): a
/// smooth function of where the outlines are, along the edge's normal or between the centres of the two
/// vertices. \param feature_a a feature of a, \param feature_b of b; not both edges
[[nodiscard]] CAROM_API GapPoint tracked_gap(const ConvexOutline& a, Index feature_a, const ConvexOutline& b,
                                             Index feature_b);

}  // namespace carom
