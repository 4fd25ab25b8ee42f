// How deep things may come into each other before they count as passing.

#include "tests/contact/detection/convex_reference.h"
#include "tests/random.h"

#include <carom/carom.h>
#include <carom/contact/detection/detector.h>
#include <carom/core/assembly.h>
#include <carom/core/numerics/never.h>
#include <carom/integrators/time_stepping/passage_levels.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::OwnedOutline;
using carom_test::Random;

// Depths are sums and products of a few numbers of about 0.1.
constexpr double rounding = 1e-15;
constexpr double least = 1e-9, share = 1.0 / 8.0;

/// A model that is only looked at where it is described.
struct Described {
  explicit Described(System system) : assembly(std::move(system)), detector(assembly) {}
  [[nodiscard]] PassageLevels levels(Passages which = Passages::all) const {
    return {detector, least, which};
  }
  /// Depth of the first body in the first piece on ground.
  [[nodiscard]] double on_ground(Passages which = Passages::all) const {
    return levels(which).allowed({.a = 0, .piece = 0});
  }
  Assembly assembly;
  Detector detector;
};

System with_law() {
  System system;
  system.set_default_law({.friction = 0.0, .normal_restitution = 0.0});
  return system;
}

/// Bodies that touch the ground alone.
System with_law_of_ground(MaterialId& floor, MaterialId& thing) {
  System system;
  floor = system.material("floor"), thing = system.material("thing");
  system.between(floor, thing, {.friction = 0.0, .normal_restitution = 0.0});
  return system;
}

BodyId add_body(System& system) { return system.add(RigidBody{.mass = disc(1.0, 0.1)}); }
void add_disc(System& system, double radius) { system.add(Disc{.body = add_body(system), .radius = radius}); }
void add_polygon(System& system, const std::vector<Vec<2>>& vertices, double radius = 0.0) {
  system.add(Polygon{.body = add_body(system), .vertices = vertices, .radius = radius});
}
std::vector<Vec<2>> box_of(double x, double y) { return {{-x, -y}, {x, -y}, {x, y}, {-x, y}}; }

double between_two(System system) { return Described(std::move(system)).levels().allowed({.a = 0, .b = 1}); }

TEST(PassageLevels, OfDiscsAreAnEighthOfTheirRadii) {
  System system = with_law();
  add_disc(system, 0.1);
  add_disc(system, 0.3);
  EXPECT_NEAR(between_two(std::move(system)), share * 0.4, rounding);
}

// A third of the width is the radius of the largest circle in a triangle of equal sides; in any other convex
// set it is less.
TEST(PassageLevels, OfPolygonsAreThoseOfCirclesInThem) {
  const double side = 0.6, height = side * std::sqrt(0.75), inside = height / 3.0;
  for (const double radius : {0.0, 0.02}) {
    System system = with_law();
    add_polygon(system, {{0.0, 0.0}, {side, 0.0}, {0.5 * side, height}}, radius);
    add_polygon(system, box_of(1.0, 0.06), radius);
    EXPECT_NEAR(between_two(std::move(system)), share * (inside + 0.04 + 2.0 * radius), rounding);
  }
}

TEST(PassageLevels, OfPointsAndBareSegmentsAreTheLeast) {
  System system = with_law();
  system.add(Point{.body = add_body(system), .position = {0.1, 0.0}});
  system.add(Segment{.body = add_body(system), .from = {-1.0, 0.0}, .to = {1.0, 0.0}});
  system.add(Segment{.body = add_body(system), .from = {-1.0, 0.0}, .to = {1.0, 0.0}, .radius = 0.08});
  const Described model(std::move(system));
  const PassageLevels levels = model.levels();
  EXPECT_EQ(levels.allowed({.a = 0, .b = 1}), least);
  EXPECT_NEAR(levels.allowed({.a = 1, .b = 2}), share * 0.08,
              rounding);  // a capsule is as thick as its radius
  EXPECT_EQ(levels.thinnest(), least);
}

TEST(PassageLevels, OfThinThingsOnGroundAreThoseOfBothTogether) {
  constexpr double thin = 1e-3;
  for (const bool is_wall : {true, false}) {
    System system = with_law();
    if (is_wall) {
      system.add(Wall{.from = {0.0, -1.0}, .to = {0.0, 1.0}, .radius = thin});
    } else {
      system.add(planar::Block{.vertices = {{0.0, -1.0}, {3.0 * thin, -1.0}, {3.0 * thin, 1.0}, {0.0, 1.0}}});
    }
    add_disc(system, 0.2);
    const Described model(std::move(system));
    for (const Passages which : {Passages::all, Passages::of_far_sides})
      EXPECT_NEAR(model.on_ground(which), share * (0.2 + thin), rounding) << is_wall;
  }
}

// Half-planes have no outlines: nothing is looked for.
TEST(PassageLevels, OfHalfPlanesAreNever) {
  MaterialId floor, thing;
  System system = with_law_of_ground(floor, thing);
  system.add(HalfPlane{.normal = {0.0, 1.0}, .material = floor});
  system.add(Disc{.body = add_body(system), .radius = 0.1, .material = thing});
  EXPECT_EQ(Described(std::move(system)).levels().thinnest(), never);
}

