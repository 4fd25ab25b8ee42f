#include <carom/core/described_sets.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <vector>

namespace carom {

namespace {

double cross(const Vec<2>& a, const Vec<2>& b) { return a[0] * b[1] - a[1] * b[0]; }

std::string text(const Vec<2>& at) { return "(" + to_text(at[0]) + ", " + to_text(at[1]) + ")"; }

bool is_clockwise(std::span<const Vec<2>> vertices) {
  double twice_area = 0.0;
  for (std::size_t i = 1; i + 1 < vertices.size(); ++i) {
    twice_area += cross(vertices[i] - vertices[0], vertices[i + 1] - vertices[0]);
  }
  return twice_area < 0.0;
}

/// Demands finite vertices, of which neighbours differ, of a convex set. \param allowed as of check_convex()
void check_set(const PartCheck& check, std::span<const Vec<2>> vertices, const std::string& quantity,
               const std::string& allowed) {
  const std::size_t n = vertices.size();
  for (const Vec<2>& vertex : vertices) check.finite({vertex.data(), 2}, quantity, "m");
  for (std::size_t i = 0; n > 1 && i < n; ++i) {
    if (vertices[i] != vertices[(i + 1) % n]) continue;
    check.refuse(quantity, text(vertices[i]) + " twice in a row", "neighbours that differ");
  }
  if (n < 3) return;
  if (is_clockwise(vertices)) check.refuse(quantity, "clockwise", "counter-clockwise");
  check_convex(check, vertices, quantity, allowed);
}

void demand_points(const PartCheck& check, const GroundPiece& piece, const std::string& of, bool fits,
                   const char* allowed) {
  if (!fits) check.refuse("number of points" + of, std::to_string(piece.points.size()), allowed);
}

void check_face(const PartCheck& check, const GroundPiece& face, const std::string& of) {
  demand_points(check, face, of, face.points.size() == 4,
                "4 of a face: the vertex before it, its tail, its head, the vertex behind it");
  for (std::size_t i = 0; i < face.points.size(); ++i) {
    const bool has_meaning = i == 0 ? !face.tail_is_free : i == 3 ? !face.head_is_free : true;
    if (has_meaning) check.finite({face.points[i].data(), 2}, "points" + of, "m");
  }
  if (face.points[1] == face.points[2]) {
    check.refuse("points" + of, text(face.points[1]) + " twice", "a tail and a head that differ");
  }
  if (!(face.depth > 0.0)) check.refuse("depth" + of, to_text(face.depth) + " m", "> 0");
}

/// How far a set reaches in a direction of length 1 [m].
double reach(std::span<const RoundedPoint> points, const Vec<2>& to) {
  double most = -std::numeric_limits<double>::infinity();
  for (const RoundedPoint& point : points) {
    most = std::max(most, to[0] * point.centre[0] + to[1] * point.centre[1] + point.radius);
  }
  return most;
}

double reach(std::span<const Outline> outlines, const Vec<2>& to) {
  double most = -std::numeric_limits<double>::infinity();
  for (const Outline& outline : outlines) {
    for (const Vec<2>& vertex : outline.vertices) most = std::max(most, to.dot(vertex) + outline.radius);
  }
  return most;
}

/// True if each vertex is a point, and each point one: as the shapes of the library are.
bool has_same_corners(std::span<const RoundedPoint> points, std::span<const Outline> outlines) {
  if (outlines.size() != 1 || outlines[0].vertices.size() != points.size()) return false;
  return std::ranges::all_of(outlines[0].vertices, [&](const Vec<2>& vertex) {
    return std::ranges::any_of(points, [&](const RoundedPoint& point) {
      return point.centre[0] == vertex[0] && point.centre[1] == vertex[1] &&
             point.radius == outlines[0].radius;
    });
  });
}

/// Directions in which two sets that differ are likely to differ most: normals of edges, and around.
std::vector<Vec<2>> directions_of(std::span<const Outline> outlines) {
  constexpr int around = 64;
  std::vector<Vec<2>> directions;
  for (int i = 0; i < around; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / around;
    directions.emplace_back(std::cos(angle), std::sin(angle));
  }
  for (const Outline& outline : outlines) {
    const std::size_t n = outline.vertices.size();
    for (std::size_t i = 0; n > 1 && i < n; ++i) {
      const Vec<2> along = (outline.vertices[(i + 1) % n] - outline.vertices[i]).stableNormalized();
      directions.emplace_back(along[1], -along[0]);
    }
  }
  return directions;
}

}  // namespace

void check_convex(const PartCheck& check, std::span<const Vec<2>> vertices, std::string_view quantity,
                  const std::string& allowed) {
  const std::size_t n = vertices.size();
  double turning = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec<2>& vertex = vertices[i];
    const Vec<2> in = vertex - vertices[(i + n - 1) % n], out = vertices[(i + 1) % n] - vertex;
    if (!(cross(in, out) > 0.0)) check.refuse(quantity, "not convex at " + text(vertex), allowed);
    turning += std::atan2(cross(in, out), in.dot(out));
  }
  // All turn to the left, but perhaps around more than once, as a pentagram does.
  if (turning > 3.0 * std::numbers::pi) check.refuse(quantity, "crossing themselves", allowed);
}

