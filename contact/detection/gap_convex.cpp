#include <carom/contact/detection/gap_convex.h>
#include <carom/contact/detection/gap_vertex_edge.h>

#include <algorithm>
#include <cassert>
#include <limits>
#include <utility>

// The problem: a and b overlap or not as the difference of their hulls, {x - y}, holds the origin or not. Its
// edges are those of a and of -b, each paired with the vertex of the other outline that is farthest against
// its normal; the separation along the edge is the distance of the origin from its line. The separation as a
// function of direction rises to one maximum where it is positive, so that
//   - the largest separation over all edges belongs to the closest features: if the vertex stands before the
//   edge,
//     these two; else the vertex and that end of the edge beyond which it stands;
//   - if it is negative, the vertex stands before the edge, and the two are the contact of least overlap.
// What rounding leaves undecided (parallel edges, flat outlines in one line) is decided by projecting the two
// facing edges onto each other. That gives the second contact of edge on edge as well.

namespace carom {

namespace {

/// The edge of an outline along which another one is separated most.
struct Face {
  OutlineEdge edge;
  double separation = -std::numeric_limits<double>::infinity();

  [[nodiscard]] bool exists() const { return separation > -std::numeric_limits<double>::infinity(); }
};

double separation_along(const OutlineEdge& edge, const ConvexOutline& other) {
  double least = std::numeric_limits<double>::infinity();
  for (const Vec<2>& vertex : other.vertices) least = std::min(least, edge.height(vertex));
  return least;
}

/// Looks at the edges of an outline, until one separates by more than is `enough`.
Face widest_face(const ConvexOutline& of, const ConvexOutline& other, double enough) {
  Face best;
  if (of.size() < 2) return best;
  for (Index i = 0; i < of.size(); ++i) {
    const OutlineEdge edge(of, i);
    if (edge.length == 0.0) continue;
    const double separation = separation_along(edge, other);
    if (!(separation > best.separation)) continue;
    best = {edge, separation};
    if (separation > enough) break;
  }
  return best;
}

/// Which of two faces along which outlines are separated equally comes first: that which looks up, or to the
/// right, or lies there.
bool comes_first(const Face& face, const Face& other) {
  if (face.separation != other.separation) return face.separation > other.separation;
  const auto order = [](const Face& of) {
    const Vec<2> normal = of.edge.normal();
    return std::array<double, 4>{normal[1], normal[0], of.edge.origin[1], of.edge.origin[0]};
  };
  return order(face) >= order(other);
}

/// The edge at the deepest vertex of an outline that looks most against a face; without length if there is
/// none.
OutlineEdge facing_edge(const ConvexOutline& of, const OutlineEdge& face) {
  Index deepest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (Index i = 0; i < of.size(); ++i) {
    const double height = face.height(of.vertices[i]);
    if (height < least) {
      least = height;
      deepest = i;
    }
  }
  OutlineEdge before(of, of.before(deepest)), behind(of, deepest);
  const bool takes_before = behind.length == 0.0 || (before.length > 0.0 && before.along.dot(face.along) <=
                                                                                behind.along.dot(face.along));
  return takes_before ? before : behind;
}

/// A feature of the outline with the face, and one of the other.
struct FeaturePair {
  bool face_side_is_edge = false, other_side_is_edge = false;
  Index face_side = none, other_side = none;  ///< vertex, or the first one of an edge
};

/// What of two edges that face each other meets, at most two pairs.
class EdgeMeeting {
public:
  EdgeMeeting(const OutlineEdge& face, const OutlineEdge& facing, const ConvexOutline& of_face,
              const ConvexOutline& of_facing)
      : face_(face),
        facing_(facing),
        // The facing edge runs the other way.
        tail_at_(face.coordinate(of_facing.vertices[facing.head])),
        head_at_(face.coordinate(of_facing.vertices[facing.tail])),
        face_head_(of_face.vertices[face.head]) {
    const double tail_height = face.height(of_facing.vertices[facing.head]);
    const double head_height = face.height(facing.origin);
    if (is_off(tail_at_ - face.length, tail_height)) {
      add_nearest(face.head, face_head_);
    } else if (is_off(-head_at_, head_height)) {
      add_nearest(face.tail, face.origin);
    } else {
      add_tail_end();
      add_head_end();
    }
  }

  [[nodiscard]] int size() const { return size_; }
  [[nodiscard]] const FeaturePair& operator[](int i) const { return pairs_[static_cast<std::size_t>(i)]; }

private:
  /// True if a vertex stands beyond the end of an edge. Behind the edge's line only if by more than it is
  /// deep: deep inside, the foot of a vertex is beyond the end because of rounding only.
  static bool is_off(double beyond, double height) { return beyond > 0.0 && beyond > -height; }

