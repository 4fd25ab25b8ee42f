// Shapes on ground that outlines touch: their pieces, where they move, and the rows of contacts with them.

#include <carom/bodies/rigid_body.h>
#include <carom/contact/detection/ground_parts.h>
#include <carom/contact/detection/ground_pieces.h>
#include <carom/contact/detection/half_space.h>
#include <carom/contact/detection/narrow_phase.h>
#include <carom/contact/detection/outline_pair.h>
#include <carom/contact/detection/pair_rows.h>
#include <carom/core/constraint_set.h>
#include <carom/core/system.h>

#include "tests/contact/detection/convex_reference.h"
#include "tests/model_error.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::OwnedOutline;

using Gaps = std::array<GapPoint, 2>;

/// The gap of given features.
GapPoint tracked(const GroundPieces& pieces, Index outline, const ConvexOutline& a, Index feature_a,
                 Index feature_b) {
  const GroundOutline& of = pieces.outlines()[outline];
  const ConvexOutline view = pieces.view(outline);
  const PlacedOutline b = of.is_hollow() ? PlacedOutline::outside_of(view) : PlacedOutline(view);
  return follow_gap(PlacedOutline(a), feature_a, b, feature_b);
}
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();
const Surface law{.friction = 0.0, .normal_restitution = 1.0};

// The pieces of a system at a time.
struct Ground {
  explicit Ground(const System& system, double time = 0.0) : shapes(system), pieces(system, shapes, {}) {
    place(time);
  }
  void place(double time) { shapes.place(time, places); }
  // Gaps in space.
  std::vector<GapPoint> find(const OwnedOutline& a, double margin) const {
    std::vector<GapPoint> out;
    for (Index piece = 0; piece < pieces.size(); ++piece) {
      const PlaneFrame frame(shapes.motion(pieces.shape(piece), places));
      OwnedOutline local = a;
      for (Vec<2>& vertex : local.vertices) vertex = frame.inside(vertex);
      Gaps found;
      const int count = pieces.find(piece, local.view(), margin, found);
      for (int k = 0; k < count; ++k) {
        GapPoint at = found[static_cast<std::size_t>(k)];
        const GapPoint again =
            tracked(pieces, pieces.outline(piece), local.view(), at.feature_a, at.feature_b);
        EXPECT_EQ(again.gap, at.gap);
        EXPECT_EQ(again.normal, at.normal);
        at.normal = frame.turned(at.normal);
        at.point_a = frame.outside(at.point_a);
        at.point_b = frame.outside(at.point_b);
        out.push_back(at);
      }
    }
    return out;
  }

  GroundShapes shapes;
  GroundPieces pieces;
  GroundPlaces places;
};

OwnedOutline disc(double x, double y, double radius) { return {{{x, y}}, radius}; }

TEST(GroundPieces, SolidsAreTouchedAllAround) {
  System system;
  system.add(Wall{.from = {-1, 0}, .to = {1, 0}, .radius = 0.125}, law);
  system.add(planar::Block{.vertices = {{4, 0}, {4, 1}, {5, 1}, {5, 0}}}, law);
  system.add(Peg{.centre = {0, 5}, .radius = 0.5}, law);
  const Ground ground(system);
  ASSERT_EQ(ground.pieces.size(), 3U);
  const auto expect_one = [&](const OwnedOutline& a, double gap, const Vec<2>& normal) {
    const auto found = ground.find(a, 0.5);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].gap, gap);
    EXPECT_EQ(found[0].normal, normal);
  };
  expect_one(disc(0.5, 0.5, 0.25), 0.125, {0, 1});
  expect_one(disc(0.5, -0.5, 0.25), 0.125, {0, -1});
  expect_one(disc(2.0, 0, 0.5), 0.375, {1, 0});
  expect_one(disc(3.5, 0.5, 0.25), 0.25, {-1, 0});
  expect_one(disc(4.5, 1.5, 0.25), 0.25, {0, 1});
  expect_one(disc(0, 4, 0.25), 0.25, {0, -1});
}

TEST(GroundPieces, InABoxBothWallsOfACornerTouch) {
  System system;
  system.add(BoxInside{.lower = {0, 0}, .upper = {4, 3}}, law);
  const Ground ground(system);
  auto found = ground.find(disc(0.5, 0.75, 0.5), 0.5);  // the left wall, then the floor
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].gap, 0.0);
  EXPECT_EQ(found[0].normal, Vec<2>(1, 0));
  EXPECT_EQ(found[1].gap, 0.25);
  EXPECT_EQ(found[1].normal, Vec<2>(0, 1));
  found = ground.find(disc(3.875, 2.875, 0.5), 0.0);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].gap, -0.375);
  EXPECT_EQ(found[1].gap, -0.375);
  EXPECT_TRUE(ground.find(disc(2, 1.5, 0.5), 0.5).empty());
  found = ground.find(disc(6, 1.5, 0.5), 0.0);  // outside is solid
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].gap, -2.5);
}

