// Contacts of one body as a problem, and back: W = H M^-1 H^T, b = H v_free + E H v^-, v += M^-1 H^T P.

#include <carom/carom.h>
#include <carom/contact/detection/detector.h>
#include <carom/contact/island_problem.h>
#include <carom/core/assembly.h>
#include <carom/core/constraint_set.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;

/// A body of 1 kg and 0.1 kg m^2 whose point (1, -2) is 1e-9 m deep in the floor: W_nn = 11, W_tt = 41,
/// W_nt = 20.
System leaning(const Surface& surface) {
  System system;
  system.add(HalfPlane{.normal = {0.0, 1.0}}, surface);
  const BodyId body =
      system.add(RigidBody{.mass = {.mass = 1.0, .inertia = 0.1}, .position = {0.0, 2.0 - 1e-9}});
  system.add(Point{.body = body, .position = {1.0, -2.0}});
  return system;
}

/// A row along the first velocity of a body.
SingleConstraint row_along_x(Index body, int columns) {
  SingleConstraint made;
  made.law = {.friction = 0.5, .normal_restitution = 0.0};
  made.friction = 0.5;
  made.add_body(body, 0, columns);
  made.start_rows(1);
  std::fill_n(made.row(0), columns, 0.0);
  made.row(0)[0] = 1.0;
  return made;
}

class IslandProblemTest : public testing::Test {
protected:
  explicit IslandProblemTest(const Surface& surface = {.friction = 2.0, .normal_restitution = 0.0})
      : assembly_(leaning(surface)) {
    const State state = assembly_.initial_state();
    Evaluation evaluation = make_evaluation(assembly_);
    evaluate_positions(assembly_, 0, state.view(), evaluation);
    Detector(assembly_).find(0, state.view(), evaluation, 0.0, contacts_);
  }

  IslandProblem cluster(const std::array<double, 3>& before) const {
    IslandProblem made;
    made.build(contacts_, before.data());
    MassResponse masses(assembly_);
    made.respond(masses);
    return made;
  }
  /// Solves for the velocity (tangential, normal) of the contact without impulses; the mode.
  ContactMode solve(IslandProblem& on, double tangential, double normal) {
    const std::array<double, 3> free{tangential, normal, 0.0};
    on.set_free_velocity(free.data());
    EXPECT_TRUE(on.solve(chain_).usable());
    EXPECT_LE(on.report().residual, 1e-14);
    return on.modes()[0];
  }

  Assembly assembly_;
  ConstraintSet contacts_;
  SolverChain chain_;
};

TEST_F(IslandProblemTest, MatrixVectorAndWayBack) {
  ASSERT_EQ(contacts_.size(), 1u);
  IslandProblem one = cluster({0.5, -3.0, 0.0});
  EXPECT_NEAR(one.problem().w(0, 0), 11.0, 1e-13);
  EXPECT_NEAR(one.problem().w(1, 1), 41.0, 1e-13);
  EXPECT_NEAR(one.problem().w(0, 1), 20.0, 1e-13);
  EXPECT_EQ(one.problem().w(0, 1), one.problem().w(1, 0));
  EXPECT_EQ(one.before()[0], -3.0);
  EXPECT_EQ(one.before()[1], 0.5);
  EXPECT_EQ(solve(one, 0.5, -3.0), ContactMode::stick);
  // Sticking with e = 0: the contact stands still afterwards.
  std::array<double, 3> velocity{0.5, -3.0, 0.0};
  one.map().add_velocities(velocity.data());
  EXPECT_NEAR(contacts_[0].velocity(0, velocity.data()), 0.0, 1e-14);
  EXPECT_NEAR(contacts_[0].velocity(1, velocity.data()), 0.0, 1e-14);
}

