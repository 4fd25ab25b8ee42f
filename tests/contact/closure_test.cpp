// Joints and closed contacts are closed by the smallest change, without a simulation.

#include <carom/carom.h>
#include <carom/contact/closure.h>
#include <carom/contact/detection/detector.h>
#include <carom/core/constraint_set.h>

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;

/// A model of one component at a state of its own.
struct Posed {
  explicit Posed(const System& system)
      : assembly(system),
        detector(assembly),
        state(assembly.initial_state()),
        evaluation(make_evaluation(assembly)),
        rows(assembly, 0),
        arrays(assembly),
        force(state.v.size()) {
    if (!rows.empty()) joints.push_back(&rows);
    response.bind(joints);
    contacts.bind(assembly, response);
  }

  /// Closes what is closed, with contacts of these modes.
  Closure close(const std::vector<ContactMode>& modes = {}) {
    evaluate_positions(assembly, 0, state.view(), evaluation);
    if (!rows.empty()) rows.update_and_factor({state.view(), evaluation.rotation.data()});
    ConstraintSet found;
    detector.find(0, state.view(), evaluation, 1.0, found);
    contacts.list().clear();
    for (std::size_t i = 0; i < modes.size(); ++i) {
      ActiveContact& closed = contacts.list().emplace_back();
      closed.at = found[i];
      closed.mode = modes[i];
      closed.place = static_cast<Index>(i);
    }
    const std::vector<Index> all{0};
    const ClosureInput in{.assembly = assembly,
                          .components = all,
                          .joints = joints,
                          .contacts = contacts,
                          .state = state.view(),
                          .force = force.data()};
    State out = state;
    const auto place_of = [&](Index) { return ClosedPlace{out.q.data(), out.v.data()}; };
    const Closure closure = carom::close(in, place_of, arrays);
    state = out;
    return closure;
  }

  Assembly assembly;
  Detector detector;
  State state;
  Evaluation evaluation;
  JointConstraints rows;
  std::vector<JointConstraints*> joints;
  ComponentsResponse response{assembly};
  ActiveSetMemory memory;
  ActiveSet contacts{memory};
  ClosureMemory arrays;
  std::vector<double> force;
};

constexpr double rounding = 1e-14;  // of places of 1 m and velocities of 1 m/s

System pendulum() {
  System system;
  const BodyId bob = system.add(Particle{.mass = 2.0, .position = {1.0, 0.0}, .velocity = {0.0, 3.0}});
  system.add(Rod{.from = {ground, {0.0, 0.0}}, .to = bob});
  return system;
}

System brick_on_a_floor() {
  System system;
  const BodyId brick = system.add(RigidBody{.mass = box(2.0, 0.4, 0.2), .position = {0.0, 0.1}});
  system.add(Polygon{.body = brick, .vertices = {{-0.2, -0.1}, {0.2, -0.1}, {0.2, 0.1}, {-0.2, 0.1}}});
  system.add(HalfPlane{.point = {0, 0}, .normal = {0, 1}},
             Surface{.friction = 0.5, .normal_restitution = 0.0});
  return system;
}

TEST(Closure, ARodThatIsTooLongIsShortenedAndItsSpeedTakenOut) {
  Posed posed(pendulum());
  posed.state.q[0] += 1e-6;
  posed.state.v[0] += 0.01;
  posed.force[0] = -5.0;
  const Closure closure = posed.close();
  EXPECT_TRUE(closure.changed);
  EXPECT_NEAR(posed.state.q[0], 1.0, 1e-12);  // the square of what it was off
  EXPECT_NEAR(posed.state.v[0], 0.0, rounding);
  EXPECT_EQ(posed.state.v[1], 3.0);
  EXPECT_NEAR(closure.shift, 1e-6, 1e-11);
  EXPECT_NEAR(closure.velocity_energy, 0.5 * 2.0 * 0.01 * 0.01, 1e-15);
  // The force pushed the bob back by the shift: its potential fell by that.
  EXPECT_NEAR(closure.lost, 0.5 * 2.0 * 0.01 * 0.01 + 5.0 * 1e-6, 1e-11);
}