TEST(GroundPieces, InADrumVerticesTouch) {
  System system;
  system.add(CircleInside{.centre = {1, 1}, .radius = 5}, law);
  const Ground ground(system);
  auto found = ground.find(disc(4, 5, 0.5), 0.0);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].gap, -0.5);
  EXPECT_LE((found[0].normal - Vec<2>(-0.6, -0.8)).norm(), 1e-16);
  EXPECT_LE((found[0].point_b - Vec<2>(4, 5)).norm(), 1e-15);
  EXPECT_LE((found[0].point_a - Vec<2>(4.3, 5.4)).norm(), 1e-15);
  found = ground.find({{{-2, -3}, {4, -3}, {1, 2}}, 0.0}, 1e-9);  // lies on two corners
  ASSERT_EQ(found.size(), 2U);
  EXPECT_NEAR(found[0].gap, 0.0, 1e-15);
  EXPECT_NEAR(found[1].gap, 0.0, 1e-15);
}

TEST(GroundPieces, TerrainIsSolidBelow) {
  System system;
  system.add(Terrain{.vertices = {{-2, 0}, {0, 0}, {2, 1}}, .depth = 0.5}, law);
  const Ground ground(system);
  auto found = ground.find(disc(-1, 0.25, 0.25), 0.0);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].normal, Vec<2>(0, 1));
  EXPECT_TRUE(ground.find(disc(-1, -1, 0.25), 0.0).empty());
  // In the inner corner both faces, on the slope one.
  EXPECT_EQ(ground.find(disc(0.0, 0.24, 0.25), 0.02).size(), 2U);
  EXPECT_EQ(ground.find(disc(1.0, 0.75, 0.25), 0.0).size(), 1U);
}

TEST(GroundPieces, MoveAsPrescribed) {
  System system;
  system.add(Wall{.from = {1, 0},
                  .to = {3, 0},
                  .radius = 0.25,
                  .pivot = {1, 0},
                  .motion = {.displacement = [](double t) { return Vec<2>(t, 2.0 * t); },
                             .angle = [](double t) { return t; }}},
             law);
  system.add(Peg{.centre = {0, -5}, .radius = 1}, law);
  const double time = 0.75;
  const Ground ground(system, time);
  // In the middle of the wall, 0.25 before its left side.
  const Vec<2> along(std::cos(time), std::sin(time)), normal(-along[1], along[0]);
  const Vec<2> at = Vec<2>(1.0 + time, 2.0 * time) + along + 0.5 * normal;
  const auto found = ground.find(disc(at[0], at[1], 0.25), 0.5);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(found[0].gap, 0.0, 1e-15);
  EXPECT_LE((found[0].normal - normal).norm(), 1e-15);
  EXPECT_EQ(ground.find(disc(0, -3.75, 0.25), 0.0).size(), 1U);
  const Box<2> box = ground.pieces.box(0);  // in the frame of the wall
  EXPECT_LE((box.min - Vec<2>(-0.25, -0.25)).norm(), 1e-15);
  EXPECT_LE((box.max - Vec<2>(2.25, 0.25)).norm(), 1e-15);
}

// Central difference of order 6; what it leaves is rounding, some 1e-15/h.
template <class F>
double rate(F&& f) {
  const double h = 1e-3;
  const auto slope = [&](double step) { return (f(step) - f(-step)) / (2.0 * step); };
  return (15.0 * slope(h) - 6.0 * slope(2.0 * h) + slope(3.0 * h)) / 10.0;
}

