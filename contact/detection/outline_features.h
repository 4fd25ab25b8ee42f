#pragma once

/// \file
/// Names of the features of an outline in the keys of contacts (ConstraintKey).

#include <carom/contact/detection/gap_point.h>
#include <carom/core/constraint.h>
#include <carom/core/ids.h>

namespace carom {

/// The vertices of an outline, of a body or on ground, and the outline as a whole: numbers that follow one
/// another. A contact names the vertex of one side and the whole of the other.
struct OutlineFeatures {
  FeatureKey key;  ///< of its vertex 0; vertex i has the feature number i more, the whole that behind
  Range vertices;  ///< places of its vertices among those of all outlines of its list

  /// Identity of a vertex.
  [[nodiscard]] FeatureKey vertex(Index i) const { return {key.owner, key.serial, key.feature + i}; }
  /// Identity of the outline as a whole, against which a vertex of another one stands.
  [[nodiscard]] FeatureKey surface() const { return vertex(vertices.size()); }
  /// True if a feature is one of its vertices, or the whole.
  [[nodiscard]] bool has(const FeatureKey& feature) const {
    return feature.owner == key.owner && feature.serial == key.serial && feature.feature >= key.feature &&
           feature.feature <= surface().feature;
  }
  /// Place of one of its vertices among those of all.
  [[nodiscard]] Index place(const FeatureKey& vertex) const {
    return vertices.begin + (vertex.feature - key.feature);
  }
};

/// Names a contact: a vertex stands against the outline of the other side, whichever of its features is
/// nearest. Of two vertices it is the one of the outline with fewer. Two corners that meet have two contacts,
/// each with the name of another corner, though both normals may be of edges of one outline
/// (corner_meeting.h): the gap of the second one then names the two corners.
[[nodiscard]] inline ConstraintKey key_of(const OutlineFeatures& a, const OutlineFeatures& b,
                                          const GapPoint& gap) {
  bool of_a = a.vertices.size() <= b.vertices.size();
  if (gap.kind == GapKind::edge_of_a) of_a = gap.feature_a < a.vertices.size();
  if (gap.kind == GapKind::edge_of_b) of_a = gap.feature_b >= b.vertices.size();
  return of_a ? ConstraintKey{a.vertex(gap.feature_a), b.surface()}
              : ConstraintKey{a.surface(), b.vertex(gap.feature_b)};
}

}  // namespace carom
