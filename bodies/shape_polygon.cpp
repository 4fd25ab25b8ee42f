#include <carom/bodies/shape_features.h>
#include <carom/bodies/shape_polygon.h>
#include <carom/core/described_sets.h>
#include <carom/core/vector_length.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace carom::planar {

namespace {

// Vertices are rounded where they were computed; what is left of a line is some times this wide.
constexpr double rounding = 16.0 * std::numeric_limits<double>::epsilon();

double cross(const Vec<2>& a, const Vec<2>& b) { return a[0] * b[1] - a[1] * b[0]; }

/// The vertices with the first one first, counter-clockwise.
std::vector<Vec<2>> counter_clockwise(const std::vector<Vec<2>>& vertices) {
  double twice_area = 0.0;
  for (std::size_t i = 1; i + 1 < vertices.size(); ++i) {
    twice_area += cross(vertices[i] - vertices[0], vertices[i + 1] - vertices[0]);
  }
  std::vector<Vec<2>> ordered = vertices;
  if (twice_area < 0.0) std::reverse(ordered.begin() + 1, ordered.end());
  return ordered;
}

/// Vertices without those that repeat the one before, or are between their neighbours on one line.
std::vector<Vec<2>> corners_of(std::vector<Vec<2>> vertices, double tolerance) {
  const auto is_no_corner = [&](std::size_t i) {
    const std::size_t n = vertices.size();
    const Vec<2> in = vertices[i] - vertices[(i + n - 1) % n], out = vertices[(i + 1) % n] - vertices[i];
    if (length_of<2>(in) <= tolerance) return true;
    const double longer = std::max(length_of<2>(in), length_of<2>(out));
    return in.dot(out) >= 0.0 && std::abs(cross(in, out)) <= tolerance * longer;
  };
  for (std::size_t i = 0, kept = 0; vertices.size() > 2 && kept < vertices.size();) {
    i %= vertices.size();
    if (is_no_corner(i)) {
      vertices.erase(vertices.begin() + static_cast<std::ptrdiff_t>(i));
      kept = 0;
    } else {
      ++i;
      ++kept;
    }
  }
  return vertices;
}

/// True if two segments cross in their interiors, and do so by more than rounding.
bool cross_inside(const Vec<2>& a, const Vec<2>& b, const Vec<2>& c, const Vec<2>& d, double tolerance) {
  const auto parts = [tolerance](const Vec<2>& from, const Vec<2>& to, const Vec<2>& one,
                                 const Vec<2>& other) {
    const double first = cross(to - from, one - from), second = cross(to - from, other - from);
    const double least = tolerance * length_of<2>(to - from);
    return (first > least && second < -least) || (first < -least && second > least);
  };
  return parts(a, b, c, d) && parts(c, d, a, b);
}

/// Refuses sides that cross: what half-planes touch is no outline then either.
void check_crossing(const std::vector<Vec<2>>& vertices, const PartCheck& check) {
  double magnitude = 0.0;
  for (const Vec<2>& vertex : vertices) magnitude = std::max(magnitude, vertex.cwiseAbs().maxCoeff());
  const std::size_t n = vertices.size();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 2; j < n; ++j) {
      if (!cross_inside(vertices[i], vertices[(i + 1) % n], vertices[j], vertices[(j + 1) % n],
                        rounding * magnitude)) {
        continue;
      }
      check.refuse("vertices",
                   "crossing themselves: sides " + std::to_string(i) + " and " + std::to_string(j),
                   "a polygon whose sides meet at their corners only");
    }
  }
}

}  // namespace

void Polygon::check_area(const PartCheck& check) const {
  Vec<2> along = Vec<2>::Zero();
  double magnitude = 0.0;
  for (const Vec<2>& vertex : vertices) {
    const Vec<2> arm = vertex - vertices.front();
    if (length_of<2>(arm) > length_of<2>(along)) along = arm;
    magnitude = std::max(magnitude, vertex.cwiseAbs().maxCoeff());
  }
  const double length = length_of<2>(along);
  if (length <= rounding * magnitude) {
    check.refuse("vertices", "one point, repeated", "at least three that do not lie on one line");
  }
  const Vec<2> across = Vec<2>(-along[1], along[0]) / length;
  double width = 0.0;
  for (const Vec<2>& vertex : vertices) {
    width = std::max(width, std::abs(across.dot(vertex - vertices.front())));
  }
  if (width <= rounding * magnitude) {
    check.refuse("vertices", "on one line", "at least three that do not lie on one line (or a Segment)");
  }
}

Outline Polygon::outline(const PartCheck& check) const {
  constexpr const char* allowed =
      "a convex polygon, where bodies touch each other (others can be made of several shapes on one body)";
  double magnitude = 0.0;
  for (const Vec<2>& vertex : vertices) magnitude = std::max(magnitude, vertex.cwiseAbs().maxCoeff());
  Outline outline{corners_of(counter_clockwise(vertices), rounding * magnitude), radius};
  if (outline.vertices.size() < 3) check.refuse("vertices", "without an area", allowed);
  check_convex(check, outline.vertices, "vertices", allowed);
  return outline;
}

PartType<ShapeKind> Polygon::part_type() {
  return PartType<ShapeKind>::of<generic::FeatureShapeKind<Polygon>, Polygon>();
}

void Polygon::check(const PartCheck& check) const {
  if (vertices.size() < 3) check.refuse("number of vertices", std::to_string(vertices.size()), "at least 3");
  for (const Vec<2>& vertex : vertices) check.finite({vertex.data(), 2}, "vertex", "m");
  check.non_negative(radius, "radius", "m");
  check_area(check);
  check_crossing(vertices, check);
}

void Polygon::features(std::vector<RoundedPoint>& out) const {
  for (const Vec<2>& vertex : vertices) out.push_back({{vertex[0], vertex[1], 0.0}, radius});
}

}  // namespace carom::planar