// A body in a drum that moves and whose surface runs, at constant velocities.
TEST(GroundPieces, RowsAreTheRatesOfTheGapAndDriftIsTheirs) {
  System system;
  system.add(
      CircleInside{.centre = {1, 1},
                   .radius = 3,
                   .surface_speed = 0.75,
                   .pivot = {0.5, 0},
                   .motion = {.displacement = [](double t) { return Vec<2>(0.3 * t + t * t, -0.2 * t); },
                              .velocity = [](double t) { return Vec<2>(0.3 + 2.0 * t, -0.2); },
                              .acceleration = [](double) { return Vec<2>(2.0, 0.0); },
                              .angle = [](double t) { return 0.4 * t + 0.5 * t * t; },
                              .spin = [](double t) { return 0.4 + t; },
                              .angular_acceleration = [](double) { return 1.0; }}},
      law);
  Ground ground(system);
  const OwnedOutline local{{{-0.5, -0.25}, {0.75, -0.25}, {0.0, 0.5}}, 0.125};
  const BodySlot slot{0, 0, 0, 3, 3, 0, 0, 0};
  const std::array<double, 3> q{2.0, -0.5, 0.3}, v{0.7, -0.4, 1.3};
  const auto q_at = [&](double t) {
    return std::array<double, 3>{q[0] + t * v[0], q[1] + t * v[1], q[2] + t * v[2]};
  };
  const auto gap_at = [&](double t) {
    ground.place(t);
    const auto now = q_at(t);
    OwnedOutline moved = local.moved(now[2], {now[0], now[1]});
    const PlaneFrame frame(ground.shapes.motion(0, ground.places));
    for (Vec<2>& vertex : moved.vertices) vertex = frame.inside(vertex);
    GapPoint at = tracked(ground.pieces, 0, moved.view(), 1, 0);
    at.normal = frame.turned(at.normal);
    at.point_a = frame.outside(at.point_a);
    at.point_b = frame.outside(at.point_b);
    return at;
  };
  const auto rows_at = [&](double t) {
    const GapPoint at = gap_at(t);
    const auto now = q_at(t);
    const StateView state{t, now.data(), v.data(), nullptr};
    SingleConstraint rows;
    fill_pair_rows(PairSide::of_body(slot, 0, local.radius, state),
                   ground.pieces.side(0, ground.shapes.motion(0, ground.places)), at, rows);
    return rows;
  };
  const SingleConstraint rows = rows_at(0);
  EXPECT_NEAR(rows.velocity(0, v.data()), rate([&](double t) { return gap_at(t).gap; }), 1e-11);
  for (int row = 0; row < 2; ++row) {
    EXPECT_NEAR(rows.drift[static_cast<std::size_t>(row)],
                rate([&](double t) { return rows_at(t).velocity(row, v.data()); }), 3e-11);
  }
  // The surface runs to the right of who stands on it.
  SingleConstraint still;
  const StateView state{0.0, q.data(), v.data(), nullptr};
  const PairSide body = PairSide::of_body(slot, 0, local.radius, state);
  const GapPoint at = gap_at(0);  // places the ground
  fill_pair_rows(body, PairSide::of_motion(*ground.shapes.motion(0, ground.places), -3.0), at, still);
  EXPECT_EQ(rows.surface_velocity[1], still.surface_velocity[1] + 0.75);
  EXPECT_EQ(rows.surface_velocity[0], still.surface_velocity[0]);
}

TEST(GroundPieces, FacesWithoutAnInnerCornerAreOneOutline) {
  System system;
  system.add(Peg{.radius = 1}, law);
  system.add(BoxInside{.lower = {0, 0}, .upper = {4, 3}}, law);
  // Apart from each other: faces that lie on each other would hide each other.
  system.add(Terrain{.vertices = {{10, 0}, {11, 0}, {12, 0}, {13, -1}, {14, 1}}, .depth = 1}, law);
  system.add(Terrain{.vertices = {{20, 0}, {21, 1}, {22, 0}}, .depth = 0.1, .is_closed = true}, law);
  const Ground ground(system);
  const std::vector<GroundOutline>& outlines = ground.pieces.outlines();
  ASSERT_EQ(ground.pieces.size(), 1U + 4U + (4U + 2U) + 3U);
  ASSERT_EQ(outlines.size(), 1U + 4U + 2U + 1U);
  EXPECT_EQ(outlines[0].key, ground.shapes.key(0));
  for (Index face = 0; face < 4; ++face) EXPECT_EQ(outlines[1 + face].key.feature, 3 * face);
  EXPECT_EQ(outlines[5].vertices.size(), 3U);  // from right to left, with the sides
  EXPECT_EQ(outlines[6].vertices.size(), 5U);
  EXPECT_EQ(outlines[6].key.feature, 4U);
  const FaceChain chain = ground.pieces.chain(6);
  EXPECT_EQ(chain.corners[0], ChainCorner::concave);
  EXPECT_EQ(chain.corners[1], ChainCorner::convex);
  EXPECT_EQ(chain.corners[2], ChainCorner::flat);
  EXPECT_EQ(chain.corners[3], ChainCorner::convex);
  EXPECT_EQ(chain.corners[4], ChainCorner::free);
  EXPECT_TRUE(outlines[7].is_closed);
  EXPECT_EQ(outlines[7].vertices.size(), 3U);
}

TEST(GroundPieces, PointsDoNotTouchThem) {
  System system;
  system.add(Wall{.from = {-1, 0}, .to = {1, 0}, .radius = 0.25}, law);
  const Ground ground(system);
  const std::array<double, 2> point{0, 0};
  EXPECT_EQ(ground.shapes.gap(0, nullptr, point.data()).distance, infinity);
  EXPECT_EQ(ground.shapes.points_within(0, nullptr, {point.data(), 2, 1}, 1e100), 0U);
}

