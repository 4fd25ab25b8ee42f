#pragma once

/// \file
/// Narrow phase of two convex outlines of which at least one has edges: the least distance of the two sets,
/// or, where the hulls of their vertices overlap, the least way that separates these.
///
/// Every contact is of two vertices, or of a vertex and an edge, so that its gap is a smooth function of the
/// motion (gap_features.h). Edge on edge is two contacts, the ends of the overlap of the two edges.

#include <carom/contact/detection/gap_features.h>
#include <carom/contact/detection/gap_point.h>
#include <carom/contact/detection/placed_outline.h>
#include <carom/core/export.h>

#include <array>

namespace carom {

/// Entry of the narrow phase: a polygon, and a disc or a polygon.
struct GapConvex {
  /// As NarrowPhase::find.
  ///
  /// The first contact is of the closest features or, where the hulls of the vertices overlap, along the
  /// normal of that edge of either outline along which the overlap is least. The second one is the other end
  /// of the overlap of the two edges that face each other. With the outlines in the other order the answer is
  /// the same with roles swapped, but where directions are chosen by rule: of two centres in one place
  /// (normal_of_coincident_centres), and of edges that coincide.
  CAROM_API static int find(const PlacedOutline& a, const PlacedOutline& b, double margin,
                            std::array<GapPoint, 2>& out);
  /// As NarrowPhase::follow.
  static GapPoint follow(const PlacedOutline& a, Index feature_a, const PlacedOutline& b, Index feature_b) {
    return gap_of_features(a.outline, feature_a, b.outline, feature_b);
  }
};

}  // namespace carom
