#include <carom/contact/detection/edge_meeting.h>
#include <carom/contact/detection/gap_face.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>

// The problem: to touch the face as part of the ground, not as a segment of its own. So an outline is
// separated from it along its own normal only, or along the normal of an edge of the outline that lies
// between those of the faces at a convex corner; and of what meets then (edge_meeting.h) that is left out
// which belongs to a neighbour. Numbers on which two neighbours must agree are computed from their common
// corner and the same two directions, so that both have the same bits.

namespace carom {

namespace {

double cross(const Vec<2>& a, const Vec<2>& b) { return a[0] * b[1] - a[1] * b[0]; }
Vec<2> normal_of(const Vec<2>& along) { return {along[1], -along[0]}; }

/// Where the face joins a neighbour.
struct Corner {
  enum class Turn : std::uint8_t { convex, flat, concave };
  Turn turn;
  bool is_free;
  Vec<2> at;
  Vec<2> along;  // unit direction of the neighbour, in the same sense as that of the face

  [[nodiscard]] double height(const Vec<2>& point) const { return normal_of(along).dot(point - at); }
  [[nodiscard]] double coordinate(const Vec<2>& point) const { return along.dot(point - at); }
};

/// \param out direction from one of the two to the next \param sine of the turn to the left, which is convex
Corner::Turn turn_of(const Vec<2>& in, const Vec<2>& out) {
  constexpr double flat = 1e-9;  // a corner that nothing can feel [rad]
  const double sine = cross(in, out);
  if (sine > flat) return Corner::Turn::convex;
  if (sine < -flat) return Corner::Turn::concave;
  return Corner::Turn::flat;
}

class Face {
public:
  Face(const ConvexOutline& a, const GroundFace& face)
      : a_(a),
        depth_(face.depth),
        ends_{face.tail, face.head},
        ground_{ends_, 0.0},
        edge_(ground_, 0),
        tail_(corner_at_tail(face)),
        head_(corner_at_head(face)) {}
  Face(const Face&) = delete;
  Face& operator=(const Face&) = delete;

