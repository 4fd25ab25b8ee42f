// W = H B H^T against dense algebra, for constraints of one to three bodies and every response; the way back;
// contacts between two bodies against the closed form of an impact.

#include "tests/random.h"

#include <carom/carom.h>
#include <carom/contact/contact_velocity.h>
#include <carom/contact/island_problem.h>
#include <carom/core/assembly.h>
#include <carom/core/constraint_set.h>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::Random;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int body_count = 5;

/// Five bodies, a particle among them; if `jointed`, two pins bind 0, 1 and 2.
System bodies(bool jointed) {
  System system;
  std::vector<BodyId> all;
  for (int i = 0; i < body_count; ++i) {
    const Vec<2> place(1.0 * i, 0.3 * i * i);
    all.push_back(i == 3 ? system.add(Particle{.mass = 0.7, .position = place})
                         : system.add(RigidBody{.mass = {.mass = 1.0 + i, .inertia = 0.2 + 0.1 * i},
                                                .position = place}));
  }
  if (jointed) {
    system.add(Revolute{.from = {all[0], {0.5, 0.1}}, .to = {all[1], {-0.5, -0.2}}});
    system.add(Revolute{.from = {all[1], {0.4, 0.3}}, .to = {all[2], {-0.6, -0.6}}});
    system.add(SpringDamper{.from = all[2], .to = all[3], .stiffness = 30.0});
    system.add(SpringDamper{.from = all[3], .to = all[4], .stiffness = 40.0});
  }
  return system;
}

/// Five bodies, of which springs couple 0 and 2, 3 and 4.
System two_pairs() {
  System system = bodies(false);
  const std::vector<BodyId> all = system.bodies();
  system.add(SpringDamper{.from = all[0], .to = {all[2], {0.1, 0.2}}, .stiffness = 3e3, .damping = 20.0});
  system.add(SpringDamper{.from = all[3], .to = {all[4], {0.2, -0.1}}, .stiffness = 4e3});
  return system;
}

class Bodies : public testing::Test {
protected:
  explicit Bodies(bool jointed) : Bodies(bodies(jointed)) {}
  explicit Bodies(const System& system) : assembly_(system), state_(assembly_.initial_state()) {
    evaluation_ = make_evaluation(assembly_);
    for (Index c = 0; c < assembly_.components().size(); ++c) {
      evaluate_positions(assembly_, c, state_.view(), evaluation_);
    }
  }
  [[nodiscard]] Eigen::Index size() const { return static_cast<Eigen::Index>(state_.v.size()); }
  /// Constraints of one to three random bodies with random rows.
  ConstraintSet constraints(Random& random, int count) {
    ConstraintSet made;
    for (int i = 0; i < count; ++i) {
      Constraint& one = made.add();
      std::vector<Index> free(body_count);
      for (Index b = 0; b < body_count; ++b) free[b] = b;
      for (int b = 0; b < 1 + (i + 1) % 3; ++b) {
        const auto at =
            static_cast<std::size_t>(random.uniform(0.0, 0.999) * static_cast<double>(free.size()));
        const BodySlot& slot = assembly_.layout()->bodies()[free[at]];
        one.add_body(free[at], slot.v, static_cast<int>(slot.v_size));
        free.erase(free.begin() + static_cast<std::ptrdiff_t>(at));
      }
      one.start_rows(1 + i % 3);
      for (int row = 0; row < one.rows; ++row) {
        for (int c = 0; c < one.columns(); ++c) one.row(row)[c] = random.uniform(-1.0, 1.0);
      }
    }
    return made;
  }
  MatrixXd rows(const std::vector<ImpulseDirection>& directions) const {
    MatrixXd h = MatrixXd::Zero(static_cast<Eigen::Index>(directions.size()), size());
    for (std::size_t i = 0; i < directions.size(); ++i) {
      VectorXd row = VectorXd::Zero(size());
      directions[i].constraint->add_transposed(directions[i].row, 1.0, row.data());
      h.row(static_cast<Eigen::Index>(i)) = row.transpose();
    }
    return h;
  }
  MatrixXd inverse_masses() const {
    VectorXd inverse = VectorXd::Ones(size());
    for (const BodySlot& slot : assembly_.layout()->bodies()) {
      assembly_.body_kinds()[slot.kind]->apply_inverse_mass({slot.slot, slot.slot + 1},
                                                            inverse.data() + slot.v, inverse.data() + slot.v);
    }
    return inverse.asDiagonal();
  }
  /// W, its lower triangle mirrored, and the response to random impulses, against H B H^T.
  void expect_product(BodyResponse& response, const MatrixXd& b, double tolerance) {
    Random random(7);
    const ConstraintSet list = constraints(random, 9);
    std::vector<ImpulseDirection> directions;
    for (const Constraint& one : list) {
      for (int row = 0; row < one.rows; ++row) directions.push_back({&one, row});
    }
    Delassus delassus;
    delassus.build(directions, response);
    const auto n = static_cast<Eigen::Index>(delassus.size());
    MatrixXd w(n, n);
    delassus.write_symmetric(w.data());
    const MatrixXd h = rows(directions), expected = h * b * h.transpose();
    EXPECT_LE((w - expected).cwiseAbs().maxCoeff(), tolerance * expected.cwiseAbs().maxCoeff());
    VectorXd p(n), v = VectorXd::Zero(size());
    for (double& impulse : p) impulse = random.uniform(-1.0, 1.0);
    delassus.add_response({p.data(), static_cast<std::size_t>(n)}, v.data(), 2.0);
    const VectorXd change = 2.0 * b * h.transpose() * p;
    EXPECT_LE((v - change).cwiseAbs().maxCoeff(), tolerance * change.cwiseAbs().maxCoeff());
  }

