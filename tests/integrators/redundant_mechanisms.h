#pragma once

// Random mechanisms with redundant joints, named by their number, that pass positions in line: there the rank
// of their rows drops by more than the redundant ones.

#include "tests/integrators/joint_scenes.h"
#include "tests/random.h"

#include <carom/carom.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

namespace joint_scenes {

/// Bars with pins between them.
struct Linkage {
  struct Bar {
    BodyId body{};
    Vec<2> centre = Vec<2>::Zero();
    double angle = 0.0;
  };
  Scene scene;
  Bar base{ground};

  static Vec<2> along(double angle) { return {std::cos(angle), std::sin(angle)}; }

  /// A thin bar between two points. Its velocity is that of the first one, and its spin.
  Bar bar(double mass, const Vec<2>& from, const Vec<2>& to, const Vec<2>& velocity, double spin) {
    const Vec<2> way = to - from;
    Bar made{{}, 0.5 * (from + to), std::atan2(way[1], way[0])};
    made.body = scene.system.add(RigidBody{.mass = rod(mass, way.norm()),
                                           .position = made.centre,
                                           .angle = made.angle,
                                           .velocity = velocity + 0.5 * spin * Vec<2>(-way[1], way[0]),
                                           .spin = spin},
                                 "bar " + std::to_string(scene.bodies.size()));
    scene.bodies.push_back(made.body);
    return made;
  }
  void pin(const Bar& a, const Bar& b, const Vec<2>& at) {
    const auto end = [&](const Bar& on) -> End<2> {
      const Vec<2> arm = at - on.centre;
      const double c = std::cos(on.angle), s = std::sin(on.angle);
      return {on.body, {c * arm[0] + s * arm[1], c * arm[1] - s * arm[0]}};
    };
    scene.system.add(Revolute{.from = end(a), .to = end(b)},
                     "pin " + std::to_string(scene.system.joints().size()));
  }
};

/// Cranks of one length, parallel, with one to three couplers across all of them; their bases lie on a line,
/// which the cranks come to lie in twice a turn. Motion is that of a pendulum: everything but the cranks
/// moves without turning.
struct ParallelCranks {
  Linkage linkage;
  double line = 0.0;     ///< angle at which all are in line
  double spin = 0.0;     ///< at the start
  double gravity = 0.0;  ///< 0 or g
  double end = 0.0;      ///< after some five positions in line

  explicit ParallelCranks(std::uint64_t seed) {
    carom_test::Random random(seed);
    const unsigned cranks = 2 + random.below(7), couplers = 1 + (random.below(3) == 0 ? random.below(3) : 0);
    line = random.uniform(-3.0, 3.0);
    const double length = random.uniform(0.3, 1.0), start = line + random.uniform(0.3, 2.8);
    gravity = random.below(2) == 0 ? 0.0 : g;
    // Over the top, wherever that is.
    spin = std::sqrt(6.0 * g / length) * random.uniform(1.0, 2.0) * (random.below(2) == 0 ? -1.0 : 1.0);
    end = 5.0 * std::numbers::pi / std::abs(spin);
    if (gravity > 0.0) linkage.scene.system.add(Gravity{{0.0, -gravity}});
    std::vector<double> places;
    double place = random.uniform(-1.0, 1.0);
    for (unsigned i = 0; i < cranks; ++i) places.push_back(place += random.uniform(0.3, 1.2));
    const Vec<2> crank = length * Linkage::along(start), across = Linkage::along(line);
    const Vec<2> swing = length * spin * Vec<2>(-std::sin(start), std::cos(start));
    std::vector<Linkage::Bar> bars;
    for (const double at : places) {
      const Vec<2> from = at * across;
      bars.push_back(linkage.bar(random.uniform(0.2, 3.0), from, from + crank, Vec<2>::Zero(), spin));
      linkage.pin(linkage.base, bars.back(), from);
    }
    for (unsigned k = 0; k < couplers; ++k) {
      const double part = k == 0 ? 1.0 : random.uniform(0.2, 0.9);
      const auto tip = [&](double at) -> Vec<2> { return at * across + part * crank; };
      const Linkage::Bar coupler =
          linkage.bar(random.uniform(0.5, 4.0), tip(places.front()), tip(places.back()), part * swing, 0.0);
      for (std::size_t i = 0; i < places.size(); ++i) linkage.pin(bars[i], coupler, tip(places[i]));
    }
  }
};

/// A kite of four sides, the ground one of them, whose coupler or rocker comes two- or threefold. It passes
/// the position in which the crank lies on the ground side and the other two on each other.
struct RedundantKite {
  Linkage linkage;
  double gravity = 0.0;
  double end = 0.0;

  explicit RedundantKite(std::uint64_t seed) {
    carom_test::Random random(seed);
    const double ground_side = random.uniform(0.4, 0.8), other = ground_side * random.uniform(1.3, 2.5);
    const double line = random.uniform(-3.0, 3.0), start = random.uniform(0.5, 2.5);
    gravity = random.below(2) == 0 ? 0.0 : g;
    if (gravity > 0.0) linkage.scene.system.add(Gravity{{0.0, -gravity}});
    const double spin = -std::sqrt(40.0 * g / ground_side) * random.uniform(1.0, 1.5);
    const Vec<2> a = Vec<2>::Zero(), d = ground_side * Linkage::along(line);
    const Vec<2> b = ground_side * Linkage::along(line + start);
    // The fourth corner, on the line of symmetry through a.
    const double half = 0.5 * (b - d).norm(), to_middle = ground_side * std::cos(0.5 * start);
    const Vec<2> c =
        (to_middle + std::sqrt(other * other - half * half)) * Linkage::along(line + 0.5 * start);
    const Linkage::Bar crank = linkage.bar(random.uniform(1.0, 3.0), a, b, Vec<2>::Zero(), spin);
    linkage.pin(linkage.base, crank, a);
    const unsigned twins = 1 + random.below(3), rockers = 1 + random.below(2);
    std::vector<Linkage::Bar> of_rocker;
    for (unsigned k = 0; k < rockers; ++k) {
      of_rocker.push_back(linkage.bar(random.uniform(0.2, 1.0), d, c, Vec<2>::Zero(), 0.0));
      linkage.pin(linkage.base, of_rocker.back(), d);
    }
    for (unsigned k = 0; k < twins; ++k) {
      const Linkage::Bar coupler =
          linkage.bar(random.uniform(0.2, 1.0), b, c, spin * Vec<2>(-b[1], b[0]), 0.0);
      linkage.pin(crank, coupler, b);
      for (const Linkage::Bar& rocker : of_rocker) linkage.pin(rocker, coupler, c);
    }
    linkage.scene.system.keep_place(crank.body);
    end = (start + 1.0) / std::abs(spin);
  }
};

}  // namespace joint_scenes
