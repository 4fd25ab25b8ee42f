// Constraints of which some follow from others: they change nothing, and carry what is left to them.

#include <carom/core/dynamics/joint_constraints.h>
#include <carom/core/numerics/sparse_factors.h>
#include <carom/joints/revolute.h>
#include <carom/joints/rod.h>

#include "tests/core/dynamics/random_mechanism.h"
#include "tests/joints/joint_model.h"

#include <carom/bodies/rigid_body.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using namespace carom_test;
using namespace random_mechanism;

/// A beam on parallel links of one length.
struct Swing {
  System system;
  BodyId beam;
  explicit Swing(int links, double turn = 0.0, Vec<2> velocity = {0, 0}) {
    beam = system.add(RigidBody{.mass = rod(2.0, 4.0), .velocity = velocity});
    const Vec<2> link(-1.5 * std::sin(turn), 1.5 * std::cos(turn));
    for (int i = 0; i < links; ++i) {
      const Vec<2> end(-2.0 + 4.0 * i / (links - 1), 0.0);
      system.add(Rod{.from = {ground, Vec<2>(end + link)}, .to = {beam, end}});
    }
  }
};

TEST(JointConstraints, AThirdParallelLinkChangesNothing) {
  for (const double turn : {0.0, 0.3, -1.2}) {
    const Vec<2> along(std::cos(turn), std::sin(turn));
    Swing two(2, turn, Vec<2>(0.7 * along)), three(3, turn, Vec<2>(0.7 * along)),
        seven(7, turn, Vec<2>(0.7 * along));
    const JointModel first(two.system);
    JointConstraints expected(first.assembly, 0);
    expected.update_and_factor(first.view());
    for (const Swing* const swing : {&three, &seven}) {
      const JointModel model(swing->system);
      JointConstraints joints(model.assembly, 0);
      joints.update_and_factor(model.view());
      std::size_t left_out = 0;
      for (std::size_t row = 0; row < joints.size(); ++row) {
        if (joints.factors().pivot(row) <= dependent_pivot) ++left_out;
      }
      EXPECT_EQ(left_out, joints.size() - 2);
      for (const JointLevel level : levels) {
        const std::vector<double> before{0.3, -9.81, 0.7};
        std::vector<double> x = before, y = before, multipliers(joints.size());
        joints.project(level, x.data(), multipliers.data());
        expected.project(level, y.data());
        for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(x[i], y[i], 1e-12) << i;
        EXPECT_LE(largest_residual(joints, level, x), 1e-12);
        for (const double multiplier : multipliers) EXPECT_LE(std::abs(multiplier), 100.0);
      }
    }
  }
}

TEST(JointConstraints, OfRedundantLinksOneCarriesNothing) {
  // Three links under a weight in the middle: forces and moments balance, one multiplier is zero.
  Swing swing(3);
  const JointModel model(swing.system);
  JointConstraints joints(model.assembly, 0);
  joints.update_and_factor(model.view());
  std::vector<double> a{0.0, -9.81, 0.0}, multipliers(3);
  joints.project(JointLevel::acceleration, a.data(), multipliers.data());
  EXPECT_NEAR(multipliers[0] + multipliers[1] + multipliers[2], -2.0 * 9.81, 1e-12);
  EXPECT_NEAR(multipliers[0], multipliers[2], 1e-12);
  EXPECT_EQ(std::count(multipliers.begin(), multipliers.end(), 0.0), multipliers[1] == 0.0 ? 1 : 2);
}

TEST(JointConstraints, EveryJointTwiceIsAsEveryJointOnce) {
  Random random(413);
  for (int repeat = 0; repeat < 20; ++repeat) {
    System once;
    BodyId onto = ground;
    std::vector<std::pair<End<2>, End<2>>> ends;
    for (int i = 0; i < 6; ++i) {
      const BodyId body = random_plate(once, random);
      ends.emplace_back(End<2>(onto, random.vec<2>()), End<2>(body, random.vec<2>()));
      onto = body;
    }
    const auto join = [&ends](System& system) {
      for (const auto& [from, to] : ends) system.add(Revolute{.from = from, .to = to});
    };
    join(once);
    System twice = once;
    join(twice);
    const JointModel a(once), b(twice);
    JointConstraints first(a.assembly, 0), second(b.assembly, 0);
    EXPECT_EQ(second.size(), 2 * first.size());
    first.update_and_factor(a.view());
    second.update_and_factor(b.view());
    for (const JointLevel level : levels) {
      std::vector<double> x = random_numbers(a.state.v.size(), random), y = x;
      first.project(level, x.data());
      second.project(level, y.data());
      for (std::size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(x[i], y[i], 1e-11);
    }
  }
}

}  // namespace