TEST_F(IslandProblemTest, KeepsToItsModesWhereSeveralSolutionsExist) {
  // mu W_nt > W_nn: for the slip speed 1 and the normal speed b without contact there is one solution for
  // b < 0 (stick), there are three for small b > 0 (open, slip+, stick) and one for b > 20/41 (open).
  IslandProblem falling = cluster({1.0, -0.1, 0.0});
  EXPECT_EQ(solve(falling, 1.0, -0.1), ContactMode::stick);
  EXPECT_FALSE(falling.changed_modes());
  EXPECT_EQ(solve(falling, 1.0, 0.1), ContactMode::stick);
  EXPECT_EQ(falling.report().outcome, Outcome::several_solutions);
  EXPECT_FALSE(falling.changed_modes());
  // One that is asked for the first time takes the one with the smallest impulse.
  IslandProblem fresh = cluster({1.0, -0.1, 0.0});
  EXPECT_EQ(solve(fresh, 1.0, 0.1), ContactMode::open);
  EXPECT_EQ(fresh.report().outcome, Outcome::several_solutions);
  // Modes that are no longer a solution are left, and kept again from the other side.
  EXPECT_EQ(solve(falling, 1.0, 0.6), ContactMode::open);
  EXPECT_TRUE(falling.changed_modes());
  EXPECT_EQ(solve(falling, 1.0, 0.1), ContactMode::open);
  EXPECT_EQ(solve(falling, 1.0, -0.1), ContactMode::stick);
  // The problem before build() is forgotten.
  EXPECT_EQ(solve(falling, 1.0, 0.1), ContactMode::stick);
  const std::array<double, 3> before{1.0, -0.1, 0.0};
  falling.build(contacts_, before.data());
  MassResponse masses(assembly_);
  falling.respond(masses);
  EXPECT_EQ(solve(falling, 1.0, 0.1), ContactMode::open);
}

class IslandProblemWithRestitution : public IslandProblemTest {
protected:
  IslandProblemWithRestitution()
      : IslandProblemTest({.friction = 2.0, .normal_restitution = 0.5, .tangential_restitution = 0.25}) {}
};

TEST_F(IslandProblemWithRestitution, StandsInTheVector) {
  IslandProblem one = cluster({0.4, -2.0, 0.0});
  (void)solve(one, 0.3, -2.1);
  EXPECT_DOUBLE_EQ(one.problem().vector()[0], -2.1 + 0.5 * -2.0);
  EXPECT_DOUBLE_EQ(one.problem().vector()[1], 0.3 + 0.25 * 0.4);
}

// Who bounds a tangential row, and whether there is one, is data of the constraints.
TEST_F(IslandProblemTest, RowsHaveTheSetsThatTheirConstraintsSay) {
  ASSERT_EQ(contacts_.size(), 1U);
  SingleConstraint limit = row_along_x(0, 3), attached = limit, in_joint = limit;
  attached.normals = in_joint.normals = 0;
  attached.attached = 1;
  in_joint.of_joint.friction_bound = 4.0;
  ConstraintSet all;
  all.add(limit);
  all.add(contacts_[0]);
  all.add(attached);
  all.add(in_joint);
  const std::array<double, 3> before{};
  IslandProblem made;
  made.build(all, before.data());
  const auto set_of_row = [&](std::size_t c, int row) -> const RowSet& {
    return made.problem().sets()[static_cast<std::size_t>(made.first_row(c) + row)];
  };
  EXPECT_EQ(set_of_row(0, 0).kind, SetKind::half_line);
  EXPECT_EQ(set_of_row(1, 0).kind, SetKind::half_line);
  EXPECT_EQ(set_of_row(1, 1).kind, SetKind::bounded_interval);
  EXPECT_EQ(set_of_row(1, 1).bound, made.first_row(1));
  EXPECT_EQ(set_of_row(2, 0).kind, SetKind::bounded_interval);
  EXPECT_EQ(set_of_row(2, 0).bound, made.first_row(1)) << "the normal of the contact before it";
  EXPECT_EQ(set_of_row(3, 0).kind, SetKind::interval);
  EXPECT_EQ(set_of_row(3, 0).lower, -2.0);
  EXPECT_EQ(set_of_row(3, 0).upper, 2.0);
  made.slide(0, TangentDirection::of_sign(1.0));
  EXPECT_EQ(set_of_row(0, 0).kind, SetKind::half_line) << "a limit has no tangent to slide along";
  all[3].of_joint.friction_bound = 6.0;
  for (std::size_t c = 0; c < all.size(); ++c) made.update_bound(c);
  EXPECT_EQ(set_of_row(3, 0).upper, 3.0);
  EXPECT_EQ(set_of_row(2, 0).bound, made.first_row(1)) << "no given bound";
  made.slide(3, TangentDirection::of_sign(1.0));
  EXPECT_EQ(set_of_row(3, 0).lower, -3.0);
  EXPECT_EQ(set_of_row(3, 0).upper, -3.0);
}

}  // namespace
