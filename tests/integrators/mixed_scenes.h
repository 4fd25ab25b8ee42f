#pragma once

// Random scenes of bodies of all shapes over ground of all kinds. A number makes a scene, the same each time.

#include "tests/random.h"

#include <carom/carom.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace carom_test {

using namespace carom;
using namespace carom::planar;

enum class GroundForm { half_planes, walls, block, pegs, terrain, box_inside, circle_inside };
inline constexpr unsigned ground_forms = 7;

/// A random scene. Bodies begin apart from each other and from the ground.
class MixedScene {
public:
  explicit MixedScene(std::uint64_t number, unsigned most_bodies = 6) : random_(number) {
    system_.add(Gravity{{random_.uniform(-1.0, 1.0), -9.81}});
    system_.set_default_law(surface());
    form_ = static_cast<GroundForm>(random_.below(ground_forms));
    moves_ = random_.below(4) == 0;
    add_ground();
    const unsigned count = 1 + random_.below(most_bodies);
    for (unsigned i = 0; i < count; ++i) {
      // Cells of 0.45 m, bodies of at most 0.2 m around their middle.
      const Vec<2> cell(0.45 * (static_cast<double>(i % 3) - 1.0), 1.25 + 0.45 * (i / 3));
      add_body(cell + random_.vec<2>(0.02));
    }
  }

  const System& system() const { return system_; }
  GroundForm form() const { return form_; }
  /// Whether the ground moves.
  bool moves() const { return moves_; }
  /// The largest distance of a point of any body from its centre of mass [m].
  double largest_radius() const { return largest_radius_; }
  /// Radius of what is hollow, along which contact turns [m].
  static constexpr double hollow = 1.5;
  /// Least thickness of what can be passed through: of walls [m].
  static constexpr double thickness = 0.1;

private:
  Surface surface() {
    const double e = random_.below(4) == 0 ? 0.0 : random_.uniform(0.0, 0.8);
    const double friction = random_.below(6) == 0 ? 0.0 : random_.uniform(0.0, 0.9);
    return {.friction = friction, .normal_restitution = e, .tangential_restitution = random_.below(2) * e};
  }

  template <class Shape>
  void add(Shape shape) {
    if (moves_ && !moved_) {
      moved_ = true;
      const double rate = random_.uniform(2.0, 12.0), size = random_.uniform(0.0, 0.05);
      shape.motion.displacement = [=](double t) { return Vec<2>(0.0, size * std::sin(rate * t)); };
      shape.motion.velocity = [=](double t) { return Vec<2>(0.0, size * rate * std::cos(rate * t)); };
      shape.motion.acceleration = [=](double t) {
        return Vec<2>(0.0, -size * rate * rate * std::sin(rate * t));
      };
    }
    system_.add(std::move(shape), surface());
  }

  void add_ground() {
    const double left = random_.uniform(0.3, 0.9), right = random_.uniform(0.3, 0.9);
    const Vec<2> far_left(-2.0 * std::cos(left), 2.0 * std::sin(left)),
        far_right(2.0 * std::cos(right), 2.0 * std::sin(right));
    switch (form_) {
      case GroundForm::half_planes:
        add(HalfPlane{.normal = incline(right)});
        add(HalfPlane{.normal = incline(-left)});
        break;
      case GroundForm::walls:
        add(Wall{.from = Vec<2>(-0.05, 0.0), .to = far_left, .radius = 0.5 * thickness});
        add(Wall{.from = Vec<2>(0.05, 0.0), .to = far_right, .radius = 0.5 * thickness});
        break;
      case GroundForm::block:
        add(planar::Block{.vertices = {{-1.5, -0.5}, {1.5, -0.5}, {0.7, 0.4}, {-0.6, 0.5}},
                          .radius = random_.below(2) * 0.05});
        break;
      case GroundForm::pegs:
        for (int i = -3; i <= 3; ++i) {
          add(Peg{.centre = {0.3 * i, 0.2 * (i & 1)}, .radius = random_.uniform(0.06, 0.1)});
        }
        break;
      case GroundForm::terrain: {
        // Nowhere thinner than the depth; steep at both ends, since below it has no surface.
        std::vector<Vec<2>> line{{-2.1, 2.5}};
        for (int i = -5; i <= 5; ++i) line.emplace_back(0.4 * i, random_.uniform(0.0, 0.25));
        line.emplace_back(2.1, 2.5);
        add(Terrain{.vertices = line, .depth = 0.3});
        break;
      }
      case GroundForm::box_inside:
        add(BoxInside{.lower = {-0.9, 0.0}, .upper = {0.9, 3.0}});
        break;
      case GroundForm::circle_inside:
        add(CircleInside{.centre = {0.0, 1.5}, .radius = hollow});
        break;
    }
    system_.add(HalfPlane{.point = {0.0, -1.5}, .normal = {0.0, 1.0}}, surface());
  }

