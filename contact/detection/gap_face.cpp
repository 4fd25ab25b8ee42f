#include <carom/contact/detection/edge_meeting.h>
#include <carom/contact/detection/gap_face.h>

#include <algorithm>
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
  CornerTurn turn;
  bool is_free;
  Vec<2> at;
  Vec<2> along;   // unit direction of the neighbour, in the same sense as that of the face
  double length;  // of the neighbour

  [[nodiscard]] double height(const Vec<2>& point) const { return normal_of(along).dot(point - at); }
};

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
      if (edge.length == 0.0) continue;
      const double along_it = std::min(edge.height(ends_[0]), edge.height(ends_[1]));
      if (!(along_it > separation) || !is_between_faces(-edge.normal())) continue;
      separation = along_it;
      best = edge;
    }
    if (separation > enough) return 0;

    const bool is_of_ground = best.length == 0.0;
    const OutlineEdge& face = is_of_ground ? edge_ : best;
    const ConvexOutline &of_face = is_of_ground ? ground_ : a_, &other = is_of_ground ? a_ : ground_;
    const OutlineEdge facing = facing_edge(other, face);
    const bool overlap = separation <= 0.0 && is_cut_by(ends_);
    const EdgeMeeting meeting(face, facing, of_face, other, overlap, is_of_ground ? opening(tail_) : 0.0,
                              is_of_ground ? opening(head_) : 0.0);
    int found = 0;
    for (int i = 0; i < meeting.size(); ++i) {
      const GapPoint at = gap_of_pair(meeting[i], a_, ground_, !is_of_ground);
      if (at.gap <= margin && belongs_here(at, best)) out[static_cast<std::size_t>(found++)] = at;
    }
    if (found == 2 && out[1].gap < out[0].gap) std::swap(out[0], out[1]);
    return found;
  }

