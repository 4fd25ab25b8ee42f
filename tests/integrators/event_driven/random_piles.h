#pragma once

// Random bodies that fall onto a floor between walls, or into a V, and pile up.

#include "tests/integrators/event_driven/body_scenes.h"
#include "tests/random.h"

#include <carom/carom.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace random_piles {

using namespace body_scenes;
using carom_test::Random;

/// Of one pile.
struct PileOptions {
  int bodies = 6;
  bool discs_only = false;
  double friction = 0.5;
  double restitution = 0.0;
  std::uint64_t seed = 1;
  bool sharp = false;  ///< polygons without rounding
};

/// A pile, with what is needed to look at its gaps without the library's own contact search. All outlines are
/// rounded: discs are those of one vertex, capsules of two.
class RandomPile {
public:
  explicit RandomPile(const PileOptions& options) : random_(options.seed) {
    system_.add(Gravity{{0.0, -g}});
    system_.set_default_law({.friction = options.friction, .normal_restitution = options.restitution});
    const double half = std::sqrt(0.5);
    walls_ = options.seed % 2 == 1
                 ? std::vector<Wall>{{{half, half}, 0.0}, {{-half, half}, 0.0}}
                 : std::vector<Wall>{{{0.0, 1.0}, 0.0}, {{1.0, 0.0}, -0.7}, {{-1.0, 0.0}, -0.7}};
    for (const Wall& wall : walls_) {
      system_.add(HalfPlane{.point = wall.distance * wall.normal, .normal = wall.normal});
    }
    for (int i = 0; i < options.bodies; ++i)
      add_body(i, options.discs_only ? 0 : random_.below(4), options.sharp ? 0.0 : 0.1);
  }

  [[nodiscard]] const System& system() const { return system_; }

  /// The deepest overlap of bodies with walls and each other; negative where all are apart [m].
  [[nodiscard]] double deepest(const State& state) const {
    double deepest = -1.0;
    std::vector<std::vector<Vec<2>>> at;
    for (const Shape& shape : shapes_) {
      at.push_back(placed(state, shape.body, shape.vertices));
      for (const Wall& wall : walls_) {
        for (const Vec<2>& point : at.back()) {
          deepest = std::max(deepest, shape.rounding + wall.distance - wall.normal.dot(point));
        }
      }
    }
    for (std::size_t i = 0; i < at.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        deepest = std::max(deepest, shapes_[i].rounding + shapes_[j].rounding - distance(at[i], at[j]));
      }
    }
    return deepest;
  }

private:
  struct Wall {
    Vec<2> normal;
    double distance;  // of the line from the origin, along the normal
  };
  struct Shape {
    BodyId body;
    std::vector<Vec<2>> vertices;
    double rounding;
  };

  static double point_to_segment(const Vec<2>& point, const Vec<2>& a, const Vec<2>& b) {
    const Vec<2> along = b - a;
    const double length = along.squaredNorm();
    const double part = length > 0.0 ? std::clamp((point - a).dot(along) / length, 0.0, 1.0) : 0.0;
    return (point - a - part * along).norm();
  }

  // Distance of two convex outlines; of two polygons that overlap minus the depth.
  static double distance(const std::vector<Vec<2>>& a, const std::vector<Vec<2>>& b) {
    const double apart =
        a.size() > 2 || b.size() > 2 ? separation(a.size() > 2 ? a : b, a.size() > 2 ? b : a) : 0.0;
    if (apart < 0.0 && a.size() > 2 && b.size() > 2) return apart;
    double least = 1e9;
    for (const auto& [points, outline] : {std::pair(&a, &b), std::pair(&b, &a)}) {
      for (const Vec<2>& point : *points) {
        for (std::size_t i = 0; i < outline->size(); ++i) {
          const Vec<2>& next = (*outline)[(i + 1) % outline->size()];
          least = std::min(least, point_to_segment(point, (*outline)[i], next));
        }
      }
    }
    return least;
  }

  void add_body(int i, unsigned kind, double rounding) {
    const Vec<2> place(0.4 * (i % 3 - 1) + random_.uniform(-0.03, 0.03), 1.0 + 0.4 * (i / 3));
    const double angle = random_.uniform(-3.0, 3.0), spin = random_.uniform(-2.0, 2.0);
    const double size = random_.uniform(0.07, 0.15), mass = 100.0 * size * size;
    Shape shape{{}, {Vec<2>::Zero()}, 0.0};
    MassProperties<2> properties = disc(mass, size);
    if (kind == 0) shape.rounding = size;
    if (kind == 1) {
      const double height = size * random_.uniform(0.5, 1.9);
      properties = box(mass, 2.0 * size, height);
      shape.vertices = corners_of(2.0 * size, height);
    }
    if (kind == 2) {
      properties = box(mass, 2.0 * size, size);
      shape.vertices = {{-0.7 * size, 0.0}, {0.7 * size, 0.0}};
      shape.rounding = 0.4 * size;
    }
    if (kind == 3) {
      constexpr double turn = 6.283185307179586;
      const unsigned corners = 3 + random_.below(3);
      shape.vertices.clear();
      for (unsigned k = 0; k < corners; ++k) {
        const double at = turn * (k + random_.uniform(0.0, 0.5)) / corners;
        shape.vertices.emplace_back(size * std::cos(at), size * std::sin(at));
      }
      properties = polygon(mass, shape.vertices);
      for (Vec<2>& vertex : shape.vertices) vertex -= properties.centre;
      properties = centred(properties);
    }
    shape.body = system_.add(RigidBody{.mass = properties, .position = place, .angle = angle, .spin = spin});
    if (kind == 0) system_.add(Disc{.body = shape.body, .radius = size});
    if (kind == 2) {
      system_.add(Segment{
          .body = shape.body, .from = shape.vertices[0], .to = shape.vertices[1], .radius = shape.rounding});
    }
    if (kind == 1 || kind == 3) {
      shape.rounding = rounding * size;
      system_.add(Polygon{.body = shape.body, .vertices = shape.vertices, .radius = shape.rounding});
    }
    shapes_.push_back(shape);
  }

  Random random_;
  System system_;
  std::vector<Wall> walls_;
  std::vector<Shape> shapes_;
};

}  // namespace random_piles
