#pragma once

/// \file
/// Bars, discs and bricks in a drum that turns and lifts them. Shared by the example and the tests.

#include <carom/carom.h>

#include "examples/scenes/discs.h"

#include <cmath>
#include <numbers>
#include <vector>

namespace scenes {

/// Parameters.
struct Drum {
  double radius = 1.0;  ///< of the drum [m]
  double spin = 1.5;    ///< counter-clockwise [rad/s]
  double size = 0.08;   ///< half the length of a bar [m]
  int lifters = 2;      ///< walls that turn with the drum
  double friction = 0.5;
};

/// A body, and the set that it touches with.
struct DrumBody {
  carom::BodyId body;
  std::vector<carom::Vec<2>> vertices;  ///< from the centre of mass [m]
  double radius = 0.0;                  ///< [m]
};

/// Every third body is a bar, a disc, a brick. \returns its outline
inline DrumBody drum_body(carom::System& system, int i, double size, const carom::Vec<2>& place) {
  using namespace carom::planar;
  const double angle = 1.5 * scattered(2 * i + 1);
  DrumBody out;
  if (i % 3 == 0) {
    out.vertices = {{-size, 0.0}, {size, 0.0}};
    out.radius = 0.25 * size;
    out.body =
        system.add(RigidBody{.mass = box(2.0, 2.5 * size, 0.5 * size), .position = place, .angle = angle});
    system.add(
        Segment{.body = out.body, .from = out.vertices[0], .to = out.vertices[1], .radius = out.radius});
  } else if (i % 3 == 1) {
    out.vertices = {{0.0, 0.0}};
    out.radius = 0.5 * size;
    out.body = system.add(RigidBody{.mass = disc(1.0, out.radius), .position = place, .angle = angle});
    system.add(Disc{.body = out.body, .radius = out.radius});
  } else {
    const double a = 0.7 * size, b = 0.4 * size;
    out.vertices = {{-a, -b}, {a, -b}, {a, b}, {-a, b}};
    out.body = system.add(RigidBody{.mass = box(2.0, 2.0 * a, 2.0 * b), .position = place, .angle = angle});
    system.add(Polygon{.body = out.body, .vertices = out.vertices});
  }
  return out;
}

/// The whole arrangement; returns the bodies, row by row from below.
inline std::vector<DrumBody> add_drum(carom::System& system, const Drum& scene) {
  using namespace carom::planar;
  system.add(Gravity{{0.0, -9.81}});
  system.set_default_law({.friction = scene.friction, .normal_restitution = 0.0});
  const CircleInside shell = drum({0.0, 0.0}, scene.radius, scene.spin);
  system.add(shell, "drum");
  for (int i = 0; i < scene.lifters; ++i) {
    const double at = 2.0 * std::numbers::pi * i / scene.lifters;
    const carom::Vec<2> outwards(std::cos(at), std::sin(at));
    system.add(Wall{.from = (scene.radius - scene.size) * outwards,
                    .to = scene.radius * outwards,
                    .radius = 0.2 * scene.size,
                    .motion = shell.motion});
  }
  // As many as find a place beside each other, clear of the lifters.
  const double pitch = 2.6 * scene.size, farthest = scene.radius - 2.5 * scene.size;
  const int rows = static_cast<int>(farthest / pitch);
  std::vector<DrumBody> all;
  for (int row = -rows; row <= rows; ++row) {
    for (int column = -rows; column <= rows; ++column) {
      const int i = static_cast<int>(all.size());
      const double shift = 0.04 * scene.size * scattered(3 * i);
      const carom::Vec<2> place(column * pitch + shift, row * pitch);
      if (place.norm() < farthest) all.push_back(drum_body(system, i, scene.size, place));
    }
  }
  return all;
}

}  // namespace scenes
