#pragma once

/// \file
/// One place where two convex outlines meet, or are close to each other.

#include <carom/core/ids.h>
#include <carom/core/space.h>

#include <cstdint>

namespace carom {

/// Kinds of features that meet.
enum class GapKind : std::uint8_t {
  vertices,   ///< two vertices: the normal lies along the line between them
  edge_of_a,  ///< an edge of the first and a vertex of the second: the normal turns with the first
  edge_of_b   ///< a vertex of the first and an edge of the second: the normal turns with the second
};

/// The gap between a feature of outline a and one of outline b. As long as the features stay the same it is a
/// smooth function of where the two are.
struct GapPoint {
  Index feature_a = none, feature_b = none;  ///< numbers within their outlines (ConvexOutline)
  GapKind kind = GapKind::vertices;          ///< what they are
  double gap = 0.0;                          ///< negative where they overlap [m]
  Vec<2> normal;                             ///< unit vector, from b towards a
  Vec<2> point_a, point_b;                   ///< on the two surfaces: point_a - point_b = gap * normal [m]
  /// Distance by which these features are the ones that meet [m]: of a vertex and an edge, how far from the
  /// edge's nearer end the vertex stands before it; of two vertices, how far each stands beyond the edges
  /// that end at the other. Negative where others meet; infinite for two points or discs.
  double within = 0.0;

  /// This gap with the outlines in the other order.
  [[nodiscard]] GapPoint swapped() const {
    const GapKind other = kind == GapKind::vertices    ? kind
                          : kind == GapKind::edge_of_a ? GapKind::edge_of_b
                                                       : GapKind::edge_of_a;
    return {feature_b, feature_a, other, gap, -normal, point_b, point_a, within};
  }
};

}  // namespace carom
