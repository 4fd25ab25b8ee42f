#pragma once

// Random mechanisms, numbers for their bodies, and how far these are from obeying the joints.

#include <carom/core/dynamics/joint_constraints.h>
#include <carom/joints/driver.h>
#include <carom/joints/prismatic.h>
#include <carom/joints/revolute.h>
#include <carom/joints/rod.h>

#include "tests/random.h"

#include <carom/bodies/particle.h>
#include <carom/bodies/rigid_body.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace random_mechanism {

using namespace carom;
using namespace carom::planar;
using carom_test::Random;

/// All meanings of numbers of the bodies.
inline constexpr std::array levels{JointLevel::displacement, JointLevel::velocity, JointLevel::acceleration,
                                   JointLevel::change};

/// A disc at a random place, with a random motion.
inline BodyId random_plate(System& system, Random& random) {
  return system.add(RigidBody{.mass = disc(random.uniform(0.5, 2.0), random.uniform(0.5, 1.0)),
                              .position = random.vec<2>(3.0),
                              .angle = random.uniform(-3.0, 3.0),
                              .velocity = random.vec<2>(),
                              .spin = random.uniform(-1.0, 1.0)});
}

/// A random tree of bodies with a loop, an extra rod, a driver, and a second component.
inline System random_scene(Random& random) {
  System system;
  std::vector<BodyId> bodies;
  for (int i = 0; i < 8; ++i) {
    const BodyId body = random_plate(system, random);
    const BodyId onto = bodies.empty() ? ground : bodies[random.below(static_cast<unsigned>(bodies.size()))];
    const End<2> from(onto, random.vec<2>()), to(body, random.vec<2>());
    switch (random.below(4)) {
      case 0:
        system.add(Weld{.from = from, .to = to});
        break;
      case 1:
        system.add(Prismatic{.from = from, .to = to, .axis = random.vec<2>()});
        break;
      case 2:
        system.add(PointOnLine{.from = from, .to = to, .axis = random.vec<2>()});
        break;
      default:
        system.add(Driver{.joint = system.add(Revolute{.from = from, .to = to}),
                          .position = [](double t) { return std::sin(t); },
                          .velocity = [](double t) { return std::cos(t); },
                          .acceleration = [](double t) { return -std::sin(t); }});
    }
    bodies.push_back(body);
  }
  const BodyId dot = system.add(Particle{.mass = 0.5, .position = random.vec<2>(3.0)});
  system.add(Rod{.from = bodies[2], .to = dot});
  const BodyId a = random_plate(system, random), b = random_plate(system, random);
  system.add(Gear{.from = a, .to = b, .ratio = 0.5});
  system.add(Rolling{.from = {a, random.vec<2>()}, .to = b, .normal = random.vec<2>(), .radius = 0.5});
  return system;
}

/// Numbers from -1 to 1.
inline std::vector<double> random_numbers(std::size_t size, Random& random) {
  std::vector<double> numbers(size);
  for (double& x : numbers) x = random.uniform(-1.0, 1.0);
  return numbers;
}

/// The largest of what the rows leave of x at a level.
inline double largest_residual(const JointConstraints& joints, JointLevel level,
                               const std::vector<double>& x) {
  double largest = 0.0;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    largest = std::max(largest, std::abs(residual(level, joints.row(i), x.data())));
  }
  return largest;
}

}  // namespace random_mechanism