// They cannot be left on a far side; where nothing may be deep in anything, they count with no circle.
TEST(PassageLevels, OfGroundWithoutAFarSideDependOnWhatIsLookedFor) {
  const auto expect_levels = [](System system) {
    add_disc(system, 0.2);
    add_disc(system, 0.2);
    const Described model(std::move(system));
    ASSERT_FALSE(model.detector.outlines().on_ground().outlines().empty());
    EXPECT_NEAR(model.on_ground(Passages::all), share * 0.2, rounding);
    EXPECT_EQ(model.on_ground(Passages::of_far_sides), never);
    // The bodies can pass each other.
    EXPECT_NEAR(model.levels(Passages::of_far_sides).thinnest(), share * 0.4, rounding);
  };
  System circle = with_law(), inside = with_law();
  circle.add(CircleInside{.radius = 3.0});
  expect_levels(std::move(circle));
  inside.add(BoxInside{.lower = {-1.0, -1.0}, .upper = {1.0, 1.0}});
  expect_levels(std::move(inside));
}

TEST(PassageLevels, OfADrumWhoseBodiesDoNotTouchAreNever) {
  MaterialId floor, thing;
  System system = with_law_of_ground(floor, thing);
  system.add(CircleInside{.radius = 3.0, .material = floor});
  system.add(Disc{.body = add_body(system), .radius = 0.1, .material = thing});
  const Described model(std::move(system));
  EXPECT_EQ(model.levels(Passages::of_far_sides).thinnest(), never);
  EXPECT_NEAR(model.levels(Passages::all).thinnest(), share * 0.1, rounding);
}

// Ground below faces is a layer that is as thick as they say: it holds circles of half its depth.
TEST(PassageLevels, OfTerrainAreThoseOfItsDepth) {
  System system = with_law();
  system.add(Terrain{.vertices = {{-1.0, 0.0}, {0.0, 1.0}, {1.0, 0.0}}, .depth = 0.3});
  add_disc(system, 0.2);
  const Described model(std::move(system));
  for (const Passages which : {Passages::all, Passages::of_far_sides})
    EXPECT_NEAR(model.on_ground(which), share * (0.2 + 0.15), rounding);
}

TEST(PassageLevels, ReachesAreThoseOfVerticesThatTurn) {
  System system = with_law();
  add_disc(system, 0.2);
  const BodyId body = add_body(system);
  system.add(Polygon{.body = body, .vertices = box_of(0.3, 0.4), .radius = 0.1});
  system.add(Disc{.body = body, .radius = 2.0, .centre = {0.0, 0.2}});
  system.add(RigidBody{.mass = disc(1.0, 0.1)});  // touches nothing
  const Described model(std::move(system));
  const PassageLevels levels = model.levels();
  ASSERT_EQ(levels.reaches().size(), 3U);
  EXPECT_EQ(levels.reaches()[0], 0.0);  // a disc turns about its centre
  EXPECT_NEAR(levels.reaches()[1], 0.5, rounding);
  EXPECT_EQ(levels.reaches()[2], 0.0);
}

/// The radius of the largest circle in a polygon, nearly: a grid of centres is halved again and again.
double circle_in(const OwnedOutline& of) {
  const OwnedOutline sharp{of.vertices, 0.0};
  Vec<2> best = of.vertices[0];
  double most = 0.0;
  for (double size = 2.0; size > 1e-4; size *= 0.5) {
    const Vec<2> around = best;
    for (int i = -4; i <= 4; ++i) {
      for (int j = -4; j <= 4; ++j) {
        const Vec<2> at = around + 0.5 * size * Vec<2>(i, j);
        const double inside = -static_cast<double>(carom_test::core_distance(sharp, at));
        if (inside > most) most = inside, best = at;
      }
    }
  }
  return of.radius + most;
}

// What passes through a thing is in it by the radii of both: what is allowed is well below that, but not so
// small that nothing could touch. And nothing is allowed less than the thinnest.
TEST(PassageLevels, OfAnyPolygonsAreBelowWhatItTakesToPass) {
  Random random(2);
  int polygons = 0;
  for (int trial = 0; trial < 40; ++trial) {
    const OwnedOutline outline = carom_test::random_outline(random);
    if (outline.vertices.size() < 3) continue;
    ++polygons;
    System system = with_law();
    add_polygon(system, outline.vertices, outline.radius);
    add_disc(system, 0.1);
    system.add(Peg{.radius = random.uniform(0.01, 0.5)});
    const Described model(std::move(system));
    const PassageLevels levels = model.levels();
    const double allowed = levels.allowed({.a = 0, .b = 1}), most = share * (circle_in(outline) + 0.1);
    EXPECT_LE(allowed, most + 1e-4) << trial;  // as fine as the grid is
    EXPECT_GE(allowed, 0.6 * most) << trial;   // a third of the width, which is not below the diameter
    for (const Index a : {0U, 1U}) EXPECT_LE(levels.thinnest(), levels.allowed({.a = a, .piece = 0}));
    EXPECT_LE(levels.thinnest(), allowed);
  }
  EXPECT_GT(polygons, 20);
}

}  // namespace
