#pragma once

/// \file
/// Narrow phase of two vertices, sharp or rounded: with d = C_a - C_b between their centres,
/// gap = |d| - r_a - r_b and n = d/|d|.

#include <carom/contact/detection/convex_outline.h>
#include <carom/contact/detection/gap_point.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace carom {

/// Direction from a centre to another one in the very same place: upwards, whichever is a.
inline Vec<2> normal_of_coincident_centres() { return {0.0, 1.0}; }

/// Length of a vector, which becomes a unit vector; where it is zero, normal_of_coincident_centres.
inline double split_length(Vec<2>& vector) {
  // Below this, squares lose digits.
  constexpr double small_square = 1e-280;
  const double square = vector[0] * vector[0] + vector[1] * vector[1];
  if (square > small_square) {
    const double length = std::sqrt(square);
    vector /= length;
    return length;
  }
  const double length = std::hypot(vector[0], vector[1]);
  if (length > 0.0) {
    constexpr double up = 0x1p+600;  // of the smallest numbers too a quotient then has all digits
    vector = (vector * up) / (length * up);
  } else {
    vector = normal_of_coincident_centres();
  }
  return length;
}

/// How far a point stands beyond the edges that end at a vertex of an outline [m]; infinite if there is none.
inline double beyond_edges(const ConvexOutline& of, Index vertex, const Vec<2>& point) {
  double least = std::numeric_limits<double>::infinity();
  if (of.size() < 2) return least;
  for (const Index neighbour : {of.before(vertex), of.after(vertex)}) {
    Vec<2> out = of.vertices[vertex] - of.vertices[neighbour];
    split_length(out);
    least = std::min(least, out.dot(point - of.vertices[vertex]));
  }
  return least;
}

/// Gap of vertex i of a and vertex j of b. It is not signed: it grows again once centres have passed each
/// other.
inline void write_gap_of_vertices(const ConvexOutline& a, Index i, const ConvexOutline& b, Index j,
                                  GapPoint& out) {
  const Vec<2>&centre_a = a.vertices[i], &centre_b = b.vertices[j];
  out.feature_a = i;
  out.feature_b = j;
  out.kind = GapKind::vertices;
  out.normal = centre_a - centre_b;
  out.gap = split_length(out.normal) - (a.radius + b.radius);
  out.point_a = centre_a - a.radius * out.normal;
  out.point_b = centre_b + b.radius * out.normal;
  out.within = std::min(beyond_edges(a, i, centre_b), beyond_edges(b, j, centre_a));
}

/// Gap of vertex i of a and vertex j of b, as write_gap_of_vertices().
[[nodiscard]] inline GapPoint gap_of_vertices(const ConvexOutline& a, Index i, const ConvexOutline& b,
                                              Index j) {
  GapPoint out;
  write_gap_of_vertices(a, i, b, j, out);
  return out;
}

}  // namespace carom