  Assembly assembly_;
  State state_;
  Evaluation evaluation_;
};

class DelassusTest : public Bodies, public testing::WithParamInterface<bool> {
protected:
  DelassusTest() : Bodies(GetParam()) {}
};

class DelassusOfAMechanism : public Bodies {
protected:
  DelassusOfAMechanism() : Bodies(true) {}
};

class DelassusOfComponents : public Bodies {
protected:
  DelassusOfComponents() : Bodies(two_pairs()) {}
};

// Sums of up to nine products: rounding.
constexpr double rounding = 1e-14;

TEST_P(DelassusTest, MassesAlone) {
  MassResponse response(assembly_);
  expect_product(response, inverse_masses(), rounding);
}

// Of bodies of one kind and of several; the places of masses follow from the first body's, or not.
TEST(MassResponseTest, BodiesHaveTheMassesOfTheirKind) {
  System of_one_kind;
  for (int i = 0; i < body_count; ++i)
    of_one_kind.add(RigidBody{.mass = {.mass = 1.0 + i, .inertia = 0.2 + 0.1 * i}});
  System particles;
  for (int i = 0; i < body_count; ++i) particles.add(Particle{.mass = 1.0 + i % 2});
  for (const System& system : {of_one_kind, particles, bodies(false), bodies(true)}) {
    const Assembly assembly(system);
    const MassResponse response(assembly);
    for (Index body = 0; body < body_count; ++body) {
      const BodySlot slot = assembly.layout()->bodies()[body];
      const BodyKind& kind = *assembly.body_kinds()[slot.kind];
      const BodyMasses found = response.alone(body), own = kind.masses(slot.slot);
      EXPECT_EQ(found.layout, own.layout);
      EXPECT_EQ(found.mass, own.mass);
      EXPECT_EQ(found.inertia, own.inertia);
      EXPECT_EQ(found.gyration_radius, own.gyration_radius);
      EXPECT_EQ(*found.mass, kind.mass(slot.slot));
    }
  }
}

/// Numbers by their bits: -0 is not 0.
std::array<std::uint64_t, 2> bits(const std::array<double, 2>& numbers) {
  return std::bit_cast<std::array<std::uint64_t, 2>>(numbers);
}

TEST(ContactVelocity, BothRowsOfABodyOnGroundHaveTheBitsOfEach) {
  Random random(8);
  for (const int columns : {2, 3}) {
    SingleConstraint contact;
    contact.add_body(4, 7, columns);
    contact.start_rows(2);
    std::vector<double> v(20);
    for (int i = 0; i < 100; ++i) {
      // Zeros of both signs among them.
      const auto number = [&] { return i % 3 == 0 ? (i % 2 == 0 ? -0.0 : 0.0) : random.uniform(-1.0, 1.0); };
      for (int row = 0; row < 2; ++row) {
        for (int c = 0; c < columns; ++c) contact.row(row)[c] = random.uniform(-1.0, 1.0);
      }
      for (double& of : v) of = number();
      const std::array<double, 2> each{contact.times(0, v.data()), contact.times(1, v.data())};
      EXPECT_EQ(bits(times_both_rows(contact, v.data())), bits(each));
    }
  }
}

