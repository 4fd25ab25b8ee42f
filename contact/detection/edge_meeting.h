#pragma once

/// \file
/// Features that meet of two edges that face each other, of two convex outlines: the ends of their overlap.
///
/// The problem: a face of one outline, and of the other outline the edge that looks most against it.
/// Projected onto the face, the two overlap in an interval; at either end of it stands a vertex of the one
/// before the edge of the other, or, where edges are not parallel, there may be two vertices that are closer.
/// Where they do not overlap, one end of the face and what is closest to it meet.

#include <carom/contact/detection/convex_outline.h>
#include <carom/contact/detection/gap_features.h>
#include <carom/contact/detection/gap_point.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

namespace carom {

/// Vertex of an outline that is deepest behind the line of an edge.
inline Index deepest_vertex(const OutlineEdge& face, const ConvexOutline& of) {
  Index deepest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (Index i = 0; i < of.size(); ++i) {
    const double height = face.height(of.vertices[i]);
    if (height < least) {
      least = height;
      deepest = i;
    }
  }
  return deepest;
}

/// True of two neighbouring edges between which nobody can tell a corner from rounding by their directions.
inline bool are_in_line(const OutlineEdge& one, const OutlineEdge& other) {
  constexpr double in_line = 1.0 - 1e-11;  // within 5e-6 rad
  return one.length > 0.0 && other.length > 0.0 && one.along.dot(other.along) > in_line;
}

/// How much of a face an edge lies before, by its projection [m].
inline double overlap_of(const OutlineEdge& face, const OutlineEdge& edge, const ConvexOutline& of) {
  const double tail = face.coordinate(of.vertices[edge.tail]), head = face.coordinate(of.vertices[edge.head]);
  return std::min(face.length, std::max(tail, head)) - std::max(0.0, std::min(tail, head));
}

/// The edge at the deepest vertex of an outline that looks most against a face, of two in line the one that
/// lies before more of it; without length if there is none.
inline OutlineEdge facing_edge(const ConvexOutline& of, const OutlineEdge& face) {
  const Index deepest = deepest_vertex(face, of);
  const OutlineEdge before(of, of.before(deepest)), behind(of, deepest);
  if (of.size() > 2 && are_in_line(before, behind))
    return overlap_of(face, before, of) > overlap_of(face, behind, of) ? before : behind;
  const bool takes_before = behind.length == 0.0 || (before.length > 0.0 && before.along.dot(face.along) <=
                                                                                behind.along.dot(face.along));
  return takes_before ? before : behind;
}

/// A feature of the outline with the face, and one of the other.
struct FeaturePair {
  bool face_side_is_edge = false, other_side_is_edge = false;
  Index face_side = none, other_side = none;  ///< vertex, or the first one of an edge
};

/// Gap of a pair of features. \param face_is_of_a whether a is the outline with the face
inline GapPoint gap_of_pair(const FeaturePair& pair, const ConvexOutline& a, const ConvexOutline& b,
                            bool face_is_of_a) {
  const ConvexOutline &of_face = face_is_of_a ? a : b, &other = face_is_of_a ? b : a;
  const Index face_side = pair.face_side + (pair.face_side_is_edge ? of_face.size() : 0U);
  const Index other_side = pair.other_side + (pair.other_side_is_edge ? other.size() : 0U);
  return face_is_of_a ? gap_of_features(a, face_side, b, other_side)
                      : gap_of_features(a, other_side, b, face_side);
}

/// Pairs of features that meet, one or two.
class EdgeMeeting {
public:
  /// \param facing of `other`, outlives this, as does `face`
  /// \param overlap whether the hulls of the vertices overlap (or touch, but for rounding)
  /// \param open_tail,open_head the face counts as longer by this much at its ends [m]
  EdgeMeeting(const OutlineEdge& face, const OutlineEdge& facing, const ConvexOutline& of_face,
              const ConvexOutline& other, bool overlap, double open_tail = 0.0, double open_head = 0.0)
      : face_(face),
        facing_(facing),
        face_head_(of_face.vertices[face.head]),
        overlap_(overlap),
        from_(-open_tail),
        to_(face.length + open_head),
        tail_at_(face.coordinate(other.vertices[facing.head])),  // the facing edge runs the other way
        head_at_(face.coordinate(other.vertices[facing.tail])) {
    if (is_off(tail_at_ - to_, face.height(other.vertices[facing.head]))) {
      add_nearest(face.head, face_head_);
    } else if (is_off(from_ - head_at_, face.height(facing.origin))) {
      add_nearest(face.tail, face.origin);
    } else {
      add_tail_end();
      add_head_end();
    }
  }

  [[nodiscard]] int size() const { return size_; }  ///< number of pairs
  /// The i-th pair.
  [[nodiscard]] const FeaturePair& operator[](int i) const { return pairs_[static_cast<std::size_t>(i)]; }

private:
  // True if a vertex stands beyond the end of an edge. Where hulls overlap, the foot of a vertex that is
  // deeper than this is beyond the end because of rounding only.
  [[nodiscard]] bool is_off(double beyond, double height) const {
    return beyond > 0.0 && !(overlap_ && beyond <= -height);
  }

  // An overlap of this length is none, but for rounding.
  [[nodiscard]] double slack() const {
    constexpr double rounding = 16.0 * std::numeric_limits<double>::epsilon();
    return rounding * (face_.length + facing_.length);
  }

  void add(const FeaturePair& pair) { pairs_[static_cast<std::size_t>(size_++)] = pair; }
  void add_on_face(Index vertex) { add({true, false, face_.tail, vertex}); }
  void add_on_facing(Index vertex) { add({false, true, vertex, facing_.tail}); }
  void add_vertices(Index vertex, Index other) { add({false, false, vertex, other}); }

  // The only pair: an end of the face, and what of the facing edge is closest to it.
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
  // End of the overlap at the face's tail.
  void add_tail_end() {
    if (tail_at_ >= from_ || facing_.length == 0.0) {
      add_on_face(facing_.head);
      return;
    }
    const double along = facing_.coordinate(face_.origin), height = facing_.height(face_.origin);
    if (along <= slack()) return;  // beyond the other end of the facing edge
    if (is_off(along - facing_.length, height)) {
      add_vertices(face_.tail, facing_.head);
    } else {
      add_on_facing(face_.tail);
    }
  }
  // End of the overlap at the face's head.
  void add_head_end() {
    if (facing_.length == 0.0) return;  // found at the tail
    if (head_at_ <= to_) {
      add_on_face(facing_.tail);
      return;
    }
    const double along = facing_.coordinate(face_head_), height = facing_.height(face_head_);
    if (along >= facing_.length - slack()) return;
    if (is_off(-along, height)) {
      add_vertices(face_.head, facing_.tail);
    } else {
      add_on_facing(face_.head);
    }
  }

  const OutlineEdge &face_, &facing_;
  Vec<2> face_head_;
  bool overlap_;
  double from_, to_;          // ends of the face, along it
  double tail_at_, head_at_;  // of the facing edge
  std::array<FeaturePair, 2> pairs_{};
  int size_ = 0;
};

}  // namespace carom