  /// Writes the contacts, and returns how many.
  int find(double margin, std::array<GapPoint, 2>& out) {
    const double enough = margin + a_.radius;
    double separation = std::numeric_limits<double>::infinity();
    for (const Vec<2>& vertex : a_.vertices) separation = std::min(separation, edge_.height(vertex));
    if (separation > enough) return 0;
    OutlineEdge best;  // of the outline, if it separates more
    for (Index i = 0; i < a_.size() && a_.size() > 1; ++i) {
      const OutlineEdge edge(a_, i);
      if (edge.length == 0.0 || !is_between_faces(-edge.normal())) continue;
      const double along_it = std::min(edge.height(ends_[0]), edge.height(ends_[1]));
      if (!(along_it > separation)) continue;
      separation = along_it;
      best = edge;
    }
    if (separation > enough) return 0;

    const bool is_of_ground = best.length == 0.0;
    const OutlineEdge& face = is_of_ground ? edge_ : best;
    const ConvexOutline &of_face = is_of_ground ? ground_ : a_, &other = is_of_ground ? a_ : ground_;
    const OutlineEdge facing = facing_edge(other, face);
    const EdgeMeeting meeting(face, facing, of_face, other, is_of_ground ? opening(tail_) : 0.0,
                              is_of_ground ? opening(head_) : 0.0);
    int found = 0;
    for (int i = 0; i < meeting.size(); ++i) {
      const GapPoint at = gap_of_pair(meeting[i], a_, ground_, !is_of_ground);
      if (at.gap <= margin && belongs_here(at)) out[static_cast<std::size_t>(found++)] = at;
    }
    if (found == 2 && out[1].gap < out[0].gap) std::swap(out[0], out[1]);
    return found;
  }

private:
  Corner corner_at_tail(const GroundFace& face) const {
    if (face.tail_is_free) return {Corner::Turn::convex, true, face.tail, edge_.normal()};
    const std::array<Vec<2>, 2> ends{face.before, face.tail};
    const Vec<2> along = OutlineEdge({ends, 0.0}, 0).along;
    return {turn_of(along, edge_.along), false, face.tail, along};
  }
  Corner corner_at_head(const GroundFace& face) const {
    if (face.head_is_free) return {Corner::Turn::convex, true, face.head, -edge_.normal()};
    const std::array<Vec<2>, 2> ends{face.head, face.behind};
    const Vec<2> along = OutlineEdge({ends, 0.0}, 0).along;
    return {turn_of(edge_.along, along), false, face.head, along};
  }
  // The face goes on beyond a corner that touches nothing itself; belongs_here() says how far.
  static double opening(const Corner& corner) {
    return corner.turn == Corner::Turn::convex ? 0.0 : std::numeric_limits<double>::infinity();
  }
  // True for a direction between the normal of the face and that of a neighbour at a convex corner.
  [[nodiscard]] bool is_between_faces(const Vec<2>& direction) const {
    constexpr double slack = 1e-9;
    const double turned = cross(edge_.normal(), direction);
    if (turned >= 0.0) {
      return head_.turn == Corner::Turn::convex && cross(direction, normal_of(head_.along)) >= -slack;
    }
    return tail_.turn == Corner::Turn::convex && cross(normal_of(tail_.along), direction) >= -slack;
  }
  [[nodiscard]] bool belongs_here(const GapPoint& at) const {
    if (at.kind == GapKind::edge_of_b) {
      return at.feature_b == ground_.size() && has_before_it(a_.vertices[at.feature_a]);
    }
    // A corner of the ground: of this face its head, and a free tail.
    const bool is_head = at.feature_b == 1;
    const Corner& corner = is_head ? head_ : tail_;
    if (corner.turn != Corner::Turn::convex || !(is_head || corner.is_free)) return false;
    if (at.gap + a_.radius < -depth_) return false;
    return at.kind != GapKind::vertices || is_between_faces(at.normal);
  }
  // True if it is this face, and not a neighbour, that a vertex stands before.
  [[nodiscard]] bool has_before_it(const Vec<2>& vertex) const {
    if (edge_.height(vertex) < -depth_) return false;
    const double beyond_head = edge_.along.dot(vertex - head_.at),
                 beyond_tail = edge_.along.dot(vertex - tail_.at);
    const double height_at_head = edge_.normal().dot(vertex - head_.at);
    const double height_at_tail = edge_.normal().dot(vertex - tail_.at);
    switch (head_.turn) {
      case Corner::Turn::concave:  // in a corner of the free space, both faces go on
        if (beyond_head > 0.0 && head_.height(vertex) > 0.0) return false;
        break;
      case Corner::Turn::flat:
        if (Vec<2>(edge_.along + head_.along).dot(vertex - head_.at) > 0.0) return false;
        break;
      case Corner::Turn::convex:  // inside a ridge: the side that is nearer
        if (!head_.is_free && height_at_head < 0.0 && head_.coordinate(vertex) > 0.0 &&
            head_.height(vertex) > height_at_head) {
          return false;
        }
    }
    switch (tail_.turn) {
      case Corner::Turn::concave:
        return !(beyond_tail < 0.0 && tail_.height(vertex) > 0.0);
      case Corner::Turn::flat:
        return Vec<2>(tail_.along + edge_.along).dot(vertex - tail_.at) > 0.0;
      case Corner::Turn::convex:
        break;
    }
    return tail_.is_free || height_at_tail >= 0.0 || tail_.coordinate(vertex) >= 0.0 ||
           tail_.height(vertex) < height_at_tail;
  }

  const ConvexOutline& a_;
  double depth_;
  std::array<Vec<2>, 2> ends_;
  ConvexOutline ground_;  // the face as an outline of two vertices
  OutlineEdge edge_;
  Corner tail_, head_;
};

}  // namespace

int find_face_gaps(const ConvexOutline& a, const GroundFace& face, double margin,
                   std::array<GapPoint, 2>& out) {
  return Face(a, face).find(margin, out);
}

}  // namespace carom
