#pragma once

/// \file
/// Narrow phase of a convex outline inside a circle: its vertices touch. With d = C - V from a vertex to the
/// circle's centre, gap = R - r - |d| and n = d/|d|: two vertices (gap_vertex_vertex.h), the one on ground of
/// radius -R.

#include <carom/contact/detection/convex_outline.h>
#include <carom/contact/detection/gap_point.h>
#include <carom/contact/detection/gap_vertex_vertex.h>

#include <array>
#include <cstddef>
#include <limits>
#include <utility>

namespace carom {

/// Gap of a vertex of a and a circle around it (feature 0 of b). \param radius of the circle
inline GapPoint gap_inside_circle(const ConvexOutline& a, Index vertex, const Vec<2>& centre, double radius) {
  const Vec<2>& at = a.vertices[vertex];
  GapPoint out;
  out.feature_a = vertex;
  out.feature_b = 0;
  out.normal = centre - at;
  out.gap = (radius - a.radius) - split_length(out.normal);
  out.point_a = at - a.radius * out.normal;
  out.point_b = centre - radius * out.normal;
  out.within = std::numeric_limits<double>::infinity();
  return out;
}

/// Finds the two vertices of a with the least gaps, as far as these are <= `margin` [m], the least first.
/// \returns how many
[[nodiscard]] inline int find_gaps_inside_circle(const ConvexOutline& a, const Vec<2>& centre, double radius,
                                                 double margin, std::array<GapPoint, 2>& out) {
  int found = 0;
  for (Index i = 0; i < a.size(); ++i) {
    const GapPoint at = gap_inside_circle(a, i, centre, radius);
    if (!(at.gap <= margin) || (found == 2 && at.gap >= out[1].gap)) continue;
    out[found == 0 ? 0 : 1] = at;
    found = found == 0 ? 1 : 2;
    if (found == 2 && out[1].gap < out[0].gap) std::swap(out[0], out[1]);
  }
  return found;
}

}  // namespace carom
