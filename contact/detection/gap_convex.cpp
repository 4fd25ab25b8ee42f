#include <carom/contact/detection/edge_meeting.h>
#include <carom/contact/detection/gap_convex.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

// The problem: the difference of the two hulls, {x - y}, holds the origin where they overlap. Its edges are
// those of a and of -b, each paired with the vertex of the other outline that is deepest behind it; the
// separation along an edge is the distance of the origin from the edge's line. As a function of direction the
// separation rises to one maximum where it is positive. So the largest separation over all edges belongs to
// the closest features: if the vertex stands before the edge, to these two, else to the vertex and that end
// of the edge beyond which it stands. If it is negative, the vertex stands before the edge, and along this
// edge the overlap is least.
//
// Cases that rounding leaves undecided (parallel edges, flat outlines in one line) are decided by projecting
// the two edges that face each other onto one another, which gives the second contact of edge on edge as well
// (edge_meeting.h).

namespace carom {

namespace {

/// The edge of an outline along which another one is separated most.
struct SeparatingEdge {
  OutlineEdge edge;
  double separation = -std::numeric_limits<double>::infinity();

  [[nodiscard]] bool exists() const { return separation > -std::numeric_limits<double>::infinity(); }
};

/// Height of an outline over the line of an edge: that of its deepest vertex.
class OutlineHeight {
public:
  explicit OutlineHeight(const ConvexOutline& of) : of_(of) {}

  /// Over one edge after the other, around an outline counter-clockwise: the deepest vertex goes around with
  /// them.
  double over(const OutlineEdge& edge) {
    if (of_.size() <= few_vertices) {
      double least = std::numeric_limits<double>::infinity();
      for (const Vec<2>& vertex : of_.vertices) least = std::min(least, edge.height(vertex));
      return least;
    }
    // After a large turn the next deepest vertex need not be downhill all the way.
    const bool turns_little = last_.dot(edge.along) > 0.5;
    if (!turns_little) deepest_ = deepest_vertex(edge, of_);
    last_ = edge.along;
    double least = edge.height(of_.vertices[deepest_]);
    for (Index next = of_.after(deepest_);; next = of_.after(next)) {
      const double height = edge.height(of_.vertices[next]);
      if (!(height < least)) return least;
      least = height;
      deepest_ = next;
    }
  }

private:
  static constexpr Index few_vertices = 8;  // they are looked at faster than chosen from

  const ConvexOutline& of_;
  Index deepest_ = 0;
  Vec<2> last_ = Vec<2>::Zero();
};

/// Looks at the edges of an outline, until one separates by more than is `enough`.
SeparatingEdge widest_face(const ConvexOutline& of, const ConvexOutline& other, double enough) {
  SeparatingEdge best;
  if (of.size() < 2) return best;
  OutlineHeight height(other);
  for (Index i = 0; i < of.size(); ++i) {
    const OutlineEdge edge(of, i);
    if (edge.length == 0.0) continue;
    const double separation = height.over(edge);
    if (!(separation > best.separation)) continue;
    best = {edge, separation};
    if (separation > enough) break;
  }
  return best;
}

/// Of an edge and one in line with it that before which the other outline stands: by their separations
/// rounding may choose either.
SeparatingEdge before_outline(const SeparatingEdge& face, const ConvexOutline& of,
                              const ConvexOutline& other) {
  if (of.size() < 3) return face;
  const OutlineEdge& edge = face.edge;
  const auto lies_beyond = [&](double sense, double end) {
    return std::all_of(other.vertices.begin(), other.vertices.end(),
                       [&](const Vec<2>& vertex) { return sense * edge.coordinate(vertex) > end; });
  };
  for (const bool at_head : {false, true}) {
    if (!lies_beyond(at_head ? 1.0 : -1.0, at_head ? edge.length : 0.0)) continue;
    const OutlineEdge next(of, at_head ? edge.head : of.before(edge.tail));
    if (are_in_line(edge, next)) return {next, OutlineHeight(other).over(next)};
  }
  return face;
}

/// Which of two faces along which outlines are separated equally comes first: that which looks up, or to the
/// right, or lies there.
bool comes_first(const SeparatingEdge& face, const SeparatingEdge& other) {
  if (face.separation != other.separation) return face.separation > other.separation;
  const auto order = [](const SeparatingEdge& of) {
    const Vec<2> normal = of.edge.normal();
    return std::array<double, 4>{normal[1], normal[0], of.edge.origin[1], of.edge.origin[0]};
  };
  return order(face) >= order(other);
}

/// True if two vertices are in one place but for the rounding of places, and of distances as large as `size`,
/// so that the line between them has no direction.
bool coincide(const Vec<2>& one, const Vec<2>& other, double size) {
  constexpr double rounding = 16.0 * std::numeric_limits<double>::epsilon();
  const double apart = std::max(std::abs(one[0] - other[0]), std::abs(one[1] - other[1]));
  return apart <= rounding * std::max({std::abs(one[0]), std::abs(one[1]), size});
}

}  // namespace

int GapConvex::find(const PlacedOutline& of_a, const PlacedOutline& of_b, double margin,
                    std::array<GapPoint, 2>& out) {
  const ConvexOutline &a = of_a.outline, &b = of_b.outline;
  const double enough = margin + (a.radius + b.radius);
  const SeparatingEdge face_a = widest_face(a, b, enough);
  if (face_a.separation > enough) return 0;
  const SeparatingEdge face_b = widest_face(b, a, enough);
  if (face_b.separation > enough) return 0;
  if (!face_a.exists() && !face_b.exists()) {  // all edges without length
    out[0] = gap_of_vertices(a, 0, b, 0);
    return out[0].gap <= margin ? 1 : 0;
  }

  const bool is_of_a = comes_first(face_a, face_b);
  const ConvexOutline &of_face = is_of_a ? a : b, &other = is_of_a ? b : a;
  const SeparatingEdge widest = before_outline(is_of_a ? face_a : face_b, of_face, other);
  const OutlineEdge& face = widest.edge;
  const OutlineEdge facing = facing_edge(other, face);
  const bool overlap = widest.separation <= 0.0;
  const EdgeMeeting meeting(face, facing, of_face, other, overlap);
  int found = 0;
  for (int i = 0; i < meeting.size(); ++i) {
    FeaturePair pair = meeting[i];
    for (const Index end : {facing.tail, facing.head}) {
      if (pair.face_side_is_edge) break;
      const Vec<2>&vertex = of_face.vertices[pair.face_side], &corner = other.vertices[end];
      // Corners that touch: the face has a normal along which the outlines are separated.
      if (coincide(vertex, corner, face.length + facing.length)) pair = {true, false, face.tail, end};
    }
    const GapPoint at = gap_of_pair(pair, a, b, is_of_a);
    if (!(at.gap <= margin)) continue;
    out[static_cast<std::size_t>(found++)] = at;
  }
  if (found < 2) return found;
  if (out[1].gap < out[0].gap) std::swap(out[0], out[1]);
  // At a larger angle an end of the face is before the facing edge only next to the corner that touches.
  constexpr double cosine_of_parallel = 0.9;
  const GapKind on_facing = is_of_a ? GapKind::edge_of_b : GapKind::edge_of_a;
  const bool is_nearly_parallel = -face.along.dot(facing.along) > cosine_of_parallel;
  return out[1].kind == on_facing && !is_nearly_parallel ? 1 : 2;
}

}  // namespace carom
