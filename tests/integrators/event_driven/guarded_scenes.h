#pragma once

// Random scenes in which lasting contacts join components with joints to components with one-sided springs:
// discs and boxes that fall onto each other or fly into each other without restitution.

#include "tests/random.h"

#include <carom/carom.h>

#include <cstdint>
#include <vector>

namespace guarded_scenes {

using namespace carom;
using namespace carom::planar;
using carom_test::Random;

/// A pad of a user that pushes a body up below a height. Its guard has no derivatives.
struct Pad {
  static constexpr Role role = Role::force;
  static constexpr int dimension = 2;
  static constexpr std::string_view label = "pad";
  static constexpr bool depends_on_time = false;
  static constexpr int guard_size = 1;
  BodyId body;
  double height = 0.0, stiffness = 0.0;

  [[nodiscard]] std::vector<BodyId> bodies() const { return {body}; }
  [[nodiscard]] double depth(const ElementView<2>& at) const { return height - at.position(body)[1]; }
  void loads(const ElementView<2>& at, ElementLoads<2>& out) const {
    if (depth(at) > 0.0) out.conservative(body, Vec<2>(0.0, stiffness * depth(at)));
  }
  [[nodiscard]] double potential(const ElementView<2>& at) const {
    return depth(at) > 0.0 ? 0.5 * stiffness * depth(at) * depth(at) : 0.0;
  }
  void guards(const ElementView<2>& at, double* out) const { *out = depth(at); }
};

struct Scene {
  System system;
  std::vector<BodyId> bodies;
};

/// Grows one scene.
class Maker {
public:
  explicit Maker(std::uint64_t seed) : random_(seed) {}

  Scene make() {
    const bool falls = random_.below(2) == 0;
    const double friction = random_.below(2) == 0 ? 0.0 : random_.uniform(0.1, 0.6);
    system_.set_default_law({.friction = friction, .normal_restitution = 0.0});
    if (falls) {
      system_.add(Gravity{{0.0, -9.81}});
      system_.add(HalfPlane{.normal = {0.0, 1.0}});
    }
    const unsigned bodies = 3 + random_.below(4);
    for (unsigned i = 0; i < bodies; ++i) add_body(i);
    add_joints();
    const unsigned springs = 1 + random_.below(3);
    for (unsigned i = 0; i < springs; ++i) add_spring();
    if (random_.below(5) == 0) {
      const unsigned i = any_body();
      system_.add(Pad{bodies_[i], places_[i][1] - random_.uniform(-0.02, 0.05), 200.0});
    }
    return {std::move(system_), std::move(bodies_)};
  }

private:
  static constexpr double cell = 0.4;  // of the grid that the bodies start on [m]

  [[nodiscard]] unsigned any_body() { return random_.below(static_cast<unsigned>(bodies_.size())); }

  /// Three in a row. The upper row comes down, the lower one drifts.
  void add_body(unsigned i) {
    const bool is_above = i >= 3;
    const Vec<2> place = Vec<2>(cell * (i % 3), 0.2 + cell * (i / 3)) + random_.vec<2>(0.02);
    const Vec<2> velocity = random_.vec<2>(0.3) - Vec<2>(0.0, is_above ? 0.8 : 0.0);
    const bool is_disc = random_.below(2) == 0;
    const BodyId body = system_.add(RigidBody{.mass = is_disc ? disc(1.0, 0.15) : box(1.0, 0.24, 0.18),
                                              .position = place,
                                              .velocity = velocity,
                                              .spin = random_.uniform(-0.5, 0.5)});
    if (is_disc) {
      system_.add(Disc{.body = body, .radius = 0.15});
    } else {
      system_.add(
          Polygon{.body = body, .vertices = {{-0.12, -0.09}, {0.12, -0.09}, {0.12, 0.09}, {-0.12, 0.09}}});
    }
    bodies_.push_back(body);
    places_.push_back(place);
  }

  /// Joins neighbours of a row, at least one pair.
  void add_joints() {
    const unsigned first = random_.below(2);
    for (unsigned i = 0; i + 1 < bodies_.size(); ++i) {
      if (i % 3 == 2 || (i != first && random_.below(3) != 0)) continue;
      const BodyId a = bodies_[i], b = bodies_[i + 1];
      const Vec<2> half = 0.5 * (places_[i + 1] - places_[i]);
      switch (random_.below(4)) {
        case 0:
          system_.add(Revolute{.from = {a, half}, .to = {b, -half}});
          break;
        case 1:
          system_.add(Rod{.from = a, .to = b});
          break;
        case 2:
          system_.add(Weld{.from = {a, half}, .to = {b, -half}});
          break;
        default:
          system_.add(Prismatic{.from = a, .to = b, .axis = half});
      }
    }
  }

  /// Adds a bumper or a cable, from ground or between two bodies, that is entered or left soon.
  void add_spring() {
    const unsigned to = any_body();
    unsigned from = any_body();
    End<2> start = bodies_[from];
    Vec<2> place = places_[from];
    if (from == to || random_.below(3) != 0) {
      place = places_[to] + Vec<2>(random_.uniform(-0.6, 0.6), random_.uniform(-0.6, 0.6));
      start = {ground, place};
    }
    const double length = (places_[to] - place).norm(), stiffness = random_.uniform(20.0, 200.0);
    const double damping = random_.below(2) == 0 ? 0.0 : random_.uniform(0.0, 2.0);
    if (random_.below(2) == 0) {
      system_.add(Bumper{start, bodies_[to], stiffness, damping, length * random_.uniform(0.8, 1.05)});
    } else {
      system_.add(Cable{start, bodies_[to], stiffness, damping, length * random_.uniform(0.95, 1.2)});
    }
  }

  Random random_;
  System system_;
  std::vector<BodyId> bodies_;
  std::vector<Vec<2>> places_;
};

inline Scene random_scene(std::uint64_t seed) { return Maker(seed).make(); }

}  // namespace guarded_scenes
