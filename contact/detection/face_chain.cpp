// Problem: along a line of many faces a vertex touches one at a time. Its normal must not jump where nothing
// can be felt, and no corner between faces may count that is not one.

#include <carom/contact/detection/face_chain.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace carom {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace

/// Direction of the chain at a flat corner: the faces on both sides compute the same one.
Vec<2> FaceChain::along_both(Index vertex) const {
  const OutlineEdge in(outline, face_before(vertex)), out(outline, face_behind(vertex));
  return 0.5 * (in.along + out.along);
}

/// True if a point stands beyond an end of a face. \param head at its head, else at its tail
bool FaceChain::is_beyond(Index vertex, const OutlineEdge& edge, const Vec<2>& point, bool head) const {
  if (corners[vertex] == ChainCorner::flat) {
    const double across = along_both(vertex).dot(point - outline.vertices[vertex]);
    return head ? across > 0.0 : across <= 0.0;
  }
  const double along = edge.coordinate(point), beyond = head ? along - edge.length : -along;
  // A sharp corner that slides along the next face into an inner corner is before both faces, although
  // rounding holds it a little behind the one that it slides on.
  const bool is_before_both =
      corners[vertex] == ChainCorner::concave || corners[vertex] == ChainCorner::joined;
  return beyond > (is_before_both ? lengths.corner_follows() : 0.0);
}

FaceChain::Nearest FaceChain::nearest(const Vec<2>& point) const {
  Nearest best{outline.size(), std::numeric_limits<double>::quiet_NaN()};
  double least = infinity;
  const auto take = [&](Index feature, double size, double distance) {
    if (!(size < least)) return;
    least = size;
    best = {feature, distance};
  };
  const auto take_vertex = [&](Index vertex) {
    if (corners[vertex] == ChainCorner::flat) return;
    const Vec<2> off = point - outline.vertices[vertex];
    const double distance = std::sqrt(off[0] * off[0] + off[1] * off[1]);
    take(vertex, distance, distance);
  };
  for (Index i = 0; i < faces(); ++i) {
    const OutlineEdge edge(outline, i);
    const bool behind_tail = !is_beyond(edge.tail, edge, point, false),
               before_head = !is_beyond(edge.head, edge, point, true);
    if (behind_tail && before_head) {
      const double height = edge.height(point), size = std::abs(height);
      take(outline.size() + i, size, height);
    } else {
      take_vertex(behind_tail ? edge.head : edge.tail);
    }
  }
  return best;
}

/// Margin of a face at one of its ends.
FeatureMargin FaceChain::margin_at(Index vertex, const OutlineEdge& edge, const Vec<2>& point,
                                   const Vec<2>& rate, bool head) const {
  const Index n = outline.size();
  const double sense = head ? -1.0 : 1.0;
  switch (corners[vertex]) {
    case ChainCorner::concave:
      return {infinity, 0.0, none};
    case ChainCorner::flat: {
      const Vec<2> along = along_both(vertex);
      return {sense * along.dot(point - outline.vertices[vertex]), sense * along.dot(rate),
              n + (head ? face_behind(vertex) : face_before(vertex))};
    }
    case ChainCorner::convex:
    case ChainCorner::free:
    case ChainCorner::joined:
      break;
  }
  const double along = edge.coordinate(point);
  const double longer = corners[vertex] == ChainCorner::joined ? lengths.corner_follows() : 0.0;
  return {(head ? edge.length - along : along) + longer, sense * edge.along.dot(rate), vertex};
}

FeatureMargin FaceChain::margin(Index feature, const Vec<2>& point, const Vec<2>& rate) const {
  const Index n = outline.size();
  if (outline.is_edge(feature)) {
    const OutlineEdge edge(outline, feature - n);
    return nearer(margin_at(edge.tail, edge, point, rate, false),
                  margin_at(edge.head, edge, point, rate, true));
  }
  FeatureMargin least{infinity, 0.0, none};
  if (const Index face = face_behind(feature); face != none) {
    const OutlineEdge behind_it(outline, face);
    least = {-behind_it.coordinate(point), -behind_it.along.dot(rate), n + face};
  }
  if (const Index face = face_before(feature); face != none) {
    const OutlineEdge before_it(outline, face);
    least =
        nearer(least, {before_it.coordinate(point) - before_it.length, before_it.along.dot(rate), n + face});
  }
  return least;
}

double FaceChain::clearance(Index feature, const Vec<2>& point) const {
  const double to_next = margin(feature, point, Vec<2>::Zero()).value;
  if (!outline.is_edge(feature)) return to_next;
  const OutlineEdge edge(outline, feature - outline.size());
  const double along = edge.coordinate(point);
  const double to_end = std::min(along, edge.length - along);
  return std::min(
      {to_next, std::max(0.0, to_end), std::abs(edge.height(point) + depths[feature - outline.size()])});
}

}  // namespace carom