  BodyId add_described(const MassProperties<2>& mass, const Vec<2>& place) {
    return system_.add(RigidBody{.mass = mass,
                                 .position = place,
                                 .angle = random_.below(4) == 0 ? 0.0 : random_.uniform(-3.0, 3.0),
                                 .velocity = random_.vec<2>(2.0),
                                 .spin = random_.uniform(-8.0, 8.0)});
  }

  std::vector<Vec<2>> corners(double size) {
    std::vector<Vec<2>> vertices;
    const unsigned count = 3 + random_.below(4);
    for (unsigned i = 0; i < count; ++i) {
      const double at = 6.283185307179586 * (i + random_.uniform(0.0, 0.5)) / count;
      vertices.emplace_back(size * std::cos(at), size * std::sin(at));
    }
    return vertices;
  }

  void add_body(const Vec<2>& place) {
    const double mass = std::pow(10.0, random_.uniform(-1.0, 1.0)), size = random_.uniform(0.07, 0.18);
    largest_radius_ = std::max(largest_radius_, 1.7 * size);  // a corner, from the centre of mass
    switch (random_.below(5)) {
      case 0: {
        const BodyId body = add_described(disc(mass, size), place);
        system_.add(Disc{.body = body, .radius = size});
        break;
      }
      case 1: {
        const BodyId body = add_described(rod(mass, 2.0 * size), place);
        system_.add(
            Segment{.body = body, .from = {-0.7 * size, 0.0}, .to = {0.7 * size, 0.0}, .radius = 0.3 * size});
        break;
      }
      case 2:
      case 3: {
        const double radius = random_.below(2) * 0.2 * size;
        std::vector<Vec<2>> vertices = corners(size - radius);
        const MassProperties<2> properties = polygon(mass, vertices);
        for (Vec<2>& vertex : vertices) vertex -= properties.centre;
        const BodyId body = add_described(centred(properties), place);
        system_.add(Polygon{.body = body, .vertices = vertices, .radius = radius});
        break;
      }
      default: {
        const BodyId body = add_described(box(mass, 1.6 * size, 1.2 * size), place);
        system_.add(Segment{.body = body,
                            .from = {-0.7 * size, -0.4 * size},
                            .to = {0.7 * size, -0.4 * size},
                            .radius = 0.15 * size});
        system_.add(Disc{.body = body, .radius = 0.4 * size, .centre = {0.3 * size, 0.3 * size}});
        break;
      }
    }
  }

  Random random_;
  System system_;
  GroundForm form_{};
  bool moves_ = false, moved_ = false;
  double largest_radius_ = 0.0;
};

/// Follows a run in time stepping, and derives how deep it may sink in. A contact is found at the end of the
/// step in which its gap closes, at most h V deep, with V the fastest approach; the step that it strikes in
/// takes it (1 - e)/2 h V further, since positions advance with the mean of the velocities before and after.
/// From then on the law keeps gamma^+ >= -e gamma^-, whose mean sinks no more, but for contact that turns or
/// runs along what is hollow: it loses h d/2 of velocity a step, d up to w^2 R + v^2/r (docs/method.md,
/// section 6), h/2 times the time integral of d in all. Both bodies of a contact may turn.
class DepthWatch {
public:
  DepthWatch(Simulation& simulation, const MixedScene& scene) : radius_(scene.largest_radius()) {
    simulation.observe([this](const Simulation& now) { look(now); });
  }
  DepthWatch(const DepthWatch&) = delete;
  DepthWatch& operator=(const DepthWatch&) = delete;
  /// The deepest that bodies may sink [m].
  double bound(double step) const { return step * (1.5 * fastest_ + turning_); }

private:
  void look(const Simulation& now) {
    double largest = 0.0;
    for (const BodyId body : now.system().bodies()) {
      const double spin = now.state().spin(body), speed = now.state().velocity(body).norm();
      largest = std::max(largest, spin * spin * radius_ + speed * speed / MixedScene::hollow);
    }
    turning_ += now.report().step * largest;  // of two bodies, half of each
    for (const ContactRecord& contact : now.report().contacts) {
      fastest_ = std::max(fastest_, -contact.velocity_before[0]);
    }
  }

  double radius_, fastest_ = 0.0, turning_ = 0.0;
};

}  // namespace carom_test
