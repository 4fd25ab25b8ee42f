// The convex sets with which shapes of bodies touch each other.

#include <carom/bodies/rigid_body.h>
#include <carom/bodies/shape_disc.h>
#include <carom/bodies/shape_point.h>
#include <carom/bodies/shape_polygon.h>
#include <carom/bodies/shape_segment.h>
#include <carom/core/system.h>

#include "tests/model_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;

using Vertices = std::vector<Vec<2>>;

class OutlineTest : public testing::Test {
protected:
  std::vector<Outline> outlines(ShapeId id) const {
    std::vector<Outline> out;
    const auto place = system.shape_kinds().place(id.serial);
    system.shape_kinds().kind_of(id.serial).outlines(place.slot, PartCheck(system.name(id), system), out);
    return out;
  }
  Outline of_polygon(const Vertices& vertices) {
    return outlines(system.add(Polygon{.body = body, .vertices = vertices})).at(0);
  }
  void expect_refused(const Vertices& vertices, const char* reason) {
    const ShapeId id = system.add(Polygon{.body = body, .vertices = vertices});  // against half-planes: fine
    EXPECT_MODEL_ERROR(outlines(id), "polygon #", "vertices", reason, "a convex polygon");
  }

  System system;
  BodyId body = system.add(RigidBody{.mass = disc(1.0, 1.0)}, "plate");
};

TEST_F(OutlineTest, OfDiscPointAndSegment) {
  const auto of_disc = outlines(system.add(Disc{.body = body, .radius = 0.5, .centre = {1, 2}}));
  ASSERT_EQ(of_disc.size(), 1U);
  EXPECT_EQ(of_disc[0].vertices, (Vertices{{1, 2}}));
  EXPECT_EQ(of_disc[0].radius, 0.5);
  const auto of_point = outlines(system.add(Point{.body = body, .position = {1, 2}}));
  ASSERT_EQ(of_point.size(), 1U);
  EXPECT_EQ(of_point[0].vertices, (Vertices{{1, 2}}));
  EXPECT_EQ(of_point[0].radius, 0.0);
  const auto capsule =
      outlines(system.add(Segment{.body = body, .from = {1, 2}, .to = {3, 4}, .radius = 0.25}));
  ASSERT_EQ(capsule.size(), 1U);
  EXPECT_EQ(capsule[0].vertices, (Vertices{{1, 2}, {3, 4}}));
  EXPECT_EQ(capsule[0].radius, 0.25);
}

TEST_F(OutlineTest, OfAPolygonIsCounterClockwise) {
  const ShapeId id = system.add(Polygon{.body = body, .vertices = {{0, 0}, {1, 3}, {2, 0}}, .radius = 0.5});
  const auto found = outlines(id);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].vertices, (Vertices{{0, 0}, {2, 0}, {1, 3}}));
  EXPECT_EQ(found[0].radius, 0.5);
  std::vector<RoundedPoint> points;  // these stay in the order in which they were given
  system.shape_kinds().kind_of(id.serial).rounded_points(0, points);
  ASSERT_EQ(points.size(), 3U);
  EXPECT_EQ(points[1].centre, (std::array<double, 3>{1, 3, 0}));
  EXPECT_EQ(points[1].radius, 0.5);
  EXPECT_EQ(of_polygon({{0, 0}, {2, 0}, {1, 3}}).vertices, (Vertices{{0, 0}, {2, 0}, {1, 3}}));
}

TEST_F(OutlineTest, OfAPolygonHasCornersOnly) {
  const Vertices triangle{{0, 0}, {2, 0}, {1, 3}};
  EXPECT_EQ(of_polygon({{0, 0}, {1, 0}, {2, 0}, {2, 0}, {1, 3}}).vertices, triangle);
  EXPECT_EQ(of_polygon({{0, 0}, {0.5, 0}, {1, 0}, {1.75, 0}, {2, 0}, {1.5, 1.5}, {1, 3}}).vertices, triangle);
  EXPECT_EQ(of_polygon({{0, 0}, {2, 0}, {1, 3}, {0, 0}}).vertices.size(), 3U);
  EXPECT_EQ(of_polygon({{0, 0}, {0.1, 0.1}, {0.3, 0.3}, {0, 1}}).vertices.size(), 3U);
  // A flat corner is one if it is more than rounding.
  EXPECT_EQ(of_polygon({{0, 0}, {1, -1e-12}, {2, 0}, {1, 3}}).vertices.size(), 4U);
  Vertices round;
  for (int i = 0; i < 1000; ++i) {
    round.push_back({std::cos(i * 0.002 * std::numbers::pi), std::sin(i * 0.002 * std::numbers::pi)});
  }
  EXPECT_EQ(of_polygon(round).vertices.size(), 1000U);
}

TEST_F(OutlineTest, OnlyConvexPolygonsHaveOne) {
  expect_refused({{0, 0}, {2, 0}, {0.5, 0.5}, {0, 2}}, "not convex at (0.5, 0.5)");
  expect_refused({{0, 0}, {0, 2}, {0.5, 0.5}, {2, 0}}, "not convex at (0.5, 0.5)");
  expect_refused({{0, 0}, {2, 0}, {1, 1e-9}, {1, 2}}, "not convex");
  expect_refused({{0, 0}, {3, 0}, {2, 0}, {2, 2}}, "not convex");  // goes back on itself
  const Vertices square{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  Vertices twice = square;
  twice.insert(twice.end(), square.begin(), square.end());
  expect_refused(twice, "crossing themselves");
}

TEST_F(OutlineTest, SidesThatCrossAreRefusedAtOnce) {
  Vertices star;
  for (int i = 0; i < 5; ++i) {
    star.push_back({std::cos(0.8 * i * std::numbers::pi), std::sin(0.8 * i * std::numbers::pi)});
  }
  const char* const allowed = "a polygon whose sides meet at their corners only";
  EXPECT_MODEL_ERROR(system.add(Polygon{.body = body, .vertices = star}), "polygon #", "vertices",
                     "crossing themselves: sides 0 and 2", allowed);
  EXPECT_MODEL_ERROR(
      system.add(Polygon{.body = body, .vertices = {{0, 0}, {1, 1}, {1, 0}, {0, 1}, {-1, 0.5}}}, "bow"),
      "polygon 'bow'", "crossing themselves: sides 0 and 2", allowed);
  // Sides that touch, or are one on the other, do not cross: what they bound is for the outline to say.
  EXPECT_NO_THROW(system.add(Polygon{.body = body, .vertices = {{0, 0}, {2, 0}, {2, 2}, {1, 0}, {0, 2}}}));
}

TEST_F(OutlineTest, RadiiAreChecked) {
  for (const double bad :
       {-0.1, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_MODEL_ERROR(system.add(Polygon{.body = body, .vertices = {{0, 0}, {2, 0}, {1, 3}}, .radius = bad}),
                       "polygon #0", "radius is " + to_text(bad) + " m");
    EXPECT_MODEL_ERROR(system.add(Segment{.body = body, .from = {0, 0}, .to = {1, 0}, .radius = bad}),
                       "segment #0", "radius is " + to_text(bad) + " m");
  }
}

}  // namespace
