#pragma once

// The distance of two convex outlines by another way, in long double: from the hull of all differences of
// their vertices, whose distance from the origin it is. And outlines to ask it about.

#include <carom/contact/detection/convex_outline.h>

#include "tests/random.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

namespace carom_test {

using Long = long double;
struct LongVec {
  Long x = 0, y = 0;
  friend LongVec operator-(LongVec a, LongVec b) { return {a.x - b.x, a.y - b.y}; }
};
inline Long cross(LongVec a, LongVec b) { return a.x * b.y - a.y * b.x; }
inline Long dot(LongVec a, LongVec b) { return a.x * b.x + a.y * b.y; }
inline Long length(LongVec a) { return std::sqrt(dot(a, a)); }

// Vertices and a radius that own their numbers.
struct OwnedOutline {
  std::vector<carom::Vec<2>> vertices;
  double radius = 0.0;

  [[nodiscard]] carom::ConvexOutline view() const { return {vertices, radius}; }
  [[nodiscard]] OwnedOutline moved(double angle, const carom::Vec<2>& shift) const {
    OwnedOutline out = *this;
    for (carom::Vec<2>& at : out.vertices) {
      at = carom::Vec<2>(std::cos(angle) * at[0] - std::sin(angle) * at[1],
                         std::sin(angle) * at[0] + std::cos(angle) * at[1]) +
           shift;
    }
    return out;
  }
};

// Convex hull, counter-clockwise, without points on its edges (Andrew's monotone chain).
inline std::vector<LongVec> hull_of(std::vector<LongVec> points) {
  std::sort(points.begin(), points.end(),
            [](LongVec a, LongVec b) { return std::pair(a.x, a.y) < std::pair(b.x, b.y); });
  std::vector<LongVec> hull;
  const auto chain = [&hull](LongVec next, std::size_t first) {
    while (hull.size() >= first + 2 && cross(hull.back() - hull[hull.size() - 2], next - hull.back()) <= 0) {
      hull.pop_back();
    }
    hull.push_back(next);
  };
  for (const LongVec& point : points) chain(point, 0);
  hull.pop_back();
  const std::size_t first = hull.size();
  std::for_each(points.rbegin(), points.rend(), [&](LongVec point) { chain(point, first); });
  hull.pop_back();
  if (hull.empty()) hull.push_back(points.front());
  return hull;
}

struct ReferenceGap {
  Long gap = 0;    // of the outlines
  Long core = 0;   // of the hulls of their vertices
  LongVec normal;  // from b to a
  Long next = 0;   // how much deeper the next best direction is, where they overlap; else infinite
};

inline ReferenceGap reference_gap(const OwnedOutline& a, const OwnedOutline& b) {
  std::vector<LongVec> differences;
  for (const auto& p : a.vertices) {
    for (const auto& q : b.vertices)
      differences.push_back({Long(p[0]) - Long(q[0]), Long(p[1]) - Long(q[1])});
  }
  const std::vector<LongVec> hull = hull_of(std::move(differences));
  const std::size_t n = hull.size();
  ReferenceGap out;
  Long nearest = std::numeric_limits<Long>::infinity();
  bool inside = n > 2;
  for (std::size_t i = 0; i < n; ++i) {  // the nearest point of the boundary
    const LongVec from = hull[i], along = hull[(i + 1) % n] - from;
    const Long share = n == 1 ? 0 : std::clamp(-dot(from, along) / dot(along, along), Long(0), Long(1));
    const LongVec at{from.x + share * along.x, from.y + share * along.y};
    if (length(at) < nearest) {
      nearest = length(at);
      out.normal = {at.x / nearest, at.y / nearest};
    }
    inside = inside && cross(along, LongVec{} - from) > 0;
  }
  out.core = nearest;
  out.next = std::numeric_limits<Long>::infinity();
  if (inside) {
    std::vector<Long> depths;
    nearest = std::numeric_limits<Long>::infinity();
    for (std::size_t i = 0; i < n; ++i) {
      const LongVec from = hull[i], along = hull[(i + 1) % n] - from;
      const Long depth = cross(along, LongVec{} - from) / length(along);
      depths.push_back(depth);
      if (depth < nearest) {
        nearest = depth;
        out.normal = {-along.y / length(along), along.x / length(along)};
      }
    }
    std::sort(depths.begin(), depths.end());
    out.core = -nearest;
    out.next = depths[1] - depths[0];
  }
  out.gap = out.core - Long(a.radius) - Long(b.radius);
  return out;
}

// Distance of a point from the hull of an outline's vertices; negative inside.
inline Long core_distance(const OwnedOutline& of, const carom::Vec<2>& point) {
  return reference_gap({of.vertices, 0.0}, {{point}, 0.0}).core;
}

// A disc or point, a capsule or segment, or a polygon with 3 to 8 vertices, of a size about 1 around the
// origin.
inline OwnedOutline random_outline(Random& random) {
  OwnedOutline out;
  out.radius = random.below(2) == 0 ? 0.0 : random.uniform(0.05, 0.5);
  const unsigned kind = random.below(8);
  if (kind == 0) {
    out.vertices = {random.vec<2>(0.3)};
  } else if (kind == 1) {
    out.vertices = {random.vec<2>(1.0), carom::Vec<2>{random.uniform(1.1, 2.0), random.uniform(-1.0, 1.0)}};
  } else if (kind == 2) {
    const double x = random.uniform(0.3, 1.5), y = random.uniform(0.3, 1.5);
    out.vertices = {{-x, -y}, {x, -y}, {x, y}, {-x, y}};
  } else {
    const unsigned n = kind == 3 ? 3 : kind == 7 ? 9 + random.below(6) : 3 + random.below(6);
    const double x = random.uniform(0.4, 1.2), y = random.uniform(0.4, 1.2);
    const double turn = 2.0 * std::numbers::pi / n;
    for (unsigned i = 0; i < n; ++i) {  // on an ellipse, in unequal steps
      const double angle = (i + random.uniform(-0.35, 0.35)) * turn;
      out.vertices.push_back({x * std::cos(angle), y * std::sin(angle)});
    }
  }
  const double angle = random.uniform(-3.0, 3.0);
  return out.moved(angle, random.vec<2>(0.2));
}

// Two outlines: a far or near or overlapping one, or (every fourth) in touch but for rounding.
inline std::pair<OwnedOutline, OwnedOutline> random_pair(Random& random) {
  OwnedOutline a = random_outline(random), b = random_outline(random).moved(0.0, random.vec<2>(2.0));
  if (random.below(4) == 0) {
    const ReferenceGap at = reference_gap(a, b);
    b = b.moved(0.0, {double(at.gap * at.normal.x), double(at.gap * at.normal.y)});
  }
  return {std::move(a), std::move(b)};
}

}  // namespace carom_test
