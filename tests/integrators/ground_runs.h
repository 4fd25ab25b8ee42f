#pragma once

// Scenes with one shape on ground of every kind, at rest or moved, and one body on it: a disc, a capsule, a
// brick or a particle.

#include <carom/carom.h>

#include <array>
#include <cmath>
#include <string>

namespace ground_runs {

using namespace carom;
using namespace carom::planar;

constexpr double g = 9.81;

enum class Ground { half_plane, terrain, box_inside, circle_inside, wall, block, peg };
enum class Form { particle, disc, capsule, brick };

inline constexpr std::array grounds{Ground::terrain, Ground::box_inside, Ground::circle_inside,
                                    Ground::wall,    Ground::block,      Ground::peg};
inline constexpr std::array forms{Form::particle, Form::disc, Form::capsule, Form::brick};

/// How the ground moves: up and down, and turning about a point at its side.
struct Swing {
  double reach = 0.0;  ///< of the displacement, upwards [m]
  double turn = 0.0;   ///< largest angle [rad]
  double rate = 20.0;  ///< angular frequency [rad/s]

  [[nodiscard]] PrescribedMotion motion() const {
    if (reach == 0.0 && turn == 0.0) return {};
    const Swing s = *this;
    PrescribedMotion motion;
    motion.displacement = [s](double t) { return Vec<2>(0.0, s.reach * std::sin(s.rate * t)); };
    motion.velocity = [s](double t) { return Vec<2>(0.0, s.reach * s.rate * std::cos(s.rate * t)); };
    motion.acceleration = [s](double t) {
      return Vec<2>(0.0, -s.reach * s.rate * s.rate * std::sin(s.rate * t));
    };
    if (turn == 0.0) return motion;
    motion.angle = [s](double t) { return s.turn * std::sin(s.rate * t); };
    motion.spin = [s](double t) { return s.turn * s.rate * std::cos(s.rate * t); };
    motion.angular_acceleration = [s](double t) { return -s.turn * s.rate * s.rate * std::sin(s.rate * t); };
    return motion;
  }
};

/// Adds ground whose surface has its lowest, or highest, point at the origin, or a flat top there. A slight
/// slope of flat shapes makes bodies go on sliding.
inline void add_ground(System& system, Ground ground, const Surface& law, const Swing& swing = {}) {
  const PrescribedMotion motion = swing.motion();
  const Vec<2> pivot(-0.3, 0.0);
  switch (ground) {
    case Ground::half_plane:
      system.add(HalfPlane{.normal = {0.0, 1.0}, .motion = motion}, law, "ground");
      break;
    case Ground::terrain:
      system.add(Terrain{.vertices = {{-4, 0.9}, {-0.9, 0.1}, {0.0, 0.0}, {0.4, 0.0}, {4, 0.8}},
                         .depth = 1.0,
                         .pivot = pivot,
                         .motion = motion},
                 law, "ground");
      break;
    case Ground::box_inside:
      system.add(BoxInside{.lower = {-1.0, 0.0}, .upper = {1.0, 4.0}, .pivot = pivot, .motion = motion}, law,
                 "ground");
      break;
    case Ground::circle_inside:
      system.add(CircleInside{.centre = {0.0, 2.0}, .radius = 2.0, .pivot = pivot, .motion = motion}, law,
                 "ground");
      break;
    case Ground::wall:
      system.add(
          Wall{.from = {-3.0, -0.1}, .to = {3.0, -0.1}, .radius = 0.1, .pivot = pivot, .motion = motion}, law,
          "ground");
      break;
    case Ground::block:
      system.add(planar::Block{.vertices = {{-2.0, 0.0}, {2.0, 0.0}, {1.5, -1.0}, {-1.5, -1.0}},
                               .pivot = pivot,
                               .motion = motion},
                 law, "ground");
      break;
    case Ground::peg:
      system.add(Peg{.centre = {0.0, -3.0}, .radius = 3.0, .pivot = pivot, .motion = motion}, law, "ground");
      break;
  }
}

inline const char* name_of(Ground ground) {
  constexpr std::array names{"half-plane", "terrain", "inside of a box", "inside of a circle", "wall",
                             "block",      "peg"};
  return names[static_cast<std::size_t>(ground)];
}

inline BodyId add_body(System& system, Form form, const Vec<2>& position, double angle,
                       const Vec<2>& velocity) {
  if (form == Form::particle) {
    return system.add(Particle{.mass = 1.0, .position = position, .velocity = velocity}, "body");
  }
  const BodyId body = system.add(RigidBody{.mass = box(1.0, 0.3, 0.2),
                                           .position = position,
                                           .angle = angle,
                                           .velocity = velocity,
                                           .spin = 0.7},
                                 "body");
  if (form == Form::disc) system.add(Disc{.body = body, .radius = 0.12});
  if (form == Form::capsule) {
    system.add(Segment{.body = body, .from = {-0.12, 0.0}, .to = {0.12, 0.0}, .radius = 0.05});
  }
  if (form == Form::brick) {
    system.add(Polygon{.body = body, .vertices = {{-0.15, -0.1}, {0.15, -0.1}, {0.15, 0.1}, {-0.15, 0.1}}});
  }
  return body;
}

/// A body that falls on the ground, a little turned.
inline System falling(Ground ground, Form form, const Surface& law, const Swing& swing = {}) {
  System system;
  system.add(Gravity{{0.0, -g}});
  add_ground(system, ground, law, swing);
  add_body(system, form, {0.05, 0.35}, 0.25, {0.4, 0.0});
  return system;
}

inline std::string title(Ground ground, Form form) {
  constexpr std::array names{"particle", "disc", "capsule", "brick"};
  return std::string(names[static_cast<std::size_t>(form)]) + " on " + name_of(ground);
}

}  // namespace ground_runs
