#pragma once

/// \file
/// Narrow phase of a vertex and an edge: with the edge's outward normal n, a point E of it, and the vertex V,
/// gap = n.(V - E) - r_edge - r_vertex.

#include <carom/contact/detection/convex_outline.h>
#include <carom/contact/detection/gap_point.h>

#include <algorithm>

namespace carom {

/// Gap of the edge of a that begins at its vertex i, and vertex j of b.
inline GapPoint gap_of_edge_of_a(const ConvexOutline& a, Index i, const ConvexOutline& b, Index j) {
  const OutlineEdge edge(a, i);
  const Vec<2> outwards = edge.normal();
  const Vec<2>& vertex = b.vertices[j];
  const double height = edge.height(vertex), along = edge.coordinate(vertex);
  GapPoint out;
  out.feature_a = a.size() + i;
  out.feature_b = j;
  out.kind = GapKind::edge_of_a;
  out.gap = height - (a.radius + b.radius);
  out.normal = -outwards;
  out.point_a = vertex - (height - a.radius) * outwards;
  out.point_b = vertex - b.radius * outwards;
  out.within = std::min(along, edge.length - along);
  return out;
}

/// Gap of vertex i of a, and the edge of b that begins at its vertex j.
inline GapPoint gap_of_edge_of_b(const ConvexOutline& a, Index i, const ConvexOutline& b, Index j) {
  return gap_of_edge_of_a(b, j, a, i).swapped();
}

}  // namespace carom
