#pragma once

// Random particles and bars on cables and bumpers, in which these are entered and left within long steps:
// fast, stiff, spinning, grazing, from a start on the switching surface.

#include "tests/random.h"

#include <carom/carom.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

namespace one_sided_scenes {

using namespace carom;
using namespace carom::planar;

/// A cable or bumper: what its length is judged by.
struct Line {
  ElementId element;
  End<2> from, to;
  double free_length = 0.0;

  /// Its length less the free one.
  [[nodiscard]] double excess(const State& state) const {
    return (place(state, to) - place(state, from)).norm() - free_length;
  }
  static Vec<2> place(const State& state, const End<2>& end) {
    if (end.body == ground) return end.point;
    const Vec<2> centre = state.position(end.body);
    if (end.point.isZero(0.0)) return centre;
    const double angle = state.angle(end.body);
    return centre + Vec<2>(std::cos(angle) * end.point[0] - std::sin(angle) * end.point[1],
                           std::sin(angle) * end.point[0] + std::cos(angle) * end.point[1]);
  }
};

struct Scene {
  System system;
  std::vector<Line> lines;
};

enum class Sort : std::uint8_t { plain, fast, stiff, spinning, grazing, on_surface };
inline constexpr unsigned sorts = 6;

/// Adds a cable or a bumper; a free length of 0 means the present distance, exactly.
inline void add_line(Scene& scene, bool pulls, const End<2>& from, const End<2>& to, double stiffness,
                     double damping, double free_length) {
  if (free_length == 0.0) {
    const State start = Simulation(scene.system, TimeStepping{.step = 1e-3}).state();
    free_length = (Line::place(start, to) - Line::place(start, from)).norm();
  }
  const ElementId element = pulls ? scene.system.add(Cable{from, to, stiffness, damping, free_length})
                                  : scene.system.add(Bumper{from, to, stiffness, damping, free_length});
  scene.lines.push_back({element, from, to, free_length});
}

/// A particle, or a bar, that flies straight past a point of the ground at a distance a little less (bumper)
/// or a little more (cable) than the free length.
inline Scene grazing_scene(carom_test::Random& random) {
  Scene scene;
  const double depth = std::pow(10.0, random.uniform(-6.0, -1.0));
  const double speed = random.uniform(0.5, 5.0), distance = random.uniform(0.2, 1.0);
  const double ahead = random.uniform(0.2, 0.8) * speed;
  const double turn = random.uniform(0.0, 2.0 * std::numbers::pi);
  const Vec<2> along{std::cos(turn), std::sin(turn)}, across{-along[1], along[0]};
  const double stiffness = std::pow(10.0, random.uniform(1.0, 4.0));
  if (random.below(2) == 0) {
    const BodyId dot = scene.system.add(
        Particle{.mass = 1.0, .position = distance * across - ahead * along, .velocity = speed * along});
    add_line(scene, false, {ground, Vec<2>(0.0, 0.0)}, dot, stiffness, 0.0, distance + depth);
    return scene;
  }
  // A cable is taut where an end of a turning bar is farthest from a point beside it.
  const double half = random.uniform(0.2, 0.6), spin = random.uniform(1.0, 20.0);
  const BodyId bar = scene.system.add(RigidBody{.mass = rod(1.0, 2.0 * half), .angle = turn, .spin = spin});
  add_line(scene, true, {ground, distance * along}, {bar, {half, 0.0}}, stiffness, 0.0,
           distance + half - std::min(depth, 0.1 * half));
  return scene;
}

/// One to four bodies and up to twice as many cables and bumpers.
inline Scene random_scene(std::uint64_t seed) {
  carom_test::Random random(seed);
  const Sort sort = static_cast<Sort>(seed % sorts);
  if (sort == Sort::grazing) return grazing_scene(random);
  Scene scene;
  if (random.below(3) != 0) scene.system.add(Gravity{{0.0, -9.81}});
  const double speed = sort == Sort::fast ? 15.0 : random.below(4) == 0 ? 0.0 : 2.0;
  const double spin = sort == Sort::spinning ? 60.0 : 5.0;
  std::vector<End<2>> ends;
  const unsigned bodies = 1 + random.below(4);
  for (unsigned i = 0; i < bodies; ++i) {
    const double mass = random.uniform(0.5, 2.0);
    const Vec<2> position = random.vec<2>(1.0), velocity = random.vec<2>(speed);
    if (random.below(2) == 0 && sort != Sort::spinning) {
      ends.emplace_back(scene.system.add(Particle{mass, position, velocity}));
    } else {
      const double half = random.uniform(0.1, 0.5);
      const BodyId bar = scene.system.add(RigidBody{.mass = rod(mass, 2.0 * half),
                                                    .position = position,
                                                    .angle = random.uniform(-3.0, 3.0),
                                                    .velocity = velocity,
                                                    .spin = random.uniform(-spin, spin)});
      ends.emplace_back(bar, Vec<2>(half, 0.0));
      ends.emplace_back(bar, Vec<2>(-half, 0.0));
    }
  }
  const unsigned lines = 1 + random.below(2 * bodies);
  for (unsigned i = 0; i < lines; ++i) {
    const End<2> to = ends[random.below(static_cast<unsigned>(ends.size()))];
    End<2> from = ends[random.below(static_cast<unsigned>(ends.size()))];
    if (from.body == to.body) from = {ground, random.vec<2>(1.5)};
    const double stiffness =
        std::pow(10.0, sort == Sort::stiff ? random.uniform(3.0, 5.0) : random.uniform(1.0, 3.0));
    const double damping =
        random.below(2) == 0 ? 0.0 : 0.02 * std::sqrt(stiffness) * random.uniform(0.0, 1.0);
    const bool pulls = random.below(2) == 0;
    const double free_length = sort == Sort::on_surface ? 0.0
                               : pulls                  ? random.uniform(0.5, 2.5)
                                                        : random.uniform(0.05, 0.6);
    add_line(scene, pulls, from, to, stiffness, damping, free_length);
  }
  return scene;
}

}  // namespace one_sided_scenes
