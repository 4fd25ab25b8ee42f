// Shapes on ground: the library's and a user's own, at rest and moving.

#include <carom/contact/detection/ground_shapes.h>

#include "tests/contact/detection/placed_model.h"
#include "tests/round_hill.h"

#include <carom/carom.h>
#include <carom/contact/detection/detector.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;

constexpr double infinity = std::numeric_limits<double>::infinity();
const Surface law{.friction = 0.0, .normal_restitution = 1.0};

PrescribedMotion shaking(double amplitude) {
  return {.displacement = [amplitude](double t) { return Vec<2>(0.0, amplitude * std::sin(t)); },
          .breaks = {2.0, 3.0}};
}

TEST(GroundShapes, AreOnGround) {
  System system;
  system.add(HalfPlane{.normal = {0, 1}}, law);
  const ShapeKind& kind = *system.ground_shape_kinds().entries()[0].kind;
  EXPECT_EQ(kind.body(0), ground);
  std::vector<RoundedPoint> points;
  kind.rounded_points(0, points);
  EXPECT_TRUE(points.empty());
}

TEST(GroundShapes, KeepTheOrderInWhichTheyWereAdded) {
  System system;
  EXPECT_TRUE(GroundShapes(system).empty());
  const ObstacleId a = system.add(HalfPlane{.normal = {0, 1}}, law),
                   b = system.add(HalfPlane{.normal = {1, 0}, .motion = shaking(0.1)}, law),
                   c = system.add(carom_test::RoundHill{.centre = {5, 5}}, law),
                   d = system.add(HalfPlane{.normal = {-1, 0}}, law);
  system.remove(a);
  const GroundShapes shapes(system);
  ASSERT_EQ(shapes.size(), 3U);
  EXPECT_EQ(shapes.id(0), b);
  EXPECT_EQ(shapes.id(1), c);
  EXPECT_EQ(shapes.id(2), d);
  EXPECT_EQ(shapes.find(c.serial), 1U);
  EXPECT_EQ(shapes.find(a.serial), none);
  EXPECT_EQ(shapes.key(2), (FeatureKey{FeatureKey::Owner::obstacle, d.serial, 0}));
  EXPECT_TRUE(shapes.any_moves());
  EXPECT_TRUE(shapes.moves(0));
  EXPECT_FALSE(shapes.moves(1));
  EXPECT_EQ(shapes.discontinuities(),
            (std::vector<Discontinuity>{{.time = 2.0, .obstacle = b}, {.time = 3.0, .obstacle = b}}));
}

TEST(GroundShapes, PlacesAreFilledOncePerTime) {
  System system;
  int calls = 0;
  system.add(HalfPlane{.normal = {0, 1}}, law);
  system.add(HalfPlane{.normal = {0, 1},
                       .motion = {.displacement =
                                      [&calls](double t) {
                                        ++calls;
                                        return Vec<2>(0.0, t);
                                      },
                                  .velocity = [](double) { return Vec<2>(0.0, 1.0); },
                                  .acceleration = [](double) { return Vec<2>(0.0, 0.0); }}},
             law);
  const GroundShapes shapes(system);
  GroundPlaces places;
  EXPECT_TRUE(std::isnan(places.time()));
  shapes.place(2.0, places);
  EXPECT_EQ(places.time(), 2.0);
  const int once = calls;
  shapes.place(2.0, places);
  EXPECT_EQ(calls, once);
  EXPECT_EQ(shapes.motion(0, places), nullptr);
  ASSERT_NE(shapes.motion(1, places), nullptr);
  EXPECT_EQ(shapes.motion(1, places)->point[1], 2.0);
  const Vec<2> point(0.0, 5.0);
  EXPECT_EQ(shapes.gap(0, nullptr, point.data()).distance, 5.0);
  EXPECT_EQ(shapes.gap(1, shapes.motion(1, places), point.data()).distance, 3.0);
  const PointRow row{point.data(), 2, 1};
  EXPECT_EQ(shapes.points_within(1, shapes.motion(1, places), row, 2.9), 0U);
  EXPECT_EQ(shapes.points_within(1, shapes.motion(1, places), row, 3.0), 1U);
  EXPECT_EQ(shapes.points_within(0, nullptr, row, 3.0), 0U);
}

TEST(GroundShapes, MotionsThatAreNotFiniteLeaveNoPlaces) {
  System system;
  system.add(
      HalfPlane{.normal = {0, 1},
                .motion = {.displacement = [](double t) { return Vec<2>(0.0, t < 1.0 ? 0.0 : infinity); }}},
      law, "table");
  const GroundShapes shapes(system);
  GroundPlaces places;
  shapes.place(0.5, places);
  EXPECT_THROW(shapes.place(2.0, places), SolverError);
  EXPECT_TRUE(std::isnan(places.time()));
}

TEST(GroundShapes, JumpsAreNotContinuous) {
  System system;
  system.add(HalfPlane{.normal = {0, 1},
                       .motion = {.displacement = [](double t) { return Vec<2>(0.0, t < 1.0 ? 0.0 : 0.2); }}},
             law, "table");
  const GroundShapes shapes(system);
  GroundPlaces early, before, after;
  shapes.place(0.2, early);
  shapes.place(0.5, before);
  shapes.place(1.5, after);
  EXPECT_NO_THROW(shapes.demand_continuous(early, before));
  EXPECT_THROW(shapes.demand_continuous(before, after), SolverError);
}

// A ball falls on the top of the hill and comes back, in both modes.
TEST(GroundShapes, AUsersOwnIsTouched) {
  System system;
  system.add(Gravity{{0.0, -10.0}});
  system.add(carom_test::RoundHill{.centre = {0.0, 0.0}, .radius = 1.0}, law, "hill");
  const BodyId ball = system.add(Particle{.mass = 1.0, .position = {0.0, 1.0 + 5.0}}, "ball");
  for (const bool stepping : {true, false}) {
    const Mode mode = stepping ? Mode(TimeStepping{.step = 1e-4}) : Mode(EventDriven{});
    Simulation simulation(system, mode);
    simulation.run_until(2.0);
    EXPECT_NEAR(simulation.state().position(ball)[1], 6.0, stepping ? 0.01 : 1e-6);
    EXPECT_NEAR(simulation.state().position(ball)[0], 0.0, 1e-9);
  }
}

TEST(GroundShapes, AUsersOwnNeedsNoLookAtManyPoints) {
  System system;
  system.add(carom_test::RoundHill{.centre = {0.0, 0.0}, .radius = 1.0}, law);
  const System copy = system;
  const GroundShapes shapes(copy);
  const std::vector<double> points{3.0, 0.0, 0.0, 2.5, -4.0, 0.0};
  EXPECT_EQ(shapes.points_within(0, nullptr, {points.data(), 2, 3}, 1.4), 0U);
  EXPECT_EQ(shapes.points_within(0, nullptr, {points.data(), 2, 3}, 1.6), 2U);
}

}  // namespace