  void add(const FeaturePair& pair) { pairs_[static_cast<std::size_t>(size_++)] = pair; }
  void add_on_face(Index vertex) { add({true, false, face_.tail, vertex}); }
  void add_on_facing(Index vertex) { add({false, true, vertex, facing_.tail}); }
  void add_vertices(Index vertex, Index other) { add({false, false, vertex, other}); }

  /// The only pair: an end of the face, and what of the facing edge is closest to it.
  void add_nearest(Index vertex, const Vec<2>& point) {
    const double along = facing_.coordinate(point), height = facing_.height(point);
    if (facing_.length == 0.0 || is_off(-along, height)) {
      add_vertices(vertex, facing_.tail);
    } else if (is_off(along - facing_.length, height)) {
      add_vertices(vertex, facing_.head);
    } else {
      add_on_facing(vertex);
    }
  }
  /// End of the overlap at the face's tail.
  void add_tail_end() {
    if (tail_at_ >= 0.0 || facing_.length == 0.0) {
      add_on_face(facing_.head);
      return;
    }
    const double along = facing_.coordinate(face_.origin), height = facing_.height(face_.origin);
    if (along <= 0.0) return;  // beyond the other end of the facing edge
    if (is_off(along - facing_.length, height)) {
      add_vertices(face_.tail, facing_.head);
    } else {
      add_on_facing(face_.tail);
    }
  }
  /// End of the overlap at the face's head.
  void add_head_end() {
    if (facing_.length == 0.0) return;  // found at the tail
    if (head_at_ <= face_.length) {
      add_on_face(facing_.tail);
      return;
    }
    const double along = facing_.coordinate(face_head_), height = facing_.height(face_head_);
    if (along >= facing_.length) return;
    if (is_off(-along, height)) {
      add_vertices(face_.head, facing_.tail);
    } else {
      add_on_facing(face_.head);
    }
  }

  const OutlineEdge &face_, &facing_;
  double tail_at_, head_at_;  // ends of the facing edge, along the face
  Vec<2> face_head_;
  std::array<FeaturePair, 2> pairs_{};
  int size_ = 0;
};

GapPoint gap_of_pair(const FeaturePair& pair, const ConvexOutline& of_face, const ConvexOutline& other) {
  if (pair.face_side_is_edge) return gap_of_edge_of_a(of_face, pair.face_side, other, pair.other_side);
  if (pair.other_side_is_edge) return gap_of_edge_of_b(of_face, pair.face_side, other, pair.other_side);
  return gap_of_vertices(of_face, pair.face_side, other, pair.other_side);
}

}  // namespace

int find_gaps_of_edges(const ConvexOutline& a, const ConvexOutline& b, double margin,
                       std::array<GapPoint, 2>& out) {
  const double enough = margin + (a.radius + b.radius);
  const Face face_a = widest_face(a, b, enough);
  if (face_a.separation > enough) return 0;
  const Face face_b = widest_face(b, a, enough);
  if (face_b.separation > enough) return 0;
  if (!face_a.exists() && !face_b.exists()) {  // all edges without length
    out[0] = gap_of_vertices(a, 0, b, 0);
    return out[0].gap <= margin ? 1 : 0;
  }

  const bool is_of_a = comes_first(face_a, face_b);
  const OutlineEdge& face = is_of_a ? face_a.edge : face_b.edge;
  const ConvexOutline &of_face = is_of_a ? a : b, &other = is_of_a ? b : a;
  const OutlineEdge facing = facing_edge(other, face);
  const EdgeMeeting meeting(face, facing, of_face, other);
  int found = 0;
  for (int i = 0; i < meeting.size(); ++i) {
    const GapPoint at = gap_of_pair(meeting[i], of_face, other);
    if (!(at.gap <= margin)) continue;
    out[static_cast<std::size_t>(found++)] = is_of_a ? at : at.swapped();
  }
  if (found == 2 && out[1].gap < out[0].gap) std::swap(out[0], out[1]);
  return found;
}

GapPoint tracked_gap(const ConvexOutline& a, Index feature_a, const ConvexOutline& b, Index feature_b) {
  assert(!(a.is_edge(feature_a) && b.is_edge(feature_b)));
  if (a.is_edge(feature_a)) return gap_of_edge_of_a(a, feature_a - a.size(), b, feature_b);
  if (b.is_edge(feature_b)) return gap_of_edge_of_b(a, feature_a, b, feature_b - b.size());
  return gap_of_vertices(a, feature_a, b, feature_b);
}

}  // namespace carom
