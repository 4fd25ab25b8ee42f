#pragma once

/// \file
/// A convex set in the plane where it is now: what the narrow phase sees of a shape.

#include <carom/core/ids.h>
#include <carom/core/space.h>

#include <cmath>
#include <span>

namespace carom {

/// The hull of some vertices, widened by a radius; a view. One vertex: a point or a disc; two: a segment or a
/// capsule; more: a polygon, strictly convex, counter-clockwise.
///
/// Its features have numbers. With n vertices, vertex i is i, and the edge from vertex i to the next one n +
/// i. Two vertices have two edges, one for each side.
struct ConvexOutline {
  std::span<const Vec<2>> vertices{};  ///< at least one; neighbours differ [m]
  double radius = 0.0;                 ///< >= 0 [m]

  /// Number of vertices, and of edges if there are more than one.
  [[nodiscard]] Index size() const { return static_cast<Index>(vertices.size()); }
  /// Number of the vertex behind the i-th.
  [[nodiscard]] Index after(Index i) const { return i + 1 == size() ? 0 : i + 1; }
  /// Number of the vertex before the i-th.
  [[nodiscard]] Index before(Index i) const { return i == 0 ? size() - 1 : i - 1; }
  /// True if a feature is an edge.
  [[nodiscard]] bool is_edge(Index feature) const { return feature >= size(); }
};

/// An edge of an outline: the straight part of its boundary from `tail` to `head`, before it is widened.
struct OutlineEdge {
  Index tail = 0, head = 0;  ///< vertices that it connects
  Vec<2> origin;             ///< vertex `tail` [m]
  Vec<2> along;              ///< unit vector towards `head`; zero for an edge without length
  double length = 0.0;       ///< [m]

  OutlineEdge() = default;
  /// The edge that begins at a vertex.
  OutlineEdge(const ConvexOutline& of, Index vertex)
      : tail(vertex), head(of.after(vertex)), origin(of.vertices[tail]), along(of.vertices[head] - origin) {
    length = std::sqrt(along[0] * along[0] + along[1] * along[1]);
    if (length > 0.0) along /= length;
  }
  /// Unit normal, outwards.
  [[nodiscard]] Vec<2> normal() const { return {along[1], -along[0]}; }
  /// Distance of a point from `tail` along the edge [m].
  [[nodiscard]] double coordinate(const Vec<2>& point) const {
    return along[0] * (point[0] - origin[0]) + along[1] * (point[1] - origin[1]);
  }
  /// Distance of a point from the edge's line, positive outside [m].
  [[nodiscard]] double height(const Vec<2>& point) const {
    return along[1] * (point[0] - origin[0]) - along[0] * (point[1] - origin[1]);
  }
};

}  // namespace carom
