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
  Vec<2> along;   // unit direction of the neighbour, in the same sense as that of the face
  double length;  // of the neighbour

  [[nodiscard]] double height(const Vec<2>& point) const { return normal_of(along).dot(point - at); }
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
    bool overlap = separation <= 0.0;
    for (Index i = 0; i < a_.size() && a_.size() > 1; ++i) {
      const OutlineEdge edge(a_, i);
      if (edge.length == 0.0) continue;
      const double along_it = std::min(edge.height(ends_[0]), edge.height(ends_[1]));
      overlap = overlap && along_it <= 0.0;
      if (!(along_it > separation) || !is_between_faces(-edge.normal())) continue;
      separation = along_it;
      best = edge;
    }
    if (separation > enough) return 0;

    const bool is_of_ground = best.length == 0.0;
    const OutlineEdge& face = is_of_ground ? edge_ : best;
    const ConvexOutline &of_face = is_of_ground ? ground_ : a_, &other = is_of_ground ? a_ : ground_;
    const OutlineEdge facing = facing_edge(other, face);
    const EdgeMeeting meeting(face, facing, of_face, other, overlap, is_of_ground ? opening(tail_) : 0.0,
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
    if (face.tail_is_free) return {Corner::Turn::convex, true, face.tail, edge_.normal(), 0.0};
    const std::array<Vec<2>, 2> ends{face.before, face.tail};
    const OutlineEdge neighbour({ends, 0.0}, 0);
    return {turn_of(neighbour.along, edge_.along), false, face.tail, neighbour.along, neighbour.length};
  }
  Corner corner_at_head(const GroundFace& face) const {
    if (face.head_is_free) return {Corner::Turn::convex, true, face.head, -edge_.normal(), 0.0};
    const std::array<Vec<2>, 2> ends{face.head, face.behind};
    const OutlineEdge neighbour({ends, 0.0}, 0);
    return {turn_of(edge_.along, neighbour.along), false, face.head, neighbour.along, neighbour.length};
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
    if (at.kind == GapKind::vertices) return is_between_faces(at.normal);
    const double height = at.gap + a_.radius;
    return height >= -depth_ &&
           (height >= 0.0 || is_nearest_edge(at.feature_a - a_.size(), corner.at, height));
  }
  // True if no other edge of the outline is nearer to a point inside it.
  [[nodiscard]] bool is_nearest_edge(Index edge, const Vec<2>& point, double height) const {
    for (Index i = 0; i < a_.size(); ++i) {
      if (i != edge && OutlineEdge(a_, i).height(point) > height) return false;
    }
    return true;
  }
  // Distance of the outline from the line through a corner of the ground, negative behind it.
  [[nodiscard]] double separation_at(const Vec<2>& corner, const Vec<2>& along) const {
    double least = std::numeric_limits<double>::infinity();
    for (const Vec<2>& vertex : a_.vertices) least = std::min(least, normal_of(along).dot(vertex - corner));
    return least;
  }
  // True if it is this face, and not a neighbour, that a vertex stands before.
  [[nodiscard]] bool has_before_it(const Vec<2>& vertex) const {
    if (edge_.height(vertex) < -depth_) return false;
    return is_this_side(head_, vertex, 1.0) && is_this_side(tail_, vertex, -1.0);
  }
  // Likewise at one end. \param sense 1 at the head, -1 at the tail
  [[nodiscard]] bool is_this_side(const Corner& corner, const Vec<2>& vertex, double sense) const {
    const Vec<2> from_corner = vertex - corner.at;
    const double beyond = sense * edge_.along.dot(from_corner);
    const double beyond_neighbour = sense * corner.along.dot(from_corner), height = corner.height(vertex);
    switch (corner.turn) {
      case Corner::Turn::flat: {
        const double across = Vec<2>(edge_.along + corner.along).dot(from_corner);
        return sense > 0.0 ? across <= 0.0 : across > 0.0;
      }
      case Corner::Turn::concave:  // beyond it only what is inside the neighbour, and so behind both
        return beyond <= 0.0 || (height <= 0.0 && height >= -depth_ && beyond_neighbour <= corner.length);
      case Corner::Turn::convex:
        break;
    }
    // Inside the ridge, before both faces: the face along which the outline overlaps less.
    if (corner.is_free || beyond_neighbour <= 0.0 || !(edge_.normal().dot(from_corner) < 0.0)) return true;
    const double own = separation_at(corner.at, edge_.along), other = separation_at(corner.at, corner.along);
    return sense > 0.0 ? own >= other : own > other;
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
