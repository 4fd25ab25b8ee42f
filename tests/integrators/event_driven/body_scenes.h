#pragma once

// Bodies that touch each other, and what is known of them without the library's own contact search.

#include <carom/carom.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace body_scenes {

using namespace carom;
using namespace carom::planar;

inline constexpr double g = 9.81;

inline BodyId add_disc(System& system, double mass, double radius, const Vec<2>& place,
                       const Vec<2>& velocity = Vec<2>::Zero(), double spin = 0.0) {
  const BodyId body = system.add(
      RigidBody{.mass = disc(mass, radius), .position = place, .velocity = velocity, .spin = spin});
  system.add(Disc{.body = body, .radius = radius});
  return body;
}

inline std::vector<Vec<2>> corners_of(double width, double height) {
  const double x = 0.5 * width, y = 0.5 * height;
  return {{-x, -y}, {x, -y}, {x, y}, {-x, y}};
}

inline BodyId add_box(System& system, double mass, double width, double height, const Vec<2>& place,
                      double angle = 0.0, const Vec<2>& velocity = Vec<2>::Zero(), double spin = 0.0) {
  const BodyId body = system.add(RigidBody{.mass = box(mass, width, height),
                                           .position = place,
                                           .angle = angle,
                                           .velocity = velocity,
                                           .spin = spin});
  system.add(Polygon{.body = body, .vertices = corners_of(width, height)});
  return body;
}

/// Four half-planes around the origin.
inline void add_walls(System& system, double distance, const Surface& surface) {
  for (const Vec<2>& normal : {Vec<2>(1.0, 0.0), Vec<2>(-1.0, 0.0), Vec<2>(0.0, 1.0), Vec<2>(0.0, -1.0)}) {
    system.add(HalfPlane{.point = -distance * normal, .normal = normal}, surface);
  }
}

/// Linear momentum, and angular momentum about the origin, of all rigid bodies.
inline std::array<double, 3> momentum(const Simulation& simulation, const std::vector<double>& masses,
                                      const std::vector<double>& inertias) {
  std::array<double, 3> sum{};
  std::size_t i = 0;
  for (const BodyId body : simulation.system().bodies()) {
    const Vec<2> x = simulation.state().position(body), v = simulation.state().velocity(body);
    sum[0] += masses[i] * v[0];
    sum[1] += masses[i] * v[1];
    sum[2] += masses[i] * (x[0] * v[1] - x[1] * v[0]) + inertias[i] * simulation.state().spin(body);
    ++i;
  }
  return sum;
}

/// Distance of two convex polygons, negative where they overlap: by separating axes (a lower bound of a
/// positive distance) [m].
inline double separation(const std::vector<Vec<2>>& a, const std::vector<Vec<2>>& b) {
  const auto along_edges = [](const std::vector<Vec<2>>& of, const std::vector<Vec<2>>& other) {
    double widest = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < of.size(); ++i) {
      const Vec<2> edge = of[(i + 1) % of.size()] - of[i], normal = Vec<2>(edge[1], -edge[0]).normalized();
      double least = std::numeric_limits<double>::infinity();
      for (const Vec<2>& point : other) least = std::min(least, normal.dot(point - of[i]));
      widest = std::max(widest, least);
    }
    return widest;
  };
  return std::max(along_edges(a, b), along_edges(b, a));
}

/// Corners of a box where its body is.
inline std::vector<Vec<2>> placed(const State& state, BodyId body, const std::vector<Vec<2>>& corners) {
  const double c = std::cos(state.angle(body)), s = std::sin(state.angle(body));
  std::vector<Vec<2>> points;
  for (const Vec<2>& p : corners) {
    points.push_back(state.position(body) + Vec<2>(c * p[0] - s * p[1], s * p[0] + c * p[1]));
  }
  return points;
}

}  // namespace body_scenes
