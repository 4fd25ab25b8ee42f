// Problem: when does a vertex that slides or rolls along an outline come to the end of an edge, or of a
// rounded corner? In the frame of the outline the regions of features are bounded by straight lines, so that
// margins are linear in the place of the vertex.

#include <carom/contact/detection/feature_margin.h>
#include <carom/contact/detection/gap_convex.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace carom {

namespace {

struct Frame {
  Frame(const BodySlot& body, const StateView& state, const Evaluation& evaluation)
      : centre(state.q[body.q], state.q[body.q + 1]), velocity(state.v[body.v], state.v[body.v + 1]) {
    if (body.v_size > 2) spin = state.v[body.v + 2];
    if (body.rotation == none) return;
    cosine = evaluation.rotation[body.rotation];
    sine = evaluation.rotation[body.rotation + 1];
  }
  [[nodiscard]] Vec<2> turned(const Vec<2>& at) const {
    return {cosine * at[0] - sine * at[1], sine * at[0] + cosine * at[1]};
  }
  [[nodiscard]] Vec<2> turned_back(const Vec<2>& at) const {
    return {cosine * at[0] + sine * at[1], cosine * at[1] - sine * at[0]};
  }
  [[nodiscard]] Vec<2> velocity_at(const Vec<2>& arm) const {
    return {velocity[0] - spin * arm[1], velocity[1] + spin * arm[0]};
  }

  Vec<2> centre, velocity;
  double spin = 0.0, cosine = 1.0, sine = 0.0;
};

}  // namespace

FeatureRegions::FeatureRegions(const Assembly& assembly, const BodyOutlines& outlines,
                               const ContactPair& pair, const StateView& state, const Evaluation& evaluation)
    : outline_(outlines.described(outlines.list()[pair.outline])),
      of_vertex_(outlines.described(outlines.list()[outlines.outline_of(pair.feature)])),
      sharp_(outline_.radius + of_vertex_.radius == 0.0) {
  const BodySlots& bodies = assembly.layout()->bodies();
  const Frame of_vertex(bodies[pair.body], state, evaluation), frame(bodies[pair.other], state, evaluation);
  const Vec<2> arm = of_vertex.turned(outlines.vertices()[pair.feature]);
  const Vec<2> from_centre = of_vertex.centre + arm - frame.centre;
  place_ = frame.turned_back(from_centre);
  shift_ = frame.turned_back(Vec<2>(of_vertex.centre - frame.centre));
  cosine_ = frame.cosine * of_vertex.cosine + frame.sine * of_vertex.sine;
  sine_ = frame.cosine * of_vertex.sine - frame.sine * of_vertex.cosine;
  rate_ = frame.turned_back(Vec<2>(of_vertex.velocity_at(arm) - frame.velocity_at(from_centre)));
}

Index FeatureRegions::nearest() const {
  std::array<GapPoint, 2> found;
  static_cast<void>(find_gaps({{&place_, 1}, 0.0}, outline_, std::numeric_limits<double>::infinity(), found));
  const GapPoint& at = found[0];
  if (!sharp_ || !has_several() || std::abs(at.gap) > corner_follows) return at.feature_b;
  // In the place of a corner rounding decides which feature is nearest.
  for (Index corner = 0; corner < outline_.size(); ++corner) {
    const Vec<2> off = place_ - outline_.vertices[corner];
    if (std::max(std::abs(off[0]), std::abs(off[1])) <= corner_follows) return edge_at(corner);
  }
  return at.feature_b;
}

/// Of the two edges at a corner the one along which the outlines are separated, or overlap least.
Index FeatureRegions::edge_at(Index corner) const {
  const Index n = outline_.size(), before = outline_.before(corner);
  const double behind_corner = separation_along(OutlineEdge(outline_, corner));
  return separation_along(OutlineEdge(outline_, before)) > behind_corner ? n + before : n + corner;
}

double FeatureRegions::separation_along(const OutlineEdge& edge) const {
  double least = std::numeric_limits<double>::infinity();
  for (const Vec<2>& vertex : of_vertex_.vertices) {
    const Vec<2> turned(cosine_ * vertex[0] - sine_ * vertex[1], sine_ * vertex[0] + cosine_ * vertex[1]);
    least = std::min(least, edge.height(Vec<2>(shift_ + turned)));
  }
  return least;
}

bool FeatureRegions::may_touch() const {
  if (!sharp_ || !has_several()) return true;
  const Index feature = nearest();
  return outline_.is_edge(feature) && margin(feature).value >= -corner_touches;
}

FeatureMargin FeatureRegions::margin(Index feature) const {
  const auto nearer = [](const FeatureMargin& a, const FeatureMargin& b) {
    return b.value < a.value || (b.value == a.value && b.rate < a.rate) ? b : a;
  };
  const Index n = outline_.size();
  if (outline_.is_edge(feature)) {
    const OutlineEdge edge(outline_, feature - n);
    const double along = edge.coordinate(place_), speed = edge.along.dot(rate_);
    return nearer({along, speed, edge.tail}, {edge.length - along, -speed, edge.head});
  }
  const OutlineEdge behind(outline_, feature), before(outline_, outline_.before(feature));
  return nearer({-behind.coordinate(place_), -behind.along.dot(rate_), n + feature},
                {before.coordinate(place_) - before.length, before.along.dot(rate_), n + before.tail});
}

}  // namespace carom
