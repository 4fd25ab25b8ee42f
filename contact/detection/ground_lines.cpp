#include <carom/contact/detection/ground_lines.h>

#include <cmath>
#include <cstddef>
#include <string>
#include <utility>

namespace carom::planar {

namespace {

/// Faces with free space on the left of who walks along the vertices: a face runs from the later one to the
/// earlier.
std::vector<GroundPiece> faces_along(const std::vector<Vec<2>>& vertices, bool is_closed, double depth) {
  const std::size_t n = vertices.size(), count = is_closed ? n : n - 1;
  std::vector<GroundPiece> faces;
  for (std::size_t i = 0; i < count; ++i) {
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

}  // namespace

std::vector<GroundPiece> Terrain::pieces(const PartCheck& check) const {
  const std::size_t least = is_closed ? 3 : 2;
  if (vertices.size() < least) {
    check.refuse("number of vertices", std::to_string(vertices.size()), "at least " + std::to_string(least));
  }
  for (const Vec<2>& vertex : vertices) check.finite({vertex.data(), 2}, "vertex", "m");
  check.positive(depth, "depth", "m");
  check_faces(vertices, is_closed, check);
  return faces_along(vertices, is_closed, depth);
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

}  // namespace carom::planar
