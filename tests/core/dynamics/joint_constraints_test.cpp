#include <carom/core/dynamics/joint_constraints.h>
#include <carom/core/numerics/sparse_factors.h>
#include <carom/joints/driver.h>
#include <carom/joints/revolute.h>
#include <carom/joints/rod.h>

#include "tests/core/dynamics/random_mechanism.h"
#include "tests/joints/joint_model.h"

#include <carom/bodies/particle.h>
#include <carom/bodies/rigid_body.h>

#include <Eigen/Core>
#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using namespace carom_test;
using namespace random_mechanism;

/// Rows as a matrix.
Eigen::MatrixXd matrix_of(const JointConstraints& joints, std::size_t columns) {
  Eigen::MatrixXd matrix =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(joints.size()), static_cast<Eigen::Index>(columns));
  std::vector<double> unit(columns, 0.0);
  for (std::size_t c = 0; c < columns; ++c) {
    unit[c] = 1.0;
    for (std::size_t r = 0; r < joints.size(); ++r) {
      matrix(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c)) = joints.row(r).times(unit.data());
    }
    unit[c] = 0.0;
  }
  return matrix;
}

TEST(JointConstraints, OfNoComponentAndWithoutJointsAreEmpty) {
  JointConstraints nothing;
  EXPECT_TRUE(nothing.empty());
  double x = 1.0;
  nothing.project(JointLevel::velocity, &x);
  EXPECT_EQ(x, 1.0);
  System system;
  system.add(Particle{.mass = 1.0});
  const JointModel model(system);
  JointConstraints joints(model.assembly, 0);
  EXPECT_TRUE(joints.empty());
  EXPECT_FALSE(model.assembly.has_joints(0));
  joints.update_and_factor(model.view());
  joints.project(JointLevel::velocity, &x);
  EXPECT_EQ(x, 1.0);
}

