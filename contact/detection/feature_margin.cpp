// Problem: when does a vertex that slides or rolls along an outline come to the end of an edge, or of a
// rounded corner? In the frame of the outline the regions of features are bounded by straight lines, so that
// margins are linear in the place of the vertex.

#include <carom/contact/detection/edge_meeting.h>
#include <carom/contact/detection/feature_margin.h>
#include <carom/contact/detection/narrow_phase.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace carom {

namespace {

/// True of a corner that moves away from an edge while it slides along another one. \param rate its velocity
/// \param from,along normals of the two edges
bool slides_off(const Vec<2>& rate, const Vec<2>& from, const Vec<2>& along, const FeatureLengths& lengths) {
  constexpr double slides = 1e-3;  // part of a speed that is none across an edge, as where corners meet
  const double slow = slides * rate.norm();
  const double in_a_second = lengths.corner;  // what is slower rests, but for rounding
  return std::abs(along.dot(rate)) <= slow && from.dot(rate) > std::max(slow, in_a_second);
}

/// The corner of an outline that stands before an edge of the vertex's own outline. \param feature of that
Index corner_before_edge(const ConvexOutline& outline, Index feature) {
  return (feature - 2 * outline.size()) / 2;
}

}  // namespace

FeatureRegions::FeatureRegions(const OutlinePair& pair)
    : outline_(pair.outline),
      chain_(pair.chain),
      of_vertex_(pair.around),
      vertex_(pair.vertex),
      corner_(pair.corner),
      hidden_(pair.hidden),
      hidden_of_vertex_(pair.hidden_of_vertex),
      sharp_(pair.is_sharp()),
      lengths_(pair.lengths) {
  const PlaneFrame &of_vertex = pair.vertex_frame, &frame = pair.outline_frame;
  const Vec<2> arm = of_vertex.turned(pair.vertex);
  const Vec<2> from_centre = of_vertex.centre + arm - frame.centre;
  place_ = frame.turned_back(from_centre);
  shift_ = frame.turned_back(Vec<2>(of_vertex.centre - frame.centre));
  cosine_ = frame.cosine * of_vertex.cosine + frame.sine * of_vertex.sine;
  sine_ = frame.cosine * of_vertex.sine - frame.sine * of_vertex.cosine;
  rate_ = frame.turned_back(Vec<2>(of_vertex.velocity_at(arm) - frame.velocity_at(from_centre)));
}

Index FeatureRegions::nearest() const {
  const PlacedOutline point(ConvexOutline{{&place_, 1}, 0.0});
  const GapPoint found = nearest_gap(point, chain_ ? PlacedOutline(*chain_) : PlacedOutline(outline_));
  const Index feature = found.feature_b;
  // A feature that is below the ground is not in it.
  const double distance = chain_ && chain_->is_below(feature, found.gap) ? -found.gap : found.gap;
  if (!sharp_ || !has_several()) return feature;
  if (hidden_ != HiddenSide::neither || hidden_of_vertex_ != HiddenSide::neither)
    return beside_neighbour(feature);
  if (distance < -lengths_.corner_follows()) return behind_corner(feature, -distance);
  if (std::abs(distance) > lengths_.corner_follows()) return face_of_segment(feature);
  // In the place of a corner rounding decides which feature is nearest.
  for (Index corner = 0; corner < outline_.size(); ++corner) {
    const Vec<2> off = place_ - outline_.vertices[corner];
    if (std::max(std::abs(off[0]), std::abs(off[1])) <= lengths_.corner_follows())
      return touching_at(corner, feature);
  }
  return face_of_segment(feature);
}

