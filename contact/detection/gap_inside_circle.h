#pragma once

/// \file
/// Narrow phase of a convex outline inside a circle: its vertices touch. With d = C - V from a vertex to the
/// circle's centre, gap = R - r - |d| and n = d/|d|: two vertices (gap_vertex_vertex.h), the one on ground of
/// radius -R.

#include <carom/contact/detection/gap_point.h>
#include <carom/contact/detection/gap_vertex_vertex.h>
#include <carom/contact/detection/placed_outline.h>

#include <array>
#include <cstddef>
#include <limits>
#include <utility>

namespace carom {

/// Entry of the narrow phase: a disc or a polygon, and the inside of a circle.
struct GapInsideCircle {
  /// As NarrowPhase::find: the two vertices with the least gaps.
  static int find(const PlacedOutline& a, const PlacedOutline& b, double margin,
                  std::array<GapPoint, 2>& out) {
    int found = 0;
    for (Index i = 0; i < a.outline.size(); ++i) {
      const GapPoint at = follow(a, i, b, 0);
      if (!(at.gap <= margin) || (found == 2 && at.gap >= out[1].gap)) continue;
      out[found == 0 ? 0 : 1] = at;
      found = found == 0 ? 1 : 2;
      if (found == 2 && out[1].gap < out[0].gap) std::swap(out[0], out[1]);
    }
    return found;
  }
  /// As NarrowPhase::follow: the gap of a vertex.
  static GapPoint follow(const PlacedOutline& a, Index vertex, const PlacedOutline& b, Index /*feature_b*/) {
    const Vec<2>&at = a.outline.vertices[vertex], &centre = b.outline.vertices[0];
    const double radius = b.outline.radius;
    GapPoint out;
    out.feature_a = vertex;
    out.feature_b = 0;
    out.normal = centre - at;
    out.gap = (radius - a.outline.radius) - split_length(out.normal);
    out.point_a = at - a.outline.radius * out.normal;
    out.point_b = centre - radius * out.normal;
    out.within = std::numeric_limits<double>::infinity();
    return out;
  }
};

}  // namespace carom
