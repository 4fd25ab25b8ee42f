#include <carom/bodies/particle.h>
#include <carom/bodies/rigid_body.h>
#include <carom/bodies/shape_disc.h>
#include <carom/bodies/shape_point.h>
#include <carom/bodies/shape_polygon.h>
#include <carom/bodies/shape_segment.h>
#include <carom/core/system.h>

#include "tests/model_error.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

class ShapeTest : public testing::Test {
protected:
  std::vector<RoundedPoint> features(ShapeId id) const {
    std::vector<RoundedPoint> points;
    system.shape_kinds().kind_of(id.serial).rounded_points(system.shape_kinds().place(id.serial).slot,
                                                           points);
    return points;
  }
  static void expect_point(const RoundedPoint& point, double x, double y, double radius) {
    EXPECT_EQ(point.centre, (std::array<double, 3>{x, y, 0.0}));
    EXPECT_EQ(point.radius, radius);
  }

  System system;
  BodyId body = system.add(RigidBody{.mass = disc(1.0, 1.0)}, "plate");
};

TEST_F(ShapeTest, DiscTouchesWithItsRim) {
  const ShapeId id = system.add(Disc{.body = body, .radius = 0.5, .centre = {1, 2}});
  const auto points = features(id);
  ASSERT_EQ(points.size(), 1U);
  expect_point(points[0], 1, 2, 0.5);
}

TEST_F(ShapeTest, PointTouchesWithItself) {
  const auto points = features(system.add(Point{.body = body, .position = {1, 2}}));
  ASSERT_EQ(points.size(), 1U);
  expect_point(points[0], 1, 2, 0.0);
}

TEST_F(ShapeTest, SegmentTouchesWithItsEnds) {
  const auto points = features(system.add(Segment{.body = body, .from = {1, 2}, .to = {3, 4}}));
  ASSERT_EQ(points.size(), 2U);
  expect_point(points[0], 1, 2, 0.0);
  expect_point(points[1], 3, 4, 0.0);
}

TEST_F(ShapeTest, PolygonTouchesWithItsVerticesInOrder) {
  const auto points = features(system.add(Polygon{.body = body, .vertices = {{0, 0}, {2, 0}, {1, 3}}}));
  ASSERT_EQ(points.size(), 3U);
  expect_point(points[0], 0, 0, 0.0);
  expect_point(points[1], 2, 0, 0.0);
  expect_point(points[2], 1, 3, 0.0);
}

TEST_F(ShapeTest, FeaturesAreAppended) {
  const ShapeId id = system.add(Point{.body = body});
  std::vector<RoundedPoint> points(3);
  system.shape_kinds().kind_of(id.serial).rounded_points(0, points);
  EXPECT_EQ(points.size(), 4U);
}

TEST_F(ShapeTest, KnowsItsBodyAndMaterial) {
  const MaterialId steel = system.material("steel");
  const BodyId second = system.add(RigidBody{.mass = disc(1.0, 1.0)});
  system.add(Disc{.body = body, .radius = 1.0});
  system.add(Disc{.body = second, .radius = 1.0, .material = steel});
  const ShapeKind& kind = *system.shape_kinds().entries()[0].kind;
  EXPECT_EQ(kind.size(), 2U);
  EXPECT_EQ(kind.body(0), body);
  EXPECT_FALSE(kind.material(0).valid());
  EXPECT_EQ(kind.body(1), second);
  EXPECT_EQ(kind.material(1), steel);
  EXPECT_EQ(kind.dimension(), 2);
}

template <class Shape>
void expect_body_and_material_checked(System& system, const Shape& good, const std::string& label) {
  Shape shape = good;
  shape.body = BodyId{};
  EXPECT_MODEL_ERROR(system.add(shape, "s"), label + " 's'", "body is not given", "a body of this system");
  shape.body = ground;
  EXPECT_MODEL_ERROR(system.add(shape), label + " #0", "body is ground");
  shape.body = system.add(Particle{.mass = 1.0}, "dot");
  EXPECT_MODEL_ERROR(system.add(shape), label + " #0", "body is particle 'dot'", "a rigid body");
  system.remove(shape.body);
  EXPECT_MODEL_ERROR(system.add(shape), label + " #0", "body is a body that was removed");
  System other;
  shape = good;
  shape.material = other.material("foreign");
  EXPECT_MODEL_ERROR(system.add(shape), label + " #0", "material is unknown");
}

TEST_F(ShapeTest, BodyAndMaterialAreChecked) {
  expect_body_and_material_checked(system, Disc{.body = body, .radius = 1.0}, "disc");
  expect_body_and_material_checked(system, Point{.body = body}, "point");
  expect_body_and_material_checked(system, Segment{.body = body, .from = {0, 0}, .to = {1, 0}}, "segment");
  expect_body_and_material_checked(system, Polygon{.body = body, .vertices = {{0, 0}, {2, 0}, {1, 3}}},
                                   "polygon");
  EXPECT_TRUE(system.shapes().empty());
}

TEST_F(ShapeTest, ImpossibleNumbersAreRefusedByName) {
  EXPECT_MODEL_ERROR(system.add(Disc{.body = body}), "disc #0", "radius is nan m", "finite and > 0");
  for (const double bad : {0.0, -1.0, infinity}) {
    EXPECT_MODEL_ERROR(system.add(Disc{.body = body, .radius = bad}), "disc #0",
                       "radius is " + to_text(bad) + " m");
  }
  EXPECT_MODEL_ERROR(system.add(Segment{.body = body}), "segment #0", "from is nan m");
  for (const double bad : {nan, infinity, -infinity}) {
    for (const Vec<2>& at : {Vec<2>(bad, 0.0), Vec<2>(0.0, bad)}) {
      const std::string text = " is " + to_text(bad) + " m";
      EXPECT_MODEL_ERROR(system.add(Disc{.body = body, .radius = 1.0, .centre = at}), "disc #0",
                         "centre" + text);
      EXPECT_MODEL_ERROR(system.add(Point{.body = body, .position = at}), "point #0", "position" + text);
      EXPECT_MODEL_ERROR(system.add(Segment{.body = body, .from = at, .to = {1, 0}}), "segment #0",
                         "from" + text);
      EXPECT_MODEL_ERROR(system.add(Segment{.body = body, .from = {1, 0}, .to = at}), "segment #0",
                         "to" + text);
      EXPECT_MODEL_ERROR(system.add(Polygon{.body = body, .vertices = {{0, 0}, {1, 0}, at}}), "polygon #0",
                         "vertex" + text);
    }
  }
}

TEST_F(ShapeTest, DegenerateOnesAreRefused) {
  EXPECT_MODEL_ERROR(system.add(Segment{.body = body, .from = {1, 2}, .to = {1, 2}}), "segment #0",
                     "to is the same point as from", "another point");
  EXPECT_MODEL_ERROR(system.add(Polygon{.body = body, .vertices = {{0, 0}, {1, 0}}}), "polygon #0",
                     "number of vertices is 2", "at least 3");
}

}  // namespace