void check_rounded_points(const PartCheck& check, std::span<const RoundedPoint> points) {
  for (const RoundedPoint& point : points) {
    check.finite({point.centre.data(), point.centre.size()}, "place of a point that touches", "m");
    check.non_negative(point.radius, "radius of a point that touches", "m");
  }
}

void check_outline(const PartCheck& check, const Outline& outline) {
  if (outline.vertices.empty()) check.refuse("number of vertices of its outline", "0", "at least 1");
  check.non_negative(outline.radius, "radius of its outline", "m");
  check_set(
      check, outline.vertices, "vertices of its outline",
      "a convex polygon with a vertex at each corner (others can be made of several shapes on one body)");
}

void check_same_set(const PartCheck& check, std::span<const RoundedPoint> points,
                    std::span<const Outline> outlines) {
  // Far above the rounding of any way to describe a set, far below what is meant by it.
  constexpr double same = 1e-6;
  if (points.empty() || outlines.empty() || has_same_corners(points, outlines)) return;
  double size = 0.0;
  const std::vector<Vec<2>> directions = directions_of(outlines);
  for (const Vec<2>& to : directions) size = std::max(size, std::abs(reach(outlines, to)));
  for (const Vec<2>& to : directions) {
    const double by_points = reach(points, to), by_outlines = reach(outlines, to);
    if (std::abs(by_points - by_outlines) <= same * size) continue;
    check.refuse("points that touch",
                 "reaching " + to_text(by_points) + " m from the centre of mass along " + text(to) +
                     ", its outline " + to_text(by_outlines) + " m",
                 "points and an outline of the same set");
  }
}

void check_pieces(const PartCheck& check, std::span<const GroundPiece> pieces) {
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const GroundPiece& piece = pieces[i];
    const std::string of = " of piece " + std::to_string(i);
    switch (piece.form) {
      case GroundPiece::Form::solid:
        demand_points(check, piece, of, !piece.points.empty(), "at least 1 of a solid");
        check.non_negative(piece.radius, "radius" + of, "m");
        check_set(check, piece.points, "points" + of,
                  "a convex polygon with a point at each corner (others can be made of several pieces)");
        break;
      case GroundPiece::Form::face:
        check_face(check, piece, of);
        break;
      case GroundPiece::Form::hollow:
        demand_points(check, piece, of, piece.points.size() == 1, "1 of a hollow: its centre");
        check.finite({piece.points[0].data(), 2}, "points" + of, "m");
        check.positive(piece.radius, "radius" + of, "m");
        break;
      default:
        check.refuse("form" + of, std::to_string(static_cast<int>(piece.form)), "solid, face or hollow");
    }
  }
}

}  // namespace carom
