#include <carom/core/space.h>

#include "tests/random.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <array>
#include <cmath>
#include <limits>

namespace {

using namespace carom;
constexpr double epsilon = std::numeric_limits<double>::epsilon();

TEST(PlanarSpace, RotationTurnsCounterClockwise) {
  const double quarter = std::acos(0.0);
  std::array<double, 2> rotation{};
  Space<2>::rotation(&quarter, rotation.data());
  const Vec<2> turned = Space<2>::rotate(rotation.data(), {2.0, 1.0});
  EXPECT_NEAR(turned[0], -1.0, 4 * epsilon);
  EXPECT_NEAR(turned[1], 2.0, 4 * epsilon);
}

TEST(PlanarSpace, LeverVelocityIsTheRateOfATurningVector) {
  carom_test::Random random(21);
  for (int repeat = 0; repeat < 100; ++repeat) {
    const Vec<2> local = random.vec<2>();
    const double angle = random.uniform(-3.0, 3.0), spin = random.uniform(-2.0, 2.0), step = 1e-5;
    const auto at = [&](double time) {
      const double delta = spin * time;
      double turned = 0.0;
      Space<2>::advance_orientation(&angle, &delta, &turned);
      std::array<double, 2> rotation{};
      Space<2>::rotation(&turned, rotation.data());
      return Space<2>::rotate(rotation.data(), local);
    };
    const Vec<2> rate = (at(step) - at(-step)) / (2.0 * step);
    // Central difference: step^2 spin^3 |r| / 6 and rounding epsilon |r| / step.
    EXPECT_LE((rate - Space<2>::lever_velocity(&spin, at(0.0))).norm(), 1e-9);
  }
}

TEST(PlanarSpace, TorqueAndSpinRowAreAdjointToLeverVelocity) {
  carom_test::Random random(22);
  for (int repeat = 0; repeat < 100; ++repeat) {
    const Vec<2> lever = random.vec<2>(), force = random.vec<2>();
    const double spin = random.uniform(-2.0, 2.0);
    const double power = force.dot(Space<2>::lever_velocity(&spin, lever));
    double torque = 0.0;
    Space<2>::add_torque(lever, force, &torque);
    EXPECT_NEAR(torque * spin, power, 16 * epsilon);
    double row = 0.0;
    Space<2>::spin_row(force, lever, &row);
    EXPECT_NEAR(row * spin, power, 16 * epsilon);
  }
}

TEST(PlanarSpace, TorqueIsAdded) {
  double torque = 5.0;
  Space<2>::add_torque({2.0, 0.0}, {0.0, 3.0}, &torque);
  EXPECT_EQ(torque, 11.0);
}

TEST(PlanarSpace, TangentIsTheNormalTurnedClockwise) {
  EXPECT_EQ(Space<2>::tangent_frame({0.0, 1.0})[0], Vec<2>(1.0, 0.0));
  EXPECT_EQ(Space<2>::tangent_frame({1.0, 0.0})[0], Vec<2>(0.0, -1.0));
}

void expect_right_handed(const Vec<3>& n) {
  const std::array<Vec<3>, 2> t = Space<3>::tangent_frame(n);
  const double round = 8 * epsilon;
  EXPECT_NEAR(t[0].norm(), 1.0, round);
  EXPECT_NEAR(t[1].norm(), 1.0, round);
  EXPECT_NEAR(t[0].dot(n), 0.0, round);
  EXPECT_LE((Vec<3>(t[0].cross(t[1])) - n).norm(), round);
}

TEST(SpatialSpace, TangentsAndNormalAreARightHandedFrame) {
  carom_test::Random random(23);
  for (int repeat = 0; repeat < 1000; ++repeat) expect_right_handed(random.vec<3>().normalized());
  for (int axis = 0; axis < 3; ++axis) {
    expect_right_handed(Vec<3>::Unit(axis));
    expect_right_handed(-Vec<3>::Unit(axis));
  }
  expect_right_handed(Vec<3>::Ones().normalized());
}

}  // namespace
