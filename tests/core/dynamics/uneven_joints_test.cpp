// Joints between bodies whose masses differ by up to 1e12: which rows follow from others is geometry, and
// what joints do to bodies is right at any ratio.

#include <carom/carom.h>
#include <carom/core/assembly.h>
#include <carom/core/dynamics/joint_constraints.h>

#include "tests/core/dynamics/random_mechanism.h"
#include "tests/joints/joint_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::JointModel;
using carom_test::Random;

/// Geometry of a random mechanism: pins and rods between links, particles and ground.
struct Mechanism {
  struct Body {
    bool particle = false;
    Vec<2> position = Vec<2>::Zero();
    double angle = 0.0;
  };
  struct Joint {
    bool rod = false;
    int from = -1, to = -1;  // -1: ground
    Vec<2> a = Vec<2>::Zero(), b = Vec<2>::Zero();
  };
  std::vector<Body> bodies;
  std::vector<Joint> joints;

  int add_body(Random& random, bool particle) {
    bodies.push_back({particle, random.vec<2>(2.0), random.uniform(-3.0, 3.0)});
    return static_cast<int>(bodies.size()) - 1;
  }
  [[nodiscard]] Vec<2> local(int body, const Vec<2>& place) const {
    if (body < 0) return place;
    const Body& at = bodies[static_cast<std::size_t>(body)];
    if (at.particle) return Vec<2>::Zero();
    const double c = std::cos(at.angle), s = std::sin(at.angle);
    const Vec<2> arm = place - at.position;
    return {c * arm[0] + s * arm[1], c * arm[1] - s * arm[0]};
  }
  /// A pin at a place, or a rod between two; ends on particles are where these are.
  void join(int from, int to, bool rod, const Vec<2>& a, const Vec<2>& b) {
    joints.push_back({rod, from, to, local(from, a), local(to, rod ? b : a)});
  }

  /// The system with masses, bodies and joints in a random order if one is given.
  [[nodiscard]] System system(const std::vector<double>& masses, Random* order = nullptr) const {
    System made;
    std::vector<std::size_t> places(bodies.size()), joint_places(joints.size());
    for (std::size_t i = 0; i < places.size(); ++i) places[i] = i;
    for (std::size_t i = 0; i < joint_places.size(); ++i) joint_places[i] = i;
    const auto shuffle = [order](std::vector<std::size_t>& list) {
      for (std::size_t i = list.size(); order != nullptr && i-- > 1;) {
        std::swap(list[i], list[order->below(static_cast<unsigned>(i + 1))]);
      }
    };
    shuffle(places);
    shuffle(joint_places);
    std::vector<BodyId> ids(bodies.size());
    for (const std::size_t i : places) {
      const Body& body = bodies[i];
      ids[i] = body.particle
                   ? made.add(Particle{.mass = masses[i], .position = body.position})
                   : made.add(RigidBody{
                         .mass = rod(masses[i], 1.0), .position = body.position, .angle = body.angle});
    }
    const auto end = [&](int body, const Vec<2>& place) -> End<2> {
      return {body < 0 ? ground : ids[static_cast<std::size_t>(body)], place};
    };
    for (const std::size_t i : joint_places) {
      const Joint& joint = joints[i];
      if (joint.rod) {
        made.add(Rod{.from = end(joint.from, joint.a), .to = end(joint.to, joint.b)});
      } else {
        made.add(Revolute{.from = end(joint.from, joint.a), .to = end(joint.to, joint.b)});
      }
    }
    return made;
  }
};

/// A tree of links and particles, closed to loops by rods, with pins that come twice, and bars on parallel
/// rods of one length.
Mechanism random_geometry(std::uint64_t seed) {
  Random random(seed);
  Mechanism made;
  const unsigned count = 2 + random.below(8);
  for (unsigned i = 0; i < count; ++i) {
    const bool particle = random.below(4) == 0;
    const int onto = made.bodies.empty() || random.below(4) == 0
                         ? -1
                         : static_cast<int>(random.below(static_cast<unsigned>(made.bodies.size())));
    const int body = made.add_body(random, particle);
    const Vec<2> own = made.bodies.back().position;
    const bool onto_particle = onto >= 0 && made.bodies[static_cast<std::size_t>(onto)].particle;
    const Vec<2> a =
        onto_particle ? made.bodies[static_cast<std::size_t>(onto)].position : random.vec<2>(2.0);
    if (particle || onto_particle) {
      made.join(onto, body, true, a, particle ? own : random.vec<2>(2.0));
    } else {
      made.join(onto, body, false, a, a);
      if (random.below(5) == 0) made.join(onto, body, false, a, a);  // twice
    }
  }
  if (random.below(2) == 0) {  // a bar on three parallel rods, or four
    const int bar = made.add_body(random, false);
    const Vec<2> across = random.vec<2>(1.0), along = random.vec<2>(1.0);
    const unsigned rods = 3 + random.below(2);
    for (unsigned i = 0; i < rods; ++i) {
      const Vec<2> at = made.bodies.back().position + (i - 1.0) * along;
      made.join(0, bar, true, made.bodies[0].particle ? made.bodies[0].position : Vec<2>(at + across), at);
    }
  }
  return made;
}

