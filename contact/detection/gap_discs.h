#pragma once

/// \file
/// Narrow phase of two discs or points: with d = C_a - C_b between their centres, gap = |d| - r_a - r_b and
/// n = d/|d| (gap_vertex_vertex.h).

#include <carom/contact/detection/gap_point.h>
#include <carom/contact/detection/gap_vertex_vertex.h>
#include <carom/contact/detection/placed_outline.h>

#include <array>

namespace carom {

/// Entry of the narrow phase: two discs.
struct GapDiscs {
  /// As NarrowPhase::find.
  static int find(const PlacedOutline& a, const PlacedOutline& b, double margin,
                  std::array<GapPoint, 2>& out) {
    const Vec<2>&centre_a = a.outline.vertices[0], &centre_b = b.outline.vertices[0];
    const double x = centre_a[0] - centre_b[0], y = centre_a[1] - centre_b[1];
    const double reach = a.outline.radius + b.outline.radius + margin;
    // Discs far from each other need no root; the last digits are left to the comparison below.
    if (x * x + y * y > 1.0001 * (reach * reach) || reach < 0.0) return 0;
    write_gap_of_vertices(a.outline, 0, b.outline, 0, out[0]);
    return out[0].gap <= margin ? 1 : 0;
  }
  /// As NarrowPhase::follow.
  static GapPoint follow(const PlacedOutline& a, Index feature_a, const PlacedOutline& b, Index feature_b) {
    return gap_of_vertices(a.outline, feature_a, b.outline, feature_b);
  }
};

}  // namespace carom
