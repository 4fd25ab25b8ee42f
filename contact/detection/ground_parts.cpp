#include <carom/bodies/shape_polygon.h>
#include <carom/contact/detection/box_grid.h>
#include <carom/contact/detection/ground_parts.h>
#include <carom/contact/detection/ground_piece_shapes.h>

#include <cmath>
#include <cstddef>
#include <string>
#include <utility>

namespace carom::planar {

namespace {

/// Faces with free space on the left of who walks along the vertices: a face runs from the later one to the
/// earlier, and so do the faces: each begins where the one before ends.
std::vector<GroundPiece> faces_along(const std::vector<Vec<2>>& vertices, bool is_closed, double depth) {
  const std::size_t n = vertices.size(), count = is_closed ? n : n - 1;
  std::vector<GroundPiece> faces;
  for (std::size_t i = count; i-- > 0;) {
    GroundPiece face{
        .form = GroundPiece::Form::face,
        .points = {vertices[(i + 2) % n], vertices[(i + 1) % n], vertices[i], vertices[(i + n - 1) % n]},
        .depth = depth};
    face.tail_is_free = !is_closed && i + 1 == count;
    face.head_is_free = !is_closed && i == 0;
    faces.push_back(std::move(face));
  }
  return faces;
}

/// Refuses faces without length, and one that goes back on the one before.
void check_faces(const std::vector<Vec<2>>& vertices, bool is_closed, const PartCheck& check) {
  const std::size_t n = vertices.size();
  const auto text = [](const Vec<2>& at) { return "(" + to_text(at[0]) + ", " + to_text(at[1]) + ")"; };
  const std::size_t joints = is_closed ? n : n - 1;
  for (std::size_t i = 0; i < joints; ++i) {
    const Vec<2>&from = vertices[i], &at = vertices[(i + 1) % n];
    if (from == at) check.refuse("vertices", text(at) + " twice in a row", "neighbours that differ");
    if (!is_closed && i + 1 == joints) break;
    const Vec<2> in = (at - from).stableNormalized(), out = (vertices[(i + 2) % n] - at).stableNormalized();
    constexpr double no_angle = 1e-9;
    if (in.dot(out) < 0.0 && std::abs(in[0] * out[1] - in[1] * out[0]) <= no_angle) {
      check.refuse("vertices", "going back at " + text(at), "faces with an angle between them");
    }
  }
}

/// True if two segments have a point in common.
bool meet(const Vec<2>& a, const Vec<2>& b, const Vec<2>& c, const Vec<2>& d) {
  const auto cross = [](const Vec<2>& u, const Vec<2>& v) { return u[0] * v[1] - u[1] * v[0]; };
  const auto parts = [&cross](const Vec<2>& from, const Vec<2>& to, const Vec<2>& one, const Vec<2>& other) {
    const double first = cross(to - from, one - from), second = cross(to - from, other - from);
    return (first > 0.0 && second > 0.0) || (first < 0.0 && second < 0.0);
  };
  return !parts(a, b, c, d) && !parts(c, d, a, b);
}

/// Refuses faces that meet beside their common corners.
void check_crossing(const std::vector<Vec<2>>& vertices, bool is_closed, const PartCheck& check) {
  const auto n = static_cast<Index>(vertices.size()), count = is_closed ? n : n - 1;
  std::vector<OwnedBox<2>> boxes;
  for (Index i = 0; i < count; ++i) {
    const Vec<2>&from = vertices[i], &to = vertices[(i + 1) % n];
    boxes.push_back({{from.cwiseMin(to), from.cwiseMax(to)}, i, none});
  }
  BoxGrid<2> grid;
  grid.build(boxes);
  for (Index i = 0; i < count; ++i) {
    grid.for_overlapping(boxes[i].box, [&](const OwnedBox<2>& other) {
      const Index j = other.number;
      if (j <= i + 1 || (is_closed && i == 0 && j + 1 == count)) return;
      if (!meet(vertices[i], vertices[i + 1], vertices[j], vertices[(j + 1) % n])) return;
      check.refuse("vertices",
                   "crossing themselves: faces " + std::to_string(i) + " and " + std::to_string(j),
                   "a line whose faces meet at their corners only");
    });
  }
}

}  // namespace

std::vector<GroundPiece> Terrain::pieces(const PartCheck& check) const {
  const std::size_t least = is_closed ? 3 : 2;
  if (vertices.size() < least) {
    check.refuse("number of vertices", std::to_string(vertices.size()), "at least " + std::to_string(least));
  }
  for (const Vec<2>& vertex : vertices) check.finite({vertex.data(), 2}, "vertex", "m");
  check.positive(depth, "depth", "m");
  check_faces(vertices, is_closed, check);
  check_crossing(vertices, is_closed, check);
  if (is_closed) return faces_along(vertices, true, depth);
  const auto down = [&](const Vec<2>& from, const Vec<2>& to) -> Vec<2> {
    const Vec<2> along = (to - from).stableNormalized();
    return {depth * along[1], -depth * along[0]};
  };
  const std::size_t n = vertices.size();
  std::vector<Vec<2>> with_sides{vertices[0] + down(vertices[0], vertices[1])};
  with_sides.insert(with_sides.end(), vertices.begin(), vertices.end());
  with_sides.emplace_back(vertices[n - 1] + down(vertices[n - 2], vertices[n - 1]));
  return faces_along(with_sides, false, depth);
}

std::vector<GroundPiece> BoxInside::pieces(const PartCheck& check) const {
  check.finite({lower.data(), 2}, "lower", "m");
  check.finite({upper.data(), 2}, "upper", "m");
  for (int i = 0; i < 2; ++i) check.positive(upper[i] - lower[i], i == 0 ? "width" : "height", "m");
  // Counter-clockwise from within, solid on the right.
  return faces_along({lower, {upper[0], lower[1]}, upper, {lower[0], upper[1]}}, true,
                     std::numeric_limits<double>::infinity());
}

std::vector<GroundPiece> CircleInside::pieces(const PartCheck& check) const {
  check.finite({centre.data(), 2}, "centre", "m");
  check.positive(radius, "radius", "m");
  return {{.form = GroundPiece::Form::hollow, .points = {centre}, .radius = radius}};
}

std::vector<GroundPiece> Wall::pieces(const PartCheck& check) const {
  check.finite({from.data(), 2}, "from", "m");
  check.finite({to.data(), 2}, "to", "m");
  check.positive(radius, "radius", "m");
  if (from == to) check.refuse("to", "the same point as from", "another point");
  return {{.form = GroundPiece::Form::solid, .points = {from, to}, .radius = radius}};
}

std::vector<GroundPiece> Block::pieces(const PartCheck& check) const {
  const Polygon polygon{.vertices = vertices, .radius = radius};
  polygon.check(check);
  return {{.form = GroundPiece::Form::solid, .points = polygon.outline(check).vertices, .radius = radius}};
}

std::vector<GroundPiece> Peg::pieces(const PartCheck& check) const {
  check.finite({centre.data(), 2}, "centre", "m");
  check.positive(radius, "radius", "m");
  return {{.form = GroundPiece::Form::solid, .points = {centre}, .radius = radius}};
}

PartType<GroundShapeKind> Terrain::part_type() {
  return PartType<GroundShapeKind>::of<generic::PieceShapeKind<Terrain>, Terrain>();
}
PartType<GroundShapeKind> BoxInside::part_type() {
  return PartType<GroundShapeKind>::of<generic::PieceShapeKind<BoxInside>, BoxInside>();
}
PartType<GroundShapeKind> CircleInside::part_type() {
  return PartType<GroundShapeKind>::of<generic::PieceShapeKind<CircleInside>, CircleInside>();
}
PartType<GroundShapeKind> Wall::part_type() {
  return PartType<GroundShapeKind>::of<generic::PieceShapeKind<Wall>, Wall>();
}
PartType<GroundShapeKind> Block::part_type() {
  return PartType<GroundShapeKind>::of<generic::PieceShapeKind<Block>, Block>();
}
PartType<GroundShapeKind> Peg::part_type() {
  return PartType<GroundShapeKind>::of<generic::PieceShapeKind<Peg>, Peg>();
}

}  // namespace carom::planar
