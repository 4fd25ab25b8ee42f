#pragma once

/// \file
/// Which feature of a convex outline is nearest to a vertex of another body, and how far the vertex is from
/// where that changes.
///
/// The normal of such a contact is continuous there, the rate at which it turns is not: the forces of a
/// contact that lasts have a kink or a jump, over which no step of an integrator may pass.
///
/// Two sharp corners do not touch each other: whatever overlaps does so at an edge of either. A corner that
/// stands at the end of an edge to rounding, or has left it by a little, stands before that edge; else its
/// normal would be that between two places that are the same. Where two corners meet in one place, the pair
/// of either corner has the normal of one end of their common cone (corner_meeting.h), of an edge of its own
/// outline or, where both ends are edges of the other one, of an edge of that. A corner of which a neighbour
/// covers a side has the normal of its other edge only.

#include <carom/contact/detection/corner_meeting.h>
#include <carom/contact/detection/feature_region.h>
#include <carom/contact/detection/gap_point.h>
#include <carom/contact/detection/outline_pair.h>
#include <carom/core/export.h>
#include <carom/core/ids.h>

#include <optional>

namespace carom {

/// The features of the outline of a pair, as ConvexOutline counts them, seen from the vertex of the pair.
/// With n vertices, corner i that stands before an edge of the vertex's own outline is feature 2 n + 2 i, if
/// the edge ends at the vertex, or 2 n + 2 i + 1, if it begins there.
class CAROM_API FeatureRegions {
public:
  /// \param pair what it is a view of must outlive it
  explicit FeatureRegions(const OutlinePair& pair);

  /// True if there is more than one feature.
  [[nodiscard]] bool has_several() const { return outline_.size() > 1 || (sharp_ && of_vertex_.size() > 1); }
  /// True of an outline that is a segment without thickness: it has two faces, each with a side of its own.
  [[nodiscard]] static bool is_flat(const ConvexOutline& outline) {
    return outline.size() == 2 && outline.radius == 0.0;
  }
  /// True if neither vertex nor outline are rounded.
  [[nodiscard]] bool is_sharp() const { return sharp_; }
  /// The nearest feature; of sharp corners at most FeatureLengths::corner_follows() from each other the edge
  /// that one of them touches, where the vertex of the pair is that one.
  [[nodiscard]] Index nearest() const;
  /// The feature of the motion from now on: the nearest one, of rounded ones at their border that which comes
  /// next. \param slow rates of margins up to this are none [m/s] \param near margins up to this are rounding
  /// of where their zeros were found [m]
  [[nodiscard]] Index coming(double slow, double near) const;
  /// False of a sharp corner that stands before no edge, by more than FeatureLengths::corner.
  [[nodiscard]] bool may_touch() const;
  /// Distance beyond the border of a feature at which it is taken to be left [m].
  [[nodiscard]] double border() const { return sharp_ ? lengths_.corner_leaves() : lengths_.past_border(); }
  /// Margin of a feature.
  [[nodiscard]] FeatureMargin margin(Index feature) const;
  /// The gap at a feature, in the frame of the outline, of which the vertex is a. \param point the vertex,
  /// there
  [[nodiscard]] GapPoint gap(const ConvexOutline& point, Index feature) const;
  /// Distance within which the gap is smooth, if the feature is the nearest one [m].
  [[nodiscard]] double clearance(Index feature) const;

private:
  [[nodiscard]] Index face_of_segment(Index nearest) const;
  [[nodiscard]] Index touching_at(Index corner, Index found) const;
  [[nodiscard]] Index edge_at(Index corner, Index found) const;
  [[nodiscard]] SharpCorner corner_of_vertex() const;
  struct Meeting {
    CommonCone cone;  // a is the outline of the vertex
    GapPoint lower, upper;
  };
  [[nodiscard]] std::optional<Meeting> meeting_at(Index corner) const;
  [[nodiscard]] std::optional<Index> edge_of_one(Index corner, const Meeting& at) const;
  [[nodiscard]] Index behind_corner(Index found, double depth) const;
  [[nodiscard]] Index beside_neighbour(Index found) const;
  [[nodiscard]] bool is_of_vertex(Index feature) const { return feature >= 2 * outline_.size(); }
  [[nodiscard]] ConeEnd own_edge(Index feature) const;
  [[nodiscard]] Vec<2> in_frame_of_vertex(const Vec<2>& point) const;
  [[nodiscard]] Vec<2> in_frame_of_outline(const Vec<2>& point) const;
  [[nodiscard]] double separation_along_other(const OutlineEdge& edge) const;
  [[nodiscard]] double separation_along(const OutlineEdge& edge) const;

  ConvexOutline outline_;  // in the frame of its body,
  std::optional<FaceChain> chain_;
  Vec<2> place_, rate_;               // as the vertex and its velocity,
  ConvexOutline of_vertex_;           // in the frame of the other body,
  Vec<2> vertex_ = Vec<2>::Zero();    // as the vertex; that body
  Vec<2> shift_;                      // stands here in the frame of the first,
  double cosine_ = 1.0, sine_ = 0.0;  // turned by this
  Index corner_ = none;               // as of OutlinePair
  HiddenSide hidden_ = HiddenSide::neither, hidden_of_vertex_ = HiddenSide::neither;
  bool sharp_ = false;
  FeatureLengths lengths_;
};

}  // namespace carom