TEST(JointConstraints, HoldMakesNumbersObeyAtEveryLevel) {
  Random random(411);
  for (int repeat = 0; repeat < 50; ++repeat) {
    JointModel model(random_scene(random));
    model.state.time = random.uniform(0.0, 3.0);
    for (double& q : model.state.q) q += random.uniform(-0.2, 0.2);
    model.update();
    ASSERT_GE(model.assembly.components().size(), 2u);
    for (Index component = 0; component < model.assembly.components().size(); ++component) {
      JointConstraints joints(model.assembly, component);
      EXPECT_EQ(joints.empty(), !model.assembly.has_joints(component));
      joints.update_and_factor(model.view());
      for (const JointLevel level : levels) {
        const std::vector<double> before = random_numbers(model.state.v.size(), random);
        std::vector<double> x = before, multipliers(joints.size());
        joints.project(level, x.data(), multipliers.data());
        EXPECT_LE(largest_residual(joints, level, x), 1e-12) << static_cast<int>(level);
        // Other components are left alone.
        const Range v = model.assembly.components()[component].v;
        for (Index i = 0; i < x.size(); ++i) {
          if (i < v.begin || i >= v.end) {
            EXPECT_EQ(x[i], before[i]);
          }
        }
        // The change is the response to the multipliers.
        std::vector<double> again = before;
        joints.add_response(multipliers.data(), again.data());
        EXPECT_EQ(again, x);
        // Numbers that obey are not changed any more.
        std::vector<double> twice = x;
        joints.project(level, twice.data());
        for (std::size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(twice[i], x[i], 1e-11);
      }
    }
  }
}

TEST(JointConstraints, HoldChangesByTheLeastInTheSenseOfTheMasses) {
  // M (x' - x) is a combination of rows: no other change that obeys is smaller.
  Random random(412);
  for (int repeat = 0; repeat < 20; ++repeat) {
    JointModel model(random_scene(random));
    JointConstraints joints(model.assembly, 0);
    joints.update_and_factor(model.view());
    const Range v = model.assembly.components()[0].v;
    const auto size = static_cast<Eigen::Index>(model.state.v.size());
    std::vector<double> inverse(model.state.v.size(), 0.0);
    std::fill(inverse.begin() + v.begin, inverse.begin() + v.end, 1.0);
    joints.apply_inverse_mass(inverse.data());
    const Eigen::MatrixXd rows = matrix_of(joints, model.state.v.size());
    for (const JointLevel level : levels) {
      const std::vector<double> before = random_numbers(model.state.v.size(), random);
      std::vector<double> x = before;
      joints.project(level, x.data());
      Eigen::VectorXd right(static_cast<Eigen::Index>(joints.size()));
      for (std::size_t r = 0; r < joints.size(); ++r) {
        right[static_cast<Eigen::Index>(r)] = -residual(level, joints.row(r), before.data());
      }
      // With numbers weighed by the roots of the masses it is the least solution of G x = right.
      const Eigen::VectorXd root = Eigen::Map<const Eigen::VectorXd>(inverse.data(), size).cwiseSqrt();
      const Eigen::VectorXd least =
          root.asDiagonal() *
          Eigen::VectorXd((rows * root.asDiagonal()).completeOrthogonalDecomposition().solve(right));
      for (Index i = v.begin; i < v.end; ++i) EXPECT_NEAR(x[i] - before[i], least[i], 1e-10) << i;
    }
  }
}

TEST(JointConstraints, MassesAreThoseOfTheBodies) {
  System system;
  const BodyId plate = system.add(RigidBody{.mass = disc(2.0, 2.0)});
  const BodyId dot = system.add(Particle{.mass = 0.5, .position = {1, 0}});
  system.add(Rod{.from = plate, .to = dot});
  const JointModel model(system);
  const JointConstraints joints(model.assembly, 0);
  std::vector<double> x(5, 1.0);
  joints.apply_inverse_mass(x.data());
  const Layout& layout = *model.assembly.layout();
  EXPECT_EQ(x[layout.slot(plate).v], 0.5);
  EXPECT_EQ(x[layout.slot(plate).v + 2], 0.25);
  EXPECT_EQ(x[layout.slot(dot).v + 1], 2.0);
}

TEST(JointConstraints, TheSmallestChangeOfTwoParticlesOnARod) {
  // Together they go on with the velocity of their centre of mass along the rod.
  System system;
  const BodyId a = system.add(Particle{.mass = 1.0});
  const BodyId b = system.add(Particle{.mass = 3.0, .position = {2, 0}});
  system.add(Rod{.from = a, .to = b});
  const JointModel model(system);
  JointConstraints joints(model.assembly, 0);
  joints.update_and_factor(model.view());
  std::vector<double> v{8.0, 1.0, 0.0, 2.0};
  double impulse = 0.0;
  joints.project(JointLevel::velocity, v.data(), &impulse);
  EXPECT_NEAR(v[0], 2.0, 1e-14);
  EXPECT_NEAR(v[2], 2.0, 1e-14);
  EXPECT_EQ(v[1], 1.0);
  EXPECT_EQ(v[3], 2.0);
  EXPECT_NEAR(impulse, 6.0, 1e-13);  // on the second, away from the first
}

TEST(JointConstraints, ManyJointsOnOneBody) {
  // A hub with spokes to particles, some of them joined with each other.
  System system;
  const BodyId hub = system.add(RigidBody{.mass = disc(1.0, 1.0), .velocity = {1, 2}, .spin = 3.0});
  std::vector<BodyId> dots;
  for (int i = 0; i < 12; ++i) {
    const double angle = i * std::acos(-1.0) / 6.0;
    const Vec<2> direction(std::cos(angle), std::sin(angle));
    dots.push_back(system.add(Particle{.mass = 0.5, .position = Vec<2>(2.0 * direction)}));
    system.add(Rod{.from = {hub, direction}, .to = dots.back()});
    if (i % 3 == 2) system.add(Rod{.from = dots[static_cast<std::size_t>(i - 1)], .to = dots.back()});
  }
  const JointModel model(system);
  ASSERT_EQ(model.assembly.components().size(), 1u);
  JointConstraints joints(model.assembly, 0);
  joints.update_and_factor(model.view());
  EXPECT_EQ(joints.size(), 16u);
  Random random(414);
  for (const JointLevel level : levels) {
    std::vector<double> x = random_numbers(model.state.v.size(), random);
    joints.project(level, x.data());
    EXPECT_LE(largest_residual(joints, level, x), 1e-13);
  }
}

TEST(JointConstraints, RowsKnowTheirJoint) {
  System system;
  const BodyId a = system.add(RigidBody{.mass = disc(1.0, 1.0)});
  const BodyId b = system.add(RigidBody{.mass = disc(1.0, 1.0), .position = {2, 0}});
  const BodyId c = system.add(RigidBody{.mass = disc(1.0, 1.0), .position = {4, 0}});
  const JointId link = system.add(Rod{.from = b, .to = a});
  const JointId alone = system.add(Weld{.from = ground, .to = c});
  const JointId pin = system.add(Revolute{.from = ground, .to = a});
  const JointId drive = system.add(Driver{.joint = pin, .position = [](double) { return 0.0; }});
  const JointModel model(system);
  const JointConstraints first(model.assembly, 0), second(model.assembly, 1);
  ASSERT_EQ(first.size(), 4u);
  EXPECT_EQ(first.joint(0), link);
  EXPECT_EQ(first.joint(1), pin);
  EXPECT_EQ(first.joint(2), pin);
  EXPECT_EQ(first.joint(3), drive);
  ASSERT_EQ(first.pattern().size(), 3u);
  const std::vector<Index> first_rows{0, 1, 3, 4};
  for (std::size_t i = 0; i < first_rows.size(); ++i) EXPECT_EQ(first.pattern().first_row(i), first_rows[i]);
  EXPECT_TRUE(first.depends_on_time());
  ASSERT_EQ(second.size(), 3u);
  EXPECT_EQ(second.joint(2), alone);
  EXPECT_FALSE(second.depends_on_time());
}

TEST(JointConstraints, SolveIsWhatHoldUses) {
  Random random(415);
  JointModel model(random_scene(random));
  JointConstraints joints(model.assembly, 0);
  joints.update_and_factor(model.view());
  const std::vector<double> right = random_numbers(joints.size(), random);
  std::vector<double> multipliers = right, x(model.state.v.size(), 0.0);
  joints.solve(multipliers.data());
  joints.add_response(multipliers.data(), x.data());
  for (std::size_t r = 0; r < joints.size(); ++r) {
    EXPECT_NEAR(joints.row(r).times(x.data()), -right[r], 1e-11);
  }
}

TEST(JointConstraints, AllRowsAtOnceAreTheRowsOneByOne) {
  Random random(417);
  for (int repeat = 0; repeat < 20; ++repeat) {
    const JointModel model(random_scene(random));
    for (Index component = 0; component < model.assembly.components().size(); ++component) {
      JointConstraints joints(model.assembly, component);
      joints.update(model.view());
      const std::vector<double> x = random_numbers(model.state.v.size(), random);
      const std::vector<double> multipliers = random_numbers(joints.size(), random);
      std::vector<double> found(joints.size()), load(x.size(), 0.0), expected(x.size(), 0.0);
      for (const JointLevel level : levels) {
        joints.residuals(level, x.data(), found.data());
        for (std::size_t r = 0; r < found.size(); ++r) {
          EXPECT_NEAR(found[r], residual(level, joints.row(r), x.data()), 1e-13);
        }
      }
      joints.add_transposed(multipliers.data(), load.data());
      for (std::size_t r = 0; r < found.size(); ++r) {
        joints.row(r).add_transposed(multipliers[r], expected.data());
        EXPECT_EQ(joints.row(r).gap, joints.gaps()[r]);
        EXPECT_EQ(joints.row(r).rate, joints.rate(r));
      }
      for (std::size_t i = 0; i < load.size(); ++i) EXPECT_NEAR(load[i], expected[i], 1e-13) << i;
    }
  }
}

TEST(JointConstraints, GapsAloneGoToAConfiguration) {
  Random random(418);
  JointModel model(random_scene(random));
  JointConstraints joints(model.assembly, 0), fresh(model.assembly, 0);
  joints.update_and_factor(model.view());
  const JointConstraints before = joints;
  for (double& number : model.state.q) number += random.uniform(-0.5, 0.5);
  model.update();
  joints.update_gaps(model.view());
  fresh.update_and_factor(model.view());
  std::vector<double> x = random_numbers(model.state.v.size(), random), y = x;
  JointConstraints held = before;
  held.project(JointLevel::change, x.data());
  joints.project(JointLevel::change, y.data());
  EXPECT_EQ(x, y);
  for (std::size_t r = 0; r < joints.size(); ++r) {
    EXPECT_EQ(joints.gaps()[r], fresh.gaps()[r]);
    EXPECT_NE(joints.gaps()[r], before.gaps()[r]);
    EXPECT_EQ(joints.row(r).drift, before.row(r).drift);
  }
}

TEST(JointConstraints, AnOldConfigurationIsForgotten) {
  Random random(416);
  JointModel model(random_scene(random));
  JointConstraints joints(model.assembly, 0), fresh(model.assembly, 0);
  const std::vector<double> q = model.state.q;
  for (int repeat = 0; repeat < 5; ++repeat) {
    for (double& number : model.state.q) number += random.uniform(-0.5, 0.5);
    model.update();
    joints.update_and_factor(model.view());
  }
  model.state.q = q;
  model.update();
  joints.update_and_factor(model.view());
  fresh.update_and_factor(model.view());
  std::vector<double> x = random_numbers(q.size(), random), y = x;
  joints.project(JointLevel::acceleration, x.data());
  fresh.project(JointLevel::acceleration, y.data());
  EXPECT_EQ(x, y);
  for (std::size_t r = 0; r < joints.size(); ++r) EXPECT_EQ(joints.gaps()[r], fresh.gaps()[r]);
}

}  // namespace
