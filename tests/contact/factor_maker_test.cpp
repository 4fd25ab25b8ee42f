// Contacts of bodies that joints bind, left in factors, against the same with W as a matrix.

#include "tests/contact/random_constraints.h"
#include "tests/random.h"

#include <carom/carom.h>
#include <carom/contact/factor_maker.h>
#include <carom/contact/island_problem.h>
#include <carom/contact/solvers/residual.h>
#include <carom/core/assembly.h>
#include <carom/core/constraint_set.h>
#include <carom/core/dynamics/components_response.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::Random;

constexpr int chain = 6, others = 40;

/// Rods in a chain that is pinned to the ground, and bodies that nothing binds, particles among them.
System bodies() {
  System system;
  BodyId last = ground;
  for (int i = 0; i < chain; ++i) {
    const BodyId link = system.add(RigidBody{.mass = rod(1.0 + 0.3 * i, 1.0), .position = {0.5 + i, 0.0}});
    system.add(Revolute{.from = {last, {i == 0 ? 0.0 : 0.5, 0.0}}, .to = {link, {-0.5, 0.0}}});
    last = link;
  }
  for (int i = 0; i < others; ++i) {
    const Vec<2> place(1.0 * i, 3.0);
    if (i % 5 == 3) {
      system.add(Particle{.mass = 0.7, .position = place});
    } else {
      system.add(RigidBody{.mass = {.mass = 1.0 + 0.1 * i, .inertia = 0.5}, .position = place});
    }
  }
  return system;
}

class BoundBodies : public testing::Test {
protected:
  BoundBodies() : assembly_(bodies()), response_(assembly_) {
    chain_.set_budget({.residual = 1e-11, .sweeps = 2000});
    Evaluation evaluation = make_evaluation(assembly_);
    const State state = assembly_.initial_state();
    for (Index component = 0; component < assembly_.components().size(); ++component) {
      evaluate_positions(assembly_, component, state.view(), evaluation);
      append_constraints(assembly_, component, joints_);
    }
    for (JointConstraints& of_component : joints_)
      of_component.update_and_factor({state.view(), evaluation.rotation.data()});
    list_ = addresses_of(joints_);
    response_.bind(list_);
    Random random(5);
    for (std::size_t i = 0; i < state.v.size(); ++i) {
      before_.push_back(random.uniform(-1.0, 1.0));
      free_.push_back(random.uniform(-1.0, 1.0));
    }
    // A link that is held fast could not be answered else.
    for (std::vector<double>* const velocity : {&before_, &free_})
      joints_[0].project(JointLevel::change, velocity->data());
  }
  /// Contacts with ground and of two bodies, and limits, each with a link of the chain or without. One acts
  /// on the pin at the ground, which holds it fast.
  ConstraintSet constraints(int count, std::uint64_t seed) const {
    Random random(seed);
    ConstraintSet made;
    for (int i = 0; i < count; ++i) {
      const auto first = static_cast<Index>(i % (chain + others));
      const std::array<Index, 2> touched{first, (first + 5) % (chain + others)};
      const auto some = static_cast<std::size_t>(1 + i % 2);
      made.add(carom_test::random_constraint(assembly_, i % 7 == 6 ? 1 : 2, std::span(touched).first(some),
                                             random));
    }
    const double of_pin[2][3] = {{1.0, 0.0, 0.0}, {0.0, 1.0, -0.5}};
    for (int row = 0; row < 2; ++row) std::copy_n(of_pin[row], 3, made[0].row(row));
    return made;
  }

  Assembly assembly_;
  std::vector<JointConstraints> joints_;
  std::vector<JointConstraints*> list_;
  ComponentsResponse response_;
  std::vector<double> before_, free_;
  SolverChain chain_;
};

TEST_F(BoundBodies, AreTheSameProblemInFactors) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const ConstraintSet list = constraints(most_exact_contacts + 1 + static_cast<int>(seed), seed);
    IslandProblem island({.factored_from = factored_constraints}), whole;
    for (IslandProblem* const one : {&island, &whole}) {
      one->build(list, before_.data());
      one->respond(response_);
      one->set_free_velocity(free_.data());
    }
    ASSERT_TRUE(island.problem().is_factored());
    ASSERT_FALSE(whole.problem().is_factored());
    const ContactProblem dense = island.problem().dense();
    const auto n = static_cast<std::size_t>(dense.rows());
    // Rounding of the answers of joints.
    for (std::size_t i = 0; i < n * n; ++i)
      EXPECT_NEAR(dense.matrix()[i], whole.problem().matrix()[i], 1e-13) << i / n << ", " << i % n;
    for (std::size_t row = 0; row < n; ++row) {
      EXPECT_NEAR(dense.vector()[row], whole.problem().vector()[row], 1e-13);
      EXPECT_NEAR(island.problem().diagonal(static_cast<int>(row)), whole.problem().matrix()[row * n + row],
                  1e-13);
    }

    ASSERT_TRUE(island.solve(chain_).usable());
    EXPECT_EQ(island.report().solver, "nonlinear CG");
    std::vector<double> xi(n), after = free_;
    dense.velocities(island.impulses(), xi);
    EXPECT_LE(residual(dense, island.impulses(), xi).value, 1.01e-11);
    // xi = gamma^+ + E gamma^-, over all bodies that answer: rounding of impulses some hundred times b.
    island.add_velocities(after.data());
    for (std::size_t row = 0; row < n; ++row) {
      const ImpulseDirection& at = island.directions()[row];
      EXPECT_NEAR(xi[row],
                  at.constraint->velocity_after(at.row, after.data()) +
                      at.constraint->restitution(at.row) * island.before()[row],
                  1e-12);
    }
    std::vector<double> all = after;
    for (std::size_t i = 0; i < all.size(); ++i) all[i] -= free_[i];
    std::vector<double> off(joints_[0].size());
    joints_[0].residuals(JointLevel::change, all.data(), off.data());
    for (const double left : off) EXPECT_NEAR(left, 0.0, 1e-12);
  }
}

TEST_F(BoundBodies, FewOfThemAreWorthExactAnswers) {
  const ConstraintSet list = constraints(most_exact_contacts, 3);
  IslandProblem island({.factored_from = factored_constraints});
  island.build(list, before_.data());
  island.respond(response_);
  EXPECT_FALSE(island.problem().is_factored());
}

TEST_F(BoundBodies, LeaveNothingBehindInTheNextProblem) {
  const ConstraintSet list = constraints(60, 3);
  IslandProblem island({.factored_from = factored_constraints}),
      fresh({.factored_from = factored_constraints});
  island.build(list, before_.data());
  island.respond(response_);
  MassResponse masses(assembly_);
  for (IslandProblem* const one : {&island, &fresh}) {
    one->build(list, before_.data());
    one->respond(masses);
    one->set_free_velocity(free_.data());
    ASSERT_TRUE(one->solve(chain_).usable());
  }
  EXPECT_FALSE(island.problem().factors().any_bound());
  for (std::size_t row = 0; row < fresh.impulses().size(); ++row)
    EXPECT_EQ(island.impulses()[row], fresh.impulses()[row]);
}

}  // namespace
