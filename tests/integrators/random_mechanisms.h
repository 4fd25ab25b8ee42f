#pragma once

// Random mechanisms, named by their number, so that one can be repeated.

#include "tests/integrators/joint_scenes.h"
#include "tests/random.h"

#include <carom/carom.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace joint_scenes {

inline Vec<2> turned_by(double angle, const Vec<2>& v) {
  return {std::cos(angle) * v[0] - std::sin(angle) * v[1], std::sin(angle) * v[0] + std::cos(angle) * v[1]};
}

/// A tree of uniform rods: each hangs on the ground or on an earlier one by a random joint, some with a
/// spring along its coordinate; gravity; velocities that obey the joints.
inline Scene random_tree(std::uint64_t seed) {
  carom_test::Random random(seed);
  Scene scene;
  System& system = scene.system;
  system.add(Gravity{{0.0, -g}});
  struct Link {
    BodyId body;
    Vec<2> centre, velocity;
    double angle, spin, length;
    [[nodiscard]] Vec<2> at(double x) const { return centre + turned_by(angle, {x, 0.0}); }
    [[nodiscard]] Vec<2> velocity_at(double x) const {
      const Vec<2> lever = turned_by(angle, {x, 0.0});
      return velocity + spin * Vec<2>(-lever[1], lever[0]);
    }
  };
  std::vector<Link> links{{ground, Vec<2>::Zero(), Vec<2>::Zero(), 0.0, 0.0, 1.0}};
  const unsigned number = 2 + random.below(6);
  for (unsigned i = 0; i < number; ++i) {
    const Link from = links[i == 0 ? 0 : random.below(static_cast<unsigned>(links.size()))];
    const unsigned kind = random.below(8);  // 0: prismatic, 1: weld, 2: rod, else revolute
    const double place = random.uniform(-0.5, 0.5) * from.length, mass = random.uniform(0.3, 3.0);
    Link link{{}, {}, {}, random.uniform(-3.0, 3.0), random.uniform(-2.0, 2.0), random.uniform(0.4, 1.2)};
    if (kind < 2) link.spin = from.spin;
    const double end = -0.5 * link.length;
    const double slides = kind == 0 ? random.uniform(-1.0, 1.0) : 0.0;
    const double stick = random.uniform(0.3, 0.8), bearing = random.uniform(-3.0, 3.0);
    const Vec<2> axis = turned_by(random.uniform(-3.0, 3.0), {1.0, 0.0});
    const Vec<2> across = kind == 2 ? turned_by(bearing, {stick, 0.0}) : Vec<2>::Zero();
    link.centre = from.at(place) + across - turned_by(link.angle, {end, 0.0});
    link.velocity = Vec<2>::Zero();
    link.velocity = from.velocity_at(place) + slides * turned_by(from.angle, axis) - link.velocity_at(end);
    link.body = system.add(RigidBody{.mass = rod(mass, link.length),
                                     .position = link.centre,
                                     .angle = link.angle,
                                     .velocity = link.velocity,
                                     .spin = link.spin});
    const End<2> a{from.body, {place, 0.0}}, b{link.body, {end, 0.0}};
    const bool spring = random.below(3) == 0;
    if (kind == 0) {
      const JointId joint = system.add(Prismatic{.from = a, .to = b, .axis = axis});
      // Without one it would slide away.
      system.add(Motor{.joint = joint, .torque = [](double, double x, double) { return -60.0 * x; }});
    } else if (kind == 1) {
      system.add(Weld{.from = a, .to = b});
    } else if (kind == 2) {
      system.add(Rod{.from = a, .to = b});
    } else {
      system.add(Revolute{.from = a, .to = b});
    }
    if (kind > 2 && spring) {
      system.add(TorsionalSpring{.from = from.body, .to = link.body, .stiffness = random.uniform(1.0, 20.0)});
    }
    scene.bodies.push_back(link.body);
    links.push_back(link);
  }
  return scene;
}

/// Such a tree with dry friction in all joints that have a coordinate.
inline Scene rubbing_tree(std::uint64_t seed) {
  Scene scene = random_tree(seed);
  carom_test::Random random(seed + 1000);
  for (const JointId joint : scene.system.joints()) {
    if (!scene.system.joint_kinds().kind_of(joint.serial).has_coordinate()) continue;
    scene.system.add(JointFriction{.joint = joint,
                                   .bound = random.uniform(0.1, 1.0),
                                   .coefficient = random.below(2) == 0 ? 0.0 : random.uniform(0.0, 0.02),
                                   .static_factor = random.below(2) == 0 ? 1.0 : random.uniform(1.0, 1.5)});
  }
  return scene;
}

/// A closed chain of uniform rods between two pins of the ground: four- or five-bar, with a crank that moves
/// at first (five-bar: and its other crank too); gravity. Seldom far from being closed wrongly: lengths are
/// those of the drawing.
inline Scene random_loop(std::uint64_t seed) {
  carom_test::Random random(seed);
  Scene scene;
  System& system = scene.system;
  system.add(Gravity{{0.0, -g}});
  const unsigned bars = 3 + random.below(2);
  std::vector<Vec<2>> corners{Vec<2>::Zero()};
  // Bars as the sides of a bulging polygon.
  for (unsigned i = 0; i < bars; ++i) {
    const double angle = 1.8 - 3.6 * (i + random.uniform(0.2, 0.8)) / bars;
    corners.push_back(corners.back() + turned_by(angle, {random.uniform(0.4, 1.2), 0.0}));
  }
  for (unsigned i = 0; i < bars; ++i) {
    const Vec<2> along = corners[i + 1] - corners[i], centre = 0.5 * (corners[i] + corners[i + 1]);
    const double length = along.norm();
    const BodyId bar = system.add(RigidBody{.mass = rod(random.uniform(0.5, 3.0), length),
                                            .position = centre,
                                            .angle = std::atan2(along[1], along[0]),
                                            .spin = random.uniform(-2.0, 2.0)});
    const End<2> before =
        i == 0 ? End<2>(ground)
               : End<2>(scene.bodies.back(), {0.5 * (corners[i] - corners[i - 1]).norm(), 0.0});
    system.add(Revolute{.from = before, .to = {bar, {-0.5 * length, 0.0}}});
    scene.bodies.push_back(bar);
    if (i + 1 == bars)
      system.add(Revolute{.from = {ground, corners.back()}, .to = {bar, {0.5 * length, 0.0}}});
  }
  return scene;
}

}  // namespace joint_scenes
