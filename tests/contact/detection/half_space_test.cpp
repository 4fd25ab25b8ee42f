#include <carom/contact/detection/half_space.h>
#include <carom/core/system.h>

#include "tests/model_error.h"
#include "tests/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <type_traits>

namespace {

using namespace carom;

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

template <class D>
class HalfSpaceTest : public testing::Test {
protected:
  static constexpr int dimension = D::value;
  using Obstacle = generic::HalfSpace<dimension>;
  static Vec<dimension> normal(const Gap& gap) { return Vec<dimension>(gap.normal.data()); }
};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(HalfSpaceTest, Dimensions);

TYPED_TEST(HalfSpaceTest, GapIsTheDistanceAlongTheNormal) {
  constexpr int D = TestFixture::dimension;
  carom_test::Random random(131);
  for (int repeat = 0; repeat < 200; ++repeat) {
    System system;
    const Vec<D> p = random.vec<D>(), n = random.vec<D>(), unit = n.normalized();
    system.add(typename TestFixture::Obstacle{.point = p, .normal = n});
    const GroundShapeKind& kind = *system.ground_shape_kinds().entries()[0].kind;
    Vec<D> along = random.vec<D>();
    along -= along.dot(unit) * unit;
    const double height = random.uniform(-2.0, 2.0);
    const Vec<D> x = p + along + height * unit;
    const Gap gap = kind.gap(0, x.data());
    EXPECT_NEAR(gap.distance, height, 32 * epsilon);
    EXPECT_LE((TestFixture::normal(gap) - unit).norm(), 4 * epsilon);
    if (D == 2) {
      EXPECT_EQ(gap.normal[2], 0.0);
    }
  }
}

TYPED_TEST(HalfSpaceTest, NormalsOfAnyLengthBecomeUnitVectors) {
  constexpr int D = TestFixture::dimension;
  carom_test::Random random(132);
  for (const double length : {1e-300, 1e-160, 1e-3, 1.0, 1e3, 1e160, 1e300}) {
    for (int repeat = 0; repeat < 100; ++repeat) {
      System system;
      system.add(typename TestFixture::Obstacle{.normal = length * random.vec<D>()});
      const Vec<D> origin = Vec<D>::Zero();
      const Gap gap = system.ground_shape_kinds().entries()[0].kind->gap(0, origin.data());
      EXPECT_NEAR(TestFixture::normal(gap).norm(), 1.0, 2 * epsilon);
      EXPECT_EQ(gap.distance, 0.0);
    }
  }
}

TYPED_TEST(HalfSpaceTest, ImpossibleOnesAreRefusedByName) {
  constexpr int D = TestFixture::dimension;
  using Plane = typename TestFixture::Obstacle;
  const std::string label = D == 2 ? "half-plane" : "half-space";
  System system;
  EXPECT_MODEL_ERROR(system.add(Plane{}), label + " #0", "normal is nan", "finite");
  EXPECT_MODEL_ERROR(system.add(Plane{.normal = Vec<D>::Zero()}, "floor"), label + " 'floor'",
                     "normal is zero", "any length > 0");
  for (const double bad : {nan, infinity, -infinity}) {
    for (int i = 0; i < D; ++i) {
      Plane plane{.normal = Vec<D>::Unit(0)};
      plane.point[i] = bad;
      EXPECT_MODEL_ERROR(system.add(plane), label + " #0", "point is " + to_text(bad) + " m", "finite");
      plane = {.normal = Vec<D>::Unit(0)};
      plane.normal[i] = bad;
      EXPECT_MODEL_ERROR(system.add(plane), label + " #0", "normal is " + to_text(bad), "finite");
    }
  }
  System other;
  EXPECT_MODEL_ERROR(system.add(Plane{.normal = Vec<D>::Unit(0), .material = other.material("ice")}),
                     label + " #0", "material is unknown");
  EXPECT_TRUE(system.obstacles().empty());
}

TEST(HalfPlane, ManyAreKeptApart) {
  using namespace planar;
  System system;
  const MaterialId ice = system.material("ice");
  system.add(HalfPlane{.normal = {0, 1}});
  const ObstacleId left = system.add(HalfPlane{.point = {-2, 0}, .normal = {1, 0}, .material = ice});
  system.add(HalfPlane{.point = {5, 0}, .normal = {-1, 0}});
  const GroundShapeKind& kind = *system.ground_shape_kinds().entries()[0].kind;
  EXPECT_EQ(kind.size(), 3U);
  const Vec<2> x(1, 7);
  EXPECT_EQ(kind.gap(0, x.data()).distance, 7.0);
  EXPECT_EQ(kind.gap(1, x.data()).distance, 3.0);
  EXPECT_EQ(kind.gap(2, x.data()).distance, 4.0);
  EXPECT_EQ(kind.material(1), ice);
  system.remove(left);
  EXPECT_EQ(system.ground_shape_kinds().entries()[0].kind->gap(1, x.data()).distance, 4.0);
}

TEST(Incline, RisesWithXAtItsSlope) {
  using planar::incline;
  EXPECT_EQ(incline(0.0), Vec<2>(0, 1));
  for (const double slope : {-1.2, 0.1, 0.7}) {
    const Vec<2> n = incline(slope), uphill(std::cos(slope), std::sin(slope));
    EXPECT_NEAR(n.dot(uphill), 0.0, epsilon);
    EXPECT_NEAR(n.norm(), 1.0, 2 * epsilon);
    EXPECT_GT(n[1], 0.0);
  }
}

}  // namespace