std::vector<double> random_masses(std::size_t count, double decades, Random& random) {
  std::vector<double> masses(count);
  for (double& mass : masses) mass = std::pow(10.0, -random.uniform(0.0, decades));
  if (count > 1) masses[random.below(static_cast<unsigned>(count))] = std::pow(10.0, -decades);
  return masses;
}

Index rank_of(const System& system) {
  const Assembly assembly(system);
  return mobility(assembly, assembly.initial_state()).independent_rows;
}

TEST(UnevenJoints, ALightParticleBetweenRodsBindsAHeavyOne) {
  for (const double mass : {1e-3, 1e-9, 1e-11, 1e-13, 1e3, 1e12}) {
    System system;
    const BodyId near = system.add(Particle{.mass = mass, .position = {1, 0}});
    const BodyId far = system.add(Particle{.mass = 1.0, .position = {2, 0}});
    system.add(Rod{.from = ground, .to = near});
    system.add(Rod{.from = near, .to = far});
    EXPECT_EQ(rank_of(system), 2U) << mass;
  }
}

TEST(UnevenJoints, RowsFollowFromOthersByGeometryAtAnyMasses) {
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    const Mechanism mechanism = random_geometry(seed);
    const Index rank = rank_of(mechanism.system(std::vector<double>(mechanism.bodies.size(), 1.0)));
    Random random(seed + 5000);
    for (const double decades : {3.0, 6.0, 9.0, 12.0}) {
      const std::vector<double> masses = random_masses(mechanism.bodies.size(), decades, random);
      EXPECT_EQ(rank_of(mechanism.system(masses)), rank) << seed << ' ' << decades;
      EXPECT_EQ(rank_of(mechanism.system(masses, &random)), rank) << seed << ' ' << decades << ", shuffled";
    }
  }
}

/// Accelerations obey the joints, and are those that loads and forces along the rows cause: with both they
/// are the answer, whatever the masses are.
TEST(UnevenJoints, ProjectionsObeyJointsByForcesAlongThem) {
  for (std::uint64_t seed = 1; seed <= 150; ++seed) {
    const Mechanism mechanism = random_geometry(seed);
    Random random(seed + 9000);
    const std::vector<double> masses = random_masses(mechanism.bodies.size(), 12.0, random);
    const JointModel model(mechanism.system(masses));
    for (Index component = 0; component < model.assembly.components().size(); ++component) {
      JointConstraints joints(model.assembly, component);
      if (joints.empty()) continue;
      joints.update_and_factor(model.view());
      const Range v = joints.velocities();
      const std::vector<double> before = random_mechanism::random_numbers(model.state.v.size(), random);
      std::vector<double> after = before, multipliers(joints.size()), along(before.size(), 0.0),
                          size(before.size(), 0.0), response(before.size(), 1.0);
      joints.project(JointLevel::change, after.data(), multipliers.data());
      EXPECT_LE(random_mechanism::largest_residual(joints, JointLevel::change, after), 1e-12) << seed;
      // Rounding is that of forces, however light the body is that they pull at.
      joints.apply_inverse_mass(response.data());
      joints.add_transposed(multipliers.data(), along.data());
      double largest = 0.0;
      for (const double force : multipliers) largest = std::max(largest, std::abs(force));
      for (Index i = v.begin; i < v.end; ++i) {
        EXPECT_NEAR((after[i] - before[i]) / response[i], along[i], 1e-13 * std::max(largest, 1.0)) << seed;
      }
      // Impulses change by the multipliers alone.
      std::vector<double> right(joints.size()), answer(before.size(), 0.0);
      joints.residuals(JointLevel::change, before.data(), right.data());
      joints.solve(right.data());
      for (std::size_t row = 0; row < right.size(); ++row) {
        EXPECT_NEAR(right[row], multipliers[row], 1e-8 * std::max(largest, 1.0)) << seed;
      }
    }
  }
}

}  // namespace