/// Of the two faces of a segment without thickness that before which the outline of the vertex stands. A
/// vertex that has gone through the segment is behind it, although it is nearer to the other face: the
/// segment is between the vertex and the middle of its outline. \param nearest feature
Index FeatureRegions::face_of_segment(Index nearest) const {
  const Index n = outline_.size();
  if (chain_ || !is_flat(outline_) || of_vertex_.size() < 2 || !outline_.is_edge(nearest)) return nearest;
  const OutlineEdge face(outline_, nearest - n);
  Vec<2> sum = Vec<2>::Zero();
  for (const Vec<2>& vertex : of_vertex_.vertices) sum += vertex;
  const Vec<2> middle = sum / static_cast<double>(of_vertex_.size());
  const Vec<2> placed_middle = in_frame_of_outline(middle);
  const double behind = -face.height(placed_middle);
  if (!(behind > 0.0)) return nearest;
  const double above = std::max(0.0, face.height(place_)), share = above / (above + behind);
  // Two segments cross each other at the end that has gone through by the least.
  if (of_vertex_.size() == 2) {
    const OutlineEdge other(of_vertex_, 0);
    for (const Vec<2>& end : outline_.vertices) {
      if (std::abs(other.height(in_frame_of_vertex(end))) < above) return nearest;
    }
  }
  const double at_vertex = face.coordinate(place_), at_middle = face.coordinate(placed_middle);
  const double along = at_vertex + share * (at_middle - at_vertex);
  return along >= 0.0 && along <= face.length ? n + face.head : nearest;
}

/// Of the two edges at a corner the one along which the outlines are separated, or overlap least.
/// \param found the nearest feature by numbers, which is right at flat corners
Index FeatureRegions::edge_at(Index corner, Index found) const {
  const Index n = outline_.size(), before = outline_.before(corner);
  if (chain_) {
    if (chain_->corners[corner] == ChainCorner::flat) return found;
    if (chain_->face_before(corner) == none) return n + corner;
    if (chain_->face_behind(corner) == none) return n + before;
  }
  const OutlineEdge in(outline_, before), out(outline_, corner);
  if (n > 2 && are_in_line(in, out)) return n + (out.coordinate(place_) > 0.0 ? corner : before);
  return separation_along(in) > separation_along(out) ? n + before : n + corner;
}

/// The corner of the other outline that the vertex is, in the frame of the outline.
SharpCorner FeatureRegions::corner_of_vertex() const {
  const auto end = std::find(of_vertex_.vertices.begin(), of_vertex_.vertices.end(), vertex_);
  if (end == of_vertex_.vertices.end()) return {};
  SharpCorner corner = SharpCorner::of(of_vertex_, static_cast<Index>(end - of_vertex_.vertices.begin()));
  for (Vec<2>* place : {&corner.before, &corner.at, &corner.behind}) *place = in_frame_of_outline(*place);
  return corner;
}

/// The directions that both corners push in, where the vertex is at a corner of the outline, and the gaps
/// along the ends.
std::optional<FeatureRegions::Meeting> FeatureRegions::meeting_at(Index corner) const {
  if (chain_ && chain_->corners[corner] != ChainCorner::convex) return {};
  const SharpCorner a = corner_of_vertex(), b = SharpCorner::of(outline_, corner);
  const std::optional<CommonCone> cone = common_cone(a, b);
  if (!cone) return {};
  return Meeting{*cone, gap_along(cone->lower, a, b), gap_along(cone->upper, a, b)};
}

/// The feature at a corner where the directions that both corners push in end at two edges of one outline: of
/// the two pairs of the corners that of the vertex that has no edge there takes one, the other pair the other
/// one (is_lower_first()). No number where they end at an edge of either.
std::optional<Index> FeatureRegions::edge_of_one(Index corner, const Meeting& at) const {
  if (!at.cone.is_of_one()) return {};
  const bool lower_first = is_lower_first(at.lower, at.upper, lengths_.corner);
  const SharpCorner b = SharpCorner::of(outline_, corner);
  if (!at.cone.lower.is_of_a) return lower_first ? b.edge_before : b.edge_behind;
  return 2 * outline_.size() + 2 * corner + (lower_first ? 1 : 0);
}

/// The feature that a vertex deep in the outline is behind, of a corner that its outline overlaps: an end of
/// the directions that both corners push in, which need not be the nearest edge. \param found the nearest
/// edge
Index FeatureRegions::behind_corner(Index found, double depth) const {
  constexpr double far = 64.0;  // depths, as in is_near_corner()
  if (!outline_.is_edge(found) || of_vertex_.size() == 0) return found;
  const Index corner = nearer_end(outline_, found, place_);
  if (!((place_ - outline_.vertices[corner]).squaredNorm() <= far * far * depth * depth)) return found;
  const std::optional<Meeting> at = meeting_at(corner);
  if (!at) return found;
  if (const std::optional<Index> of_one = edge_of_one(corner, *at)) return *of_one;
  const SharpCorner b = SharpCorner::of(outline_, corner);
  return at->cone.lower.is_of_a ? b.edge_behind : b.edge_before;
}