private:
  Corner corner_at_tail(const GroundFace& face) const {
    if (face.tail_is_free) return {CornerTurn::convex, true, face.tail, edge_.normal(), 0.0};
    const std::array<Vec<2>, 2> ends{face.before, face.tail};
    const OutlineEdge neighbour({ends, 0.0}, 0);
    return {corner_turn(neighbour.along, edge_.along), false, face.tail, neighbour.along, neighbour.length};
  }
  Corner corner_at_head(const GroundFace& face) const {
    if (face.head_is_free) return {CornerTurn::convex, true, face.head, -edge_.normal(), 0.0};
    const std::array<Vec<2>, 2> ends{face.head, face.behind};
    const OutlineEdge neighbour({ends, 0.0}, 0);
    return {corner_turn(edge_.along, neighbour.along), false, face.head, neighbour.along, neighbour.length};
  }
  // The ends of the neighbour, from the corner on. \param sense 1 at the head, -1 at the tail
  static std::array<Vec<2>, 2> neighbour_at(const Corner& corner, double sense) {
    return {corner.at, corner.at + sense * corner.length * corner.along};
  }
  // The face goes on beyond a corner that touches nothing itself; belongs_here() says how far.
  static double opening(const Corner& corner) {
    return corner.turn == CornerTurn::convex ? 0.0 : std::numeric_limits<double>::infinity();
  }
  // True for a direction between the normal of the face and that of a neighbour at a convex corner.
  [[nodiscard]] bool is_between_faces(const Vec<2>& direction) const {
    constexpr double slack = 1e-9;
    const double turned = cross(edge_.normal(), direction);
    if (turned >= 0.0) {
      return head_.turn == CornerTurn::convex && cross(direction, normal_of(head_.along)) >= -slack;
    }
    return tail_.turn == CornerTurn::convex && cross(normal_of(tail_.along), direction) >= -slack;
  }
  // \param best edge of the outline that separates most
  [[nodiscard]] bool belongs_here(const GapPoint& at, const OutlineEdge& best) const {
    if (at.kind == GapKind::edge_of_b) {
      return at.feature_b == ground_.size() && has_before_it(a_.vertices[at.feature_a]);
    }
    const bool is_head = at.feature_b == 1;
    const Corner& corner = is_head ? head_ : tail_;
    if (corner.turn != CornerTurn::convex) return false;
    if (at.kind == GapKind::vertices) return (is_head || corner.is_free) && is_between_faces(at.normal);
    if (!takes_edge(at.normal, corner, is_head)) return false;
    const double height = at.gap + a_.radius;
    if (height >= 0.0) return true;
    // Behind that edge: not too deep; along the edge that separates most, if the ground cuts the outline at
    // all; else inside the outline, and not nearer to another edge.
    if (height < -depth_) return false;
    const Index edge = at.feature_a - a_.size();
    if (best.length > 0.0 && best.tail == edge) {
      // Where the way out along the neighbour's normal is shorter, the neighbour is touched.
      constexpr double tie = 1e-9;
      const bool is_out_sooner = separation_at(corner.at, corner.along) > height + tie * best.length;
      if (!corner.is_free && is_out_sooner) return false;
      return is_cut_by(ends_) || (!corner.is_free && is_cut_by(neighbour_at(corner, is_head ? 1.0 : -1.0)));
    }
    return height_above_others(edge, corner.at) <= height;
  }
  // True if the hull of the outline's vertices and a segment have points in common.
  [[nodiscard]] bool is_cut_by(const std::array<Vec<2>, 2>& segment) const {
    const OutlineEdge line({segment, 0.0}, 0);
    double least = std::numeric_limits<double>::infinity(), most = -least;
    for (Index i = 0; i < a_.size(); ++i) {
      least = std::min(least, line.height(a_.vertices[i]));
      most = std::max(most, line.height(a_.vertices[i]));
      const OutlineEdge edge(a_, i);
      if (edge.length > 0.0 && std::min(edge.height(segment[0]), edge.height(segment[1])) > 0.0) return false;
    }
    return least <= 0.0 && most >= 0.0;
  }
  // True if this face, and not its neighbour, touches an edge of the outline with their common corner. That
  // is so between the two normals at its head, and where the edge lies nearly along the face. \param normal
  // of the contact
  [[nodiscard]] bool takes_edge(const Vec<2>& normal, const Corner& corner, bool is_head) const {
    constexpr double nearly_along = 0.7;  // 45 degrees
    const Vec<2> own = edge_.normal(), other = normal_of(corner.along);
    const bool is_along = own.dot(normal) > nearly_along;
    if (is_head) {
      return (corner.is_free || cross(normal, other) > 0.0) && (is_along || cross(own, normal) >= 0.0);
    }
    if (corner.is_free) return is_along || cross(normal, own) >= 0.0;
    return is_along && cross(normal, own) <= 0.0;
  }
  // Largest height of a point over the edges of the outline but one.
  [[nodiscard]] double height_above_others(Index edge, const Vec<2>& point) const {
    double most = -std::numeric_limits<double>::infinity();
    for (Index i = 0; i < a_.size(); ++i) {
      if (i != edge) most = std::max(most, OutlineEdge(a_, i).height(point));
    }
    return most;
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
  // True if it is this face, and not the neighbour at one end, that a vertex stands before. \param sense 1 at
  // the head, -1 at the tail
  [[nodiscard]] bool is_this_side(const Corner& corner, const Vec<2>& vertex, double sense) const {
    const Vec<2> from_corner = vertex - corner.at;
    const double beyond = sense * edge_.along.dot(from_corner);
    const double beyond_neighbour = sense * corner.along.dot(from_corner), height = corner.height(vertex);
    switch (corner.turn) {
      case CornerTurn::flat: {
        const double across = Vec<2>(edge_.along + corner.along).dot(from_corner);
        return sense > 0.0 ? across <= 0.0 : across > 0.0;
      }
      case CornerTurn::concave:  // beyond it only what is inside the neighbour, and so behind both
        return beyond <= 0.0 || (height <= 0.0 && height >= -depth_ && beyond_neighbour <= corner.length);
      case CornerTurn::convex:
        break;
    }
    const double own = edge_.normal().dot(from_corner);
    if (corner.is_free || beyond_neighbour <= 0.0 || own >= 0.0) return true;
    // Outside the ridge, before the neighbour, and so is all of the outline.
    if (height > 0.0 && !is_cut_by(ends_) && !is_cut_by(neighbour_at(corner, sense))) return false;
    // Inside it, before both faces: the nearer one has it, if it looks at this vertex, or if all of the
    // outline is out of that one sooner than the vertex is out of this.
    if (sense > 0.0 ? own >= height : own > height) return true;
    const double separation = separation_at(corner.at, corner.along);
    return separation < height && separation < own;
  }

  const ConvexOutline& a_;
  double depth_;
  std::array<Vec<2>, 2> ends_;
  ConvexOutline ground_;  // the face as an outline of two vertices
  OutlineEdge edge_;
  Corner tail_, head_;
};

}  // namespace

int GapFace::find(const PlacedOutline& a, const PlacedOutline& b, double margin,
                  std::array<GapPoint, 2>& out) {
  return Face(a.outline, *b.face).find(margin, out);
}

}  // namespace carom