TEST(GroundPieces, ImpossibleShapesAreRefused) {
  System system;
  EXPECT_MODEL_ERROR(system.add(Wall{}, law), "wall #0", "from is nan m");
  EXPECT_MODEL_ERROR(system.add(Wall{.from = {1, 1}, .to = {1, 1}, .radius = 1}, law),
                     "to is the same point as from");
  EXPECT_MODEL_ERROR(system.add(Wall{.from = {1, 1}, .to = {2, 1}, .radius = -1}, law), "radius is -1 m");
  EXPECT_MODEL_ERROR(system.add(Wall{.from = {1, 1}, .to = {2, 1}}, law), "radius is nan m");
  EXPECT_MODEL_ERROR(system.add(planar::Block{.vertices = {{0, 0}, {2, 0}, {0.5, 0.5}, {0, 2}}}, law),
                     "not convex");
  EXPECT_MODEL_ERROR(system.add(Peg{}, law), "peg #0", "radius is nan m");
  EXPECT_MODEL_ERROR(system.add(Peg{.radius = 1, .surface_speed = nan}, law), "surface_speed is nan m/s");
  EXPECT_MODEL_ERROR(system.add(Peg{.radius = 1, .pivot = {0, infinity}}, law), "pivot is inf m");
  EXPECT_MODEL_ERROR(system.add(CircleInside{.radius = 0}, law), "radius is 0 m");
  EXPECT_MODEL_ERROR(system.add(BoxInside{.lower = {0, 0}, .upper = {1, 0}}, law), "height is 0 m");
  EXPECT_MODEL_ERROR(system.add(BoxInside{}, law), "lower is nan m");
  EXPECT_MODEL_ERROR(system.add(Terrain{.vertices = {{0, 0}, {1, 0}}}, law), "terrain #0", "depth is nan m");
  EXPECT_MODEL_ERROR(system.add(Terrain{.vertices = {{0, 0}}, .depth = 1}, law), "number of vertices is 1",
                     "2");
  EXPECT_MODEL_ERROR(system.add(Terrain{.vertices = {{0, 0}, {1, 0}, {1, 0}}, .depth = 1}, law),
                     "(1, 0) twice in a row");
  EXPECT_MODEL_ERROR(system.add(Terrain{.vertices = {{0, 0}, {2, 0}, {1, 0}}, .depth = 1}, law),
                     "going back at (2, 0)");
  EXPECT_MODEL_ERROR(system.add(Terrain{.vertices = {{0, 0}, {2, 0}}, .depth = 1, .is_closed = true}, law),
                     "at least 3");
  EXPECT_MODEL_ERROR(
      system.add(Terrain{.vertices = {{0, 0}, {4, 0}, {4, 2}, {2, 2}, {2, -1}}, .depth = 1}, law, "loop"),
      "terrain 'loop'", "crossing themselves: faces 0 and 3", "meet at their corners only");
  EXPECT_MODEL_ERROR(system.add(HalfPlane{.normal = {0, 1}, .surface_speed = nan}, law),
                     "surface_speed is nan m/s");
}

TEST(GroundPieces, FingerprintsTellThemApart) {
  const auto print = [](const auto& shape) {
    System system;
    system.add(shape, law);
    return system.fingerprint();
  };
  const Wall wall{.from = {-1, 0}, .to = {1, 0}, .radius = 0.25};
  std::vector<std::uint64_t> prints{print(wall)};
  const auto expect_new = [&](const auto& shape) {
    const std::uint64_t another = print(shape);
    for (const std::uint64_t known : prints) EXPECT_NE(another, known);
    prints.push_back(another);
  };
  expect_new(Wall{.from = {-1, 0}, .to = {1, 0.5}, .radius = 0.25});
  expect_new(Wall{.from = {-1, 0}, .to = {1, 0}, .radius = 0.5});
  expect_new(Wall{.from = {-1, 0}, .to = {1, 0}, .radius = 0.25, .surface_speed = 0.5});
  expect_new(Wall{.from = {-1, 0}, .to = {1, 0}, .radius = 0.25, .pivot = {0, 1}});
  expect_new(
      Wall{.from = {-1, 0}, .to = {1, 0}, .radius = 0.25, .motion = {.angle = [](double t) { return t; }}});
  expect_new(Terrain{.vertices = {{-1, 0}, {1, 0}}, .depth = 1});
  expect_new(Terrain{.vertices = {{-1, 0}, {1, 0}}, .depth = 2});
  EXPECT_EQ(print(wall), prints[0]);
}

}  // namespace
