#pragma once

/// \file
/// Narrow phase of a disc or a point and a chain of faces: with the feature of the chain that is nearest to
/// the centre C, of a face with a point E gap = n.(C - E) - r, of a corner K gap = |C - K| - r
/// (gap_features.h).
///
/// In the solid the gap is negative down to any depth: which faces end there, and what is below, a chain does
/// not know (FaceChain::is_below, GroundPieces::is_out_behind).

#include <carom/contact/detection/face_chain.h>
#include <carom/contact/detection/gap_features.h>
#include <carom/contact/detection/gap_point.h>
#include <carom/contact/detection/placed_outline.h>

#include <array>

namespace carom {

/// Entry of the narrow phase: a disc, and a chain of faces.
struct GapChain {
  /// As NarrowPhase::find: one contact at most.
  static int find(const PlacedOutline& a, const PlacedOutline& b, double margin,
                  std::array<GapPoint, 2>& out) {
    out[0] = follow(a, 0, b, b.chain->nearest(a.outline.vertices[0]).feature);
    return out[0].gap <= margin ? 1 : 0;
  }
  /// As NarrowPhase::follow.
  static GapPoint follow(const PlacedOutline& a, Index feature_a, const PlacedOutline& b, Index feature_b) {
    return gap_of_features(a.outline, feature_a, b.chain->outline, feature_b);
  }
};

}  // namespace carom