/// The edge of the vertex's outline of such a feature.
ConeEnd FeatureRegions::own_edge(Index feature) const {
  ConeEnd end;
  end.is_of_a = true;
  end.is_behind = (feature - 2 * outline_.size()) % 2 == 1;
  return end;
}

/// The feature at a corner where a neighbour covers a side of it, or of the vertex: the edge that goes on in
/// the neighbour, or one that lies on that; the corner where what touches stands before none.
/// \param found the nearest feature
Index FeatureRegions::beside_neighbour(Index found) const {
  const Index n = outline_.size(), behind = n + corner_, before = n + outline_.before(corner_);
  const Index hidden = hidden_ == HiddenSide::before ? before : behind;
  if (found != corner_ && found != behind && found != before) return found;
  const bool is_closed = hidden_ == HiddenSide::both || hidden_of_vertex_ == HiddenSide::both;
  if (n == 1 || is_closed) return corner_;
  constexpr double in_line = 1e-6;  // directions that say the same, as where corners meet [rad]
  const SharpCorner own = corner_of_vertex();
  const bool ends_there = hidden_of_vertex_ == HiddenSide::behind;
  const std::array<Vec<2>, 2> ends{ends_there ? own.before : own.at, ends_there ? own.at : own.behind};
  const Vec<2> along = OutlineEdge({ends, 0.0}, 0).along;
  for (const Index edge : {behind, before}) {
    if (hidden_ != HiddenSide::neither && edge == hidden) continue;
    const OutlineEdge face(outline_, edge - n);
    const bool lies_on_it = face.along.dot(along) < 0.0 && std::abs(face.normal().dot(along)) <= in_line;
    if (hidden_of_vertex_ != HiddenSide::neither && !lies_on_it) continue;
    return margin(edge).value >= -lengths_.corner_follows() ? edge : corner_;
  }
  return corner_;
}

GapPoint FeatureRegions::gap(const ConvexOutline& point, Index feature) const {
  if (!is_of_vertex(feature)) {
    const PlacedOutline touched = chain_ ? PlacedOutline(*chain_) : PlacedOutline(outline_);
    return follow_gap(PlacedOutline(point), 0, touched, feature);
  }
  return gap_along(own_edge(feature), corner_of_vertex(),
                   SharpCorner::of(outline_, corner_before_edge(outline_, feature)));
}

/// The edge that the vertex touches at a corner, or the corner where it touches none: it stands beyond the
/// end of the edge, so that the corner stands before an edge of the other outline, or that separates them
/// more.
Index FeatureRegions::touching_at(Index corner, Index found) const {
  if (const std::optional<Meeting> at = meeting_at(corner); at && at->cone.is_of_one()) {
    const bool meet = std::max(std::abs(at->lower.gap), std::abs(at->upper.gap)) <= lengths_.corner &&
                      std::min(at->lower.within, at->upper.within) >= -lengths_.corner;
    if (meet) return *edge_of_one(corner, *at);
    if (at->cone.lower.is_of_a) return corner;
  } else if (at) {
    const bool lower_is_own = at->cone.lower.is_of_a;
    const ConeEnd &own = lower_is_own ? at->cone.lower : at->cone.upper,
                  &other = lower_is_own ? at->cone.upper : at->cone.lower;
    const double own_gap = lower_is_own ? at->lower.gap : at->upper.gap;
    const double other_gap = lower_is_own ? at->upper.gap : at->lower.gap;
    // One corner has not come to the other one yet, or passes it: what touches stands before the edge along
    // which the gap is larger, however far its outline reaches below the line of the other edge elsewhere.
    if (own_gap - other_gap > lengths_.corner) return corner;
    const SharpCorner b = SharpCorner::of(outline_, corner);
    if (other_gap - own_gap > lengths_.corner) return other.is_behind ? b.edge_behind : b.edge_before;
    if (slides_off(rate_, other.normal, own.normal, lengths_)) return corner;
  }
  if (outline_.size() == 1) return corner;
  const Index edge = edge_at(corner, found);
  if (chain_ || margin(edge).value >= -lengths_.corner) return edge;
  const auto end = std::find(of_vertex_.vertices.begin(), of_vertex_.vertices.end(), vertex_);
  const auto vertex = static_cast<Index>(end - of_vertex_.vertices.begin());
  if (vertex == of_vertex_.size()) return edge;
  const Vec<2> place = in_frame_of_vertex(outline_.vertices[corner]);
  double largest = -std::numeric_limits<double>::infinity(), along = 0.0;
  for (const Index tail : {vertex, of_vertex_.before(vertex)}) {
    const OutlineEdge other(of_vertex_, tail);
    const double separation = separation_along_other(other);
    if (!(separation > largest)) continue;
    largest = separation;
    along = std::min(other.coordinate(place), other.length - other.coordinate(place));
  }
  const bool other_touches = along >= -lengths_.corner;
  const bool separates = separation_along(OutlineEdge(outline_, edge - outline_.size())) >= largest;
  return separates && !other_touches ? edge : corner;
}

