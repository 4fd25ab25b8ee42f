#pragma once

// Boxes and bars that stand on one corner and fall over: the other corner strikes while the first is in
// contact.

#include "tests/random.h"

#include <carom/carom.h>
#include <carom/core/assembly.h>
#include <carom/integrators/run/companion.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

namespace lasting_scenes {

using namespace carom;
using namespace carom::planar;

/// A body on its lowest corner, at rest.
struct Tilted {
  double width = 1.2, height = 0.6;  // [m]; 0: a bar
  double mass = 1.0;                 // [kg]
  double angle = 0.3;                // [rad]
  double slope = 0.0;                // of the floor [rad]
  Surface surface{.friction = 0.0, .normal_restitution = 0.6};
};

inline BodyId add(System& system, const Tilted& what) {
  const double w = 0.5 * what.width, h = 0.5 * what.height;
  std::vector<Vec<2>> corners{{-w, -h}, {w, -h}};
  if (h > 0.0) corners.insert(corners.end(), {{w, h}, {-w, h}});
  const Vec<2> normal = incline(what.slope);
  double lowest = std::numeric_limits<double>::infinity();
  const double c = std::cos(what.angle), s = std::sin(what.angle);
  for (const Vec<2>& corner : corners) {
    lowest =
        std::min(lowest, normal.dot(Vec<2>(c * corner[0] - s * corner[1], s * corner[0] + c * corner[1])));
  }
  const MassProperties mass = h > 0.0 ? box(what.mass, what.width, what.height) : rod(what.mass, what.width);
  const BodyId body =
      system.add(RigidBody{.mass = mass, .position = -lowest * normal, .angle = what.angle}, "body");
  if (h > 0.0) {
    system.add(Polygon{.body = body, .vertices = corners}, "box");
  } else {
    system.add(Segment{.body = body, .from = corners[0], .to = corners[1]}, "bar");
  }
  return body;
}

inline System tilted(const Tilted& what) {
  System system;
  system.add(Gravity{{0.0, -9.81}});
  system.add(HalfPlane{.normal = incline(what.slope)}, what.surface, "floor");
  add(system, what);
  return system;
}

inline Tilted random_tilted(std::uint64_t seed) {
  carom_test::Random random(seed);
  Tilted what;
  what.width = random.uniform(0.3, 1.5);
  what.height = random.below(2) == 0 ? 0.0 : random.uniform(0.1, 0.8);
  what.mass = random.uniform(0.5, 3.0);
  what.angle = random.uniform(0.05, 1.2) * (random.below(2) == 0 ? -1.0 : 1.0);
  what.slope = random.below(2) == 0 ? 0.0 : random.uniform(-0.2, 0.2);
  const double e = random.below(5) == 0 ? 0.0 : random.uniform(0.0, 0.9);
  const double friction = random.below(2) == 0 ? 0.0 : random.uniform(0.05, 0.6);
  what.surface = {.friction = friction, .normal_restitution = e, .tangential_restitution = e};
  return what;
}

/// When a corner strikes while another is closed; nothing if that does not happen within `longest` [s].
inline std::optional<double> strike_while_closed(const System& system, double longest) {
  constexpr double strikes = 0.1;  // [m/s]
  Simulation exact(system, EventDriven{.relative_tolerance = 1e-10, .interval = 1e-3});
  while (exact.time() < longest) {
    const auto closed = exact.companion().modes;
    exact.clear_events();
    exact.step();
    for (const EventRecord& event : exact.events()) {
      if (event.kind != EventKind::impact || event.velocity_before[0] > -strikes) continue;
      const bool lasts = std::any_of(closed.begin(), closed.end(),
                                     [&](const auto& entry) { return entry.first != event.contact; });
      if (!lasts) return std::nullopt;
      return event.time;
    }
  }
  return std::nullopt;
}

/// Step lengths from `largest` down to `smallest`, evenly spread by their logarithms.
inline std::vector<double> step_lengths(double largest, double smallest, int count) {
  std::vector<double> steps;
  for (int i = 0; i < count; ++i) {
    steps.push_back(largest * std::pow(smallest / largest, static_cast<double>(i) / (count - 1)));
  }
  return steps;
}

/// Largest difference of the coordinates of two states, angles weighed with lengths [m].
inline double apart(const Simulation& a, const Simulation& b) {
  const std::vector<double> lengths = a.assembly().length_scales();
  double largest = 0.0;
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    largest = std::max(largest, std::abs(a.state().q[i] - b.state().q[i]) * lengths[i]);
  }
  return largest;
}

}  // namespace lasting_scenes