TEST(Closure, WhatObeysIsNotMoved) {
  Posed posed(pendulum());
  const State before = posed.state;
  const Closure closure = posed.close();
  EXPECT_EQ(closure.shift, 0.0);
  EXPECT_EQ(closure.velocity_energy, 0.0);
  EXPECT_EQ(posed.state.q, before.q);
  EXPECT_EQ(posed.state.v, before.v);
}

TEST(Closure, WithoutConstraintsThereIsNothingToClose) {
  System system;
  system.add(Particle{.mass = 2.0, .position = {1.0, 0.0}, .velocity = {0.0, 3.0}});
  EXPECT_FALSE(Posed(system).close().changed);
}

TEST(Closure, BothCornersOfABrickComeToTheFloor) {
  Posed posed(brick_on_a_floor());
  posed.state.q[1] += 2e-7;
  posed.state.q[2] += 1e-7;
  posed.state.v = {1.0, -1e-5, 2e-5};
  const Closure closure = posed.close({ContactMode::slip_positive, ContactMode::slip_positive});
  EXPECT_TRUE(closure.changed);
  EXPECT_NEAR(posed.state.q[1], 0.1, 1e-13);  // squares of 1e-7
  EXPECT_NEAR(posed.state.q[2], 0.0, 1e-13);
  EXPECT_NEAR(posed.state.v[0], 1.0, 1e-11);  // rows are those of the angle before
  EXPECT_NEAR(posed.state.v[1], 0.0, 1e-11);
  EXPECT_NEAR(posed.state.v[2], 0.0, 1e-11);
  EXPECT_GT(closure.velocity_energy, 0.0);
}

TEST(Closure, WhatSticksIsStoppedAndStaysInItsPlace) {
  Posed posed(brick_on_a_floor());
  posed.state.q[0] = 0.3;
  posed.state.v = {1e-4, 0.0, 0.0};
  static_cast<void>(posed.close({ContactMode::stick, ContactMode::slip_positive}));
  EXPECT_NEAR(posed.state.v[0], 0.0, rounding);
  EXPECT_NEAR(posed.state.q[0], 0.3, rounding);
}

// Of all changes that close the rows the one that is found is orthogonal, in the sense of the masses, to all
// motions that the rows leave: M d lies in the span of their transposes.
TEST(Closure, ChangesAreTheLeastInTheSenseOfTheMasses) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  for (int i = 0; i < 200; ++i) {
    System system;
    const BodyId first = system.add(RigidBody{
        .mass = {1.0 + number(random) * 0.5, 0.3}, .position = {0.0, 0.0}, .angle = number(random)});
    const BodyId second = system.add(RigidBody{.mass = {3.0, 0.1}, .position = {1.0, number(random)}});
    system.add(Rod{.from = {first, {0.2, 0.1}}, .to = {second, {-0.1, 0.3}}});
    Posed posed(system);
    posed.state.v = {number(random), number(random), number(random),
                     number(random), number(random), number(random)};
    const std::vector<double> before = posed.state.v;
    ASSERT_TRUE(posed.close().changed);
    std::vector<double> residual(posed.rows.size());
    posed.rows.residuals(JointLevel::velocity, posed.state.v.data(), residual.data());
    EXPECT_NEAR(residual[0], 0.0, rounding);
    // u.M v = 0 for the change u and the velocities v after it, which obey the rows.
    std::vector<double> momentum(6);
    posed.assembly.for_bodies(0, [&](const BodyKind& kind, Range slots, Index, Index v, Index) {
      kind.apply_mass(slots, posed.state.v.data() + v, momentum.data() + v);
    });
    double product = 0.0;
    for (std::size_t k = 0; k < 6; ++k) product += (posed.state.v[k] - before[k]) * momentum[k];
    EXPECT_NEAR(product, 0.0, 1e-13);  // of energies of some joules
  }
}

}  // namespace