TEST_F(DelassusOfAMechanism, WithJoints) {
  ASSERT_EQ(assembly_.components().size(), 1u);
  JointConstraints joints(assembly_, 0);
  joints.update_and_factor({state_.view(), evaluation_.rotation.data()});
  MatrixXd g(static_cast<Eigen::Index>(joints.size()), size());
  for (std::size_t row = 0; row < joints.size(); ++row) {
    VectorXd of_row = VectorXd::Zero(size());
    joints.row(row).add_transposed(1.0, of_row.data());
    g.row(static_cast<Eigen::Index>(row)) = of_row.transpose();
  }
  const MatrixXd inverse = inverse_masses();
  const MatrixXd k =
      inverse - inverse * g.transpose() * (g * inverse * g.transpose()).inverse() * g * inverse;
  JointResponse response(joints);
  expect_product(response, k, 1e-12);  // the factors of G M^-1 G^T, of condition 1e2
}

TEST_F(DelassusOfAMechanism, OfALinearisedStep) {
  ImplicitSolver step;
  ASSERT_EQ(step.factor(assembly_, 0, state_.view(), evaluation_, 0.01, nullptr),
            ImplicitSolver::Outcome::definite);
  MatrixXd inverse = MatrixXd::Identity(size(), size());
  for (Eigen::Index column = 0; column < size(); ++column) step.solve(inverse.col(column).data());
  const LinearisedComponent component{&step, assembly_.components()[0].v};
  LinearisedResponse response(assembly_, {&component, 1});
  expect_product(response, inverse, 1e-13);
}

TEST_F(DelassusOfComponents, OfTheirLinearisedSteps) {
  const auto count = static_cast<Index>(assembly_.components().size());
  ASSERT_EQ(count, 3u);
  std::vector<ImplicitSolver> steps(count);
  std::vector<LinearisedComponent> components;
  MatrixXd inverse = MatrixXd::Zero(size(), size());
  for (Index c = 0; c < count; ++c) {
    ASSERT_EQ(steps[c].factor(assembly_, c, state_.view(), evaluation_, 0.01, nullptr),
              ImplicitSolver::Outcome::definite);
    const Range v = assembly_.components()[c].v;
    components.push_back({&steps[c], v});
    for (Index i = v.begin; i < v.end; ++i) {
      VectorXd column = VectorXd::Unit(v.size(), i - v.begin);
      steps[c].solve(column.data());
      inverse.block(v.begin, i, v.size(), 1) = column;
    }
  }
  LinearisedResponse response(assembly_, components);
  expect_product(response, inverse, 1e-13);
}

/// Friction at the edge of its cone, in the plane and in space: columns differ from rows.
TEST_P(DelassusTest, ColumnsOfSlippingContacts) {
  Random random(3);
  ConstraintSet list = constraints(random, 6);
  std::vector<ImpulseDirection> directions;
  for (Constraint& one : list) {
    const std::vector<double> normal(one.row(0), one.row(1));
    one.start_rows(2 + static_cast<int>(directions.size() % 2));
    std::copy(normal.begin(), normal.end(), one.row(0));
    TangentDirection::Numbers ratios{};
    for_tangents(one, [&](std::size_t k, int row) {
      for (int c = 0; c < one.columns(); ++c) one.row(row)[c] = random.uniform(-1.0, 1.0);
      ratios[k] = random.uniform(-0.9, 0.9);
    });
    directions.push_back({&one, 0, ratios});
  }
  MassResponse response(assembly_);
  Delassus delassus;
  delassus.build(directions, response);
  const auto n = static_cast<Eigen::Index>(delassus.size());
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> w(n, n);
  delassus.write(w.data());
  MatrixXd columns = rows(directions).transpose();
  for (std::size_t j = 0; j < directions.size(); ++j) {
    const Constraint& at = *directions[j].constraint;
    double* const column = columns.col(static_cast<Eigen::Index>(j)).data();
    for_tangents(at,
                 [&](std::size_t k, int row) { at.add_transposed(row, directions[j].ratios[k], column); });
  }
  const MatrixXd expected = rows(directions) * inverse_masses() * columns;
  EXPECT_LE((w - expected).cwiseAbs().maxCoeff(), rounding * expected.cwiseAbs().maxCoeff());
}