Vec<2> FeatureRegions::in_frame_of_vertex(const Vec<2>& point) const {
  const Vec<2> apart = point - shift_;
  return {cosine_ * apart[0] + sine_ * apart[1], cosine_ * apart[1] - sine_ * apart[0]};
}

Vec<2> FeatureRegions::in_frame_of_outline(const Vec<2>& point) const {
  const Vec<2> turned(cosine_ * point[0] - sine_ * point[1], sine_ * point[0] + cosine_ * point[1]);
  return shift_ + turned;
}

/// Height of the outline over an edge of that of the vertex.
double FeatureRegions::separation_along_other(const OutlineEdge& edge) const {
  double least = std::numeric_limits<double>::infinity();
  if (edge.length == 0.0) return -least;
  for (const Vec<2>& vertex : outline_.vertices) {
    least = std::min(least, edge.height(in_frame_of_vertex(vertex)));
  }
  return least;
}

double FeatureRegions::separation_along(const OutlineEdge& edge) const {
  double least = std::numeric_limits<double>::infinity();
  for (const Vec<2>& vertex : of_vertex_.vertices) {
    least = std::min(least, edge.height(in_frame_of_outline(vertex)));
  }
  return least;
}

Index FeatureRegions::coming(double slow, double near) const {
  const Index feature = nearest();
  if (sharp_) return feature;
  const FeatureMargin at = margin(feature);
  return at.value <= std::max(2.0 * border(), near) && at.rate < -slow ? at.beyond : feature;
}

bool FeatureRegions::may_touch() const {
  if (!sharp_ || !has_several()) return true;
  const Index feature = nearest();
  if (!outline_.is_edge(feature)) return false;
  const bool goes_on = chain_ || hidden_ != HiddenSide::neither || hidden_of_vertex_ != HiddenSide::neither;
  return !goes_on || margin(feature).value >= -lengths_.corner;
}

double FeatureRegions::clearance(Index feature) const {
  return chain_ ? chain_->clearance(feature, place_) : margin(feature).value;
}

FeatureMargin FeatureRegions::margin(Index feature) const {
  if (chain_) return chain_->margin(feature, place_, rate_);
  const Index n = outline_.size();
  if (is_of_vertex(feature)) {
    const SharpCorner own = corner_of_vertex();
    const bool is_behind = own_edge(feature).is_behind;
    const std::array<Vec<2>, 2> ends{is_behind ? own.at : own.before, is_behind ? own.behind : own.at};
    const OutlineEdge edge({ends, 0.0}, 0);
    const Vec<2> inwards = is_behind ? edge.along : Vec<2>(-edge.along);
    const Index corner = corner_before_edge(outline_, feature);
    return {inwards.dot(outline_.vertices[corner] - own.at), -inwards.dot(rate_), corner};
  }
  if (outline_.is_edge(feature)) {
    const OutlineEdge edge(outline_, feature - n);
    const double along = edge.coordinate(place_), speed = edge.along.dot(rate_);
    return nearer({along, speed, edge.tail}, {edge.length - along, -speed, edge.head});
  }
  const OutlineEdge behind(outline_, feature), before(outline_, outline_.before(feature));
  FeatureMargin margin =
      nearer({-behind.coordinate(place_), -behind.along.dot(rate_), n + feature},
             {before.coordinate(place_) - before.length, before.along.dot(rate_), n + before.tail});
  // Both edges of a capsule begin at the same border: what is beyond is the one on the side of the vertex.
  if (n == 2) margin.beyond = n + (behind.height(place_) > 0.0 ? behind.tail : before.tail);
  return margin;
}

}  // namespace carom
