#pragma once

/// \file
/// Gap of two given features of convex outlines, whether or not they are the ones that meet: of two vertices
/// (gap_vertex_vertex.h), or of a vertex and an edge (gap_vertex_edge.h).

#include <carom/contact/detection/convex_outline.h>
#include <carom/contact/detection/gap_point.h>
#include <carom/contact/detection/gap_vertex_edge.h>
#include <carom/contact/detection/gap_vertex_vertex.h>

#include <cassert>

namespace carom {

/// The gap of two given features (GapPoint::within says whether they meet): a smooth function of where the
/// outlines are, along the edge's normal or between the centres of the two vertices. \param feature_a a
/// feature of a, \param feature_b of b; not both edges
[[nodiscard]] inline GapPoint gap_of_features(const ConvexOutline& a, Index feature_a, const ConvexOutline& b,
                                              Index feature_b) {
  assert(!(a.is_edge(feature_a) && b.is_edge(feature_b)));
  if (a.is_edge(feature_a)) return gap_of_edge_of_a(a, feature_a - a.size(), b, feature_b);
  if (b.is_edge(feature_b)) return gap_of_edge_of_b(a, feature_a, b, feature_b - b.size());
  return gap_of_vertices(a, feature_a, b, feature_b);
}

}  // namespace carom