INSTANTIATE_TEST_SUITE_P(WithAndWithoutJoints, DelassusTest, testing::Bool());

/// Two bodies without spin meet along x: v' = v_m -+ e (v_a - v_b) m_other / (m_a + m_b).
TEST(Delassus, ContactOfTwoBodies) {
  System system;
  const double ma = 2.0, mb = 3.0, e = 0.6, mu = 0.3;
  system.add(RigidBody{.mass = {.mass = ma, .inertia = 1.0}});
  system.add(RigidBody{.mass = {.mass = mb, .inertia = 1.0}, .position = {1.0, 0.0}});
  const Assembly assembly(system);
  SingleConstraint contact;
  contact.add_body(0, 0, 3);
  contact.add_body(1, 3, 3);
  contact.start_rows(2);
  contact.law = {.friction = mu, .normal_restitution = e};
  contact.friction = mu;
  // Normal from the second towards the first, tangent: the normal turned clockwise; at the middle, (0.5, 0).
  const std::vector<double> normal{-1.0, 0.0, 0.0, 1.0, 0.0, 0.0}, tangent{0.0, 1.0, 0.5, 0.0, -1.0, 0.5};
  std::copy(normal.begin(), normal.end(), contact.row(0));
  std::copy(tangent.begin(), tangent.end(), contact.row(1));
  std::vector<double> v{4.0, 0.1, 0.0, -1.0, 0.0, 0.0};
  const std::vector<double> before = v;
  IslandProblem problem;
  MassResponse masses(assembly);
  SolverChain chain;
  problem.build(contact.alone(), v.data());
  problem.respond(masses);
  problem.set_free_velocity(v.data());
  ASSERT_TRUE(problem.solve(chain).usable());
  problem.map().add_velocities(v.data());
  const double centre = (ma * before[0] + mb * before[3]) / (ma + mb), speed = before[0] - before[3];
  EXPECT_NEAR(v[0], centre - e * speed * mb / (ma + mb), 1e-14);
  EXPECT_NEAR(v[3], centre + e * speed * ma / (ma + mb), 1e-14);
  EXPECT_NEAR(ma * v[1] + mb * v[4], ma * before[1], 1e-15);  // momentum, to rounding
  // Friction takes sliding away and the impulse acts at one point: angular momentum about it is kept too.
  const double angular = v[2] + v[5] - ma * 0.5 * v[1] + mb * 0.5 * v[4];
  EXPECT_NEAR(angular, -ma * 0.5 * before[1], 1e-15);
  ImpulseWork work;
  for (int row = 0; row < 2; ++row) {
    work.add(problem.map().impulse(0, row), problem.map().before(0, row), contact.velocity(row, v.data()));
  }
  const auto energy = [&](const std::vector<double>& at) {
    return 0.5 * (ma * (at[0] * at[0] + at[1] * at[1]) + mb * (at[3] * at[3] + at[4] * at[4]) +
                  at[2] * at[2] + at[5] * at[5]);
  };
  const double kinetic = energy(v) - energy(before);
  EXPECT_NEAR(work.gain, kinetic, 1e-13);
  EXPECT_FALSE(work.is_gain());
}

/// Dry friction in a joint holds a body as far as its bound goes.
TEST(Delassus, FrictionBound) {
  System system;
  system.add(Particle{.mass = 2.0});
  const Assembly assembly(system);
  SingleConstraint friction;
  friction.normals = 0;
  friction.add_body(0, 0, 2);
  friction.start_rows(1);
  friction.row(0)[0] = 1.0;
  friction.row(0)[1] = 0.0;
  friction.friction = 1.0;
  friction.of_joint.friction_bound = 3.0;
  MassResponse masses(assembly);
  SolverChain chain;
  IslandProblem problem;
  for (const double speed : {1.0, -1.4, 5.0, -4.0}) {
    const std::vector<double> v{speed, 0.0};
    problem.build(friction.alone(), v.data());
    problem.respond(masses);
    problem.set_free_velocity(v.data());
    ASSERT_TRUE(problem.solve(chain).usable());
    EXPECT_DOUBLE_EQ(problem.impulses()[0], std::clamp(-2.0 * speed, -3.0, 3.0));
  }
}

}  // namespace
