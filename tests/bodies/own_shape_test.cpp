// The page docs/shapes.md: the shape of a body and the obstacle that it shows.

#include <carom/carom.h>

#include "tests/model_error.h"
#include "tests/page_blocks.h"
#include "tests/round_hill.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

using namespace carom;
using namespace carom::planar;

// The page shows from here...
struct Nut {  // a regular hexagon
  static constexpr Role role = Role::shape;
  static constexpr int dimension = 2;
  static constexpr std::string_view label = "nut";
  using Kind = generic::FeatureShapeKind<Nut>;

  BodyId body{};
  double size = 0.0;  // from the middle to a corner [m]
  MaterialId material{};
  ContactFilter filter{};

  void check(const PartCheck& check) const { check.positive(size, "size", "m"); }
  std::vector<Vec<2>> corners() const {
    std::vector<Vec<2>> out;
    for (int i = 0; i < 6; ++i) {
      const double angle = std::numbers::pi / 3.0 * i;
      out.emplace_back(size * std::cos(angle), size * std::sin(angle));
    }
    return out;
  }
  void features(std::vector<RoundedPoint>& out) const {  // these touch half-planes,
    for (const Vec<2>& corner : corners()) out.push_back({{corner[0], corner[1], 0.0}, 0.0});
  }
  Outline outline(const PartCheck&) const { return {corners(), 0.0}; }  // and this all else
};
// ... to here, and from here...
struct Cam {  // a disc with a round nose
  static constexpr Role role = Role::obstacle;
  static constexpr std::string_view label = "cam";
  using Kind = generic::PieceShapeKind<Cam>;

  Vec<2> centre = Vec<2>::Zero();
  double radius = 0.0, nose = 0.0, reach = 0.0;  // of the disc, of the nose, between both centres [m]
  MaterialId material{};
  double surface_speed = 0.0;
  Vec<2> pivot = Vec<2>::Zero();  // it turns about this point
  PrescribedMotion motion{};      // as this says
  ContactFilter filter{};

  std::vector<GroundPiece> pieces(const PartCheck& check) const {
    check.positive(radius, "radius", "m");
    check.positive(nose, "nose", "m");
    return {{.points = {centre}, .radius = radius},
            {.points = {centre, centre + Vec<2>(0.0, reach)}, .radius = nose}};
  }
};
// ... to here.

namespace {

constexpr double gravity = 9.81;

/// Turns steadily.
PrescribedMotion turning(double spin) {
  return {.angle = [spin](double t) { return spin * t; },
          .spin = [spin](double) { return spin; },
          .angular_acceleration = [](double) { return 0.0; }};
}

TEST(OwnShape, LiesOnHalfPlanesAndOnOtherGround) {
  for (const bool flat : {true, false}) {
    System system;
    system.add(Gravity{{0.0, -gravity}});
    system.set_default_law(Surface{.friction = 0.5, .normal_restitution = 0.0});
    if (flat) system.add(HalfPlane{.normal = {0.0, 1.0}});
    if (!flat) system.add(planar::Block{.vertices = {{-1.0, -1.0}, {1.0, -1.0}, {1.0, 0.0}, {-1.0, 0.0}}});
    const double apothem = 0.1 * std::sqrt(0.75);
    const BodyId body = system.add(RigidBody{.mass = disc(1.0, 0.1), .position = {0.0, apothem + 0.05}});
    system.add(Nut{.body = body, .size = 0.1});
    Simulation simulation(system, EventDriven{});
    simulation.run_until(1.0);
    // It falls on a face: gaps of closed contacts are kept to the tolerances of the run.
    EXPECT_NEAR(simulation.state().position(body)[1], apothem, 1e-10) << flat;
    EXPECT_NEAR(simulation.state().angle(body), 0.0, 1e-10) << flat;
    EXPECT_LT(simulation.energy().kinetic(), 1e-20) << flat;
  }
}

TEST(OwnShape, NutsTouchEachOther) {
  System system;
  system.set_default_law(Surface{.friction = 0.0, .normal_restitution = 1.0});
  std::vector<BodyId> nuts;
  for (const double side : {-1.0, 1.0}) {
    nuts.push_back(system.add(
        RigidBody{.mass = disc(1.0, 0.1), .position = {0.0, side * 0.5}, .velocity = {0.0, -side}}));
    system.add(Nut{.body = nuts.back(), .size = 0.1});
  }
  Simulation simulation(system, EventDriven{});
  simulation.run_until(1.0);
  // Face on face, equal masses, e = 1: velocities are exchanged when 1 m less two apothems is closed.
  EXPECT_NEAR(simulation.state().velocity(nuts[0])[1], -1.0, 1e-12);
  EXPECT_NEAR(simulation.state().velocity(nuts[1])[1], 1.0, 1e-12);
  EXPECT_NEAR(simulation.state().position(nuts[1])[1], 0.5 + 2.0 * 0.1 * std::sqrt(0.75), 1e-10);
}

/// Where a follower above the pivot stands on a circle of radius `r` (both radii together) whose centre is
/// `reach` away from the pivot, turned by an angle from the vertical.
double follower(double r, double reach, double angle) {
  return reach * std::cos(angle) + std::sqrt(r * r - std::pow(reach * std::sin(angle), 2.0));
}

TEST(OwnObstacle, LiftsItsFollower) {
  constexpr double nose = 0.02, reach = 0.1, roller = 0.03, spin = 0.5;
  System system;
  system.add(Gravity{{0.0, -gravity}});
  system.add(Cam{.radius = 0.05, .nose = nose, .reach = reach, .motion = turning(spin)},
             Surface{.friction = 0.0, .normal_restitution = 0.0});
  const BodyId body = system.add(
      RigidBody{.mass = disc(1.0, roller), .position = {0.0, follower(nose + roller, reach, 0.0)}});
  system.add(Disc{.body = body, .radius = roller});
  system.add(Prismatic{.from = ground, .to = body, .axis = {0.0, 1.0}});
  Simulation simulation(system, EventDriven{});
  for (const double time : {0.1, 0.2, 0.4}) {
    simulation.run_until(time);
    // On the nose, with the curvature of both circles: lasting contact is kept to the tolerances of the run.
    EXPECT_NEAR(simulation.state().position(body)[1], follower(nose + roller, reach, spin * time), 1e-9)
        << time;
  }
  EXPECT_LT(std::abs(simulation.energy().residual()), 1e-9 * gravity);
}

TEST(OwnObstacle, IsLeftWhereTheBallLeavesADome) {
  constexpr double radius = 1.0, start = 0.1;
  System system;
  system.add(Gravity{{0.0, -gravity}});
  system.add(carom_test::RoundHill{.radius = radius}, Surface{.friction = 0.0, .normal_restitution = 0.0});
  const BodyId ball =
      system.add(Particle{.mass = 1.0, .position = {radius * std::sin(start), radius * std::cos(start)}});
  Simulation simulation(system, EventDriven{});
  simulation.run_until(1.2);
  const auto& events = simulation.events();
  const auto left = std::find_if(events.begin(), events.end(),
                                 [](const EventRecord& event) { return event.kind == EventKind::lift_off; });
  ASSERT_NE(left, events.end());
  // m v^2/R = m g cos(phi) with v^2 = 2 g R (cos(start) - cos(phi)); differences of normals are good to
  // 1e-10.
  Simulation again(system, EventDriven{});
  again.run_until(left->time);
  EXPECT_NEAR(again.state().position(ball)[1] / radius, 2.0 / 3.0 * std::cos(start), 1e-9);
  EXPECT_NEAR(again.state().position(ball).norm(), radius, 1e-9);
}

TEST(OwnObstacle, ItsMembersAreChecked) {
  System system;
  try {
    system.add(Cam{.radius = -1.0, .nose = 0.1}, Surface{.friction = 0.0, .normal_restitution = 0.0},
               "lifter");
    FAIL() << "a negative radius was taken";
  } catch (const ModelError& error) {
    const std::string said = error.what();
    EXPECT_NE(said.find("cam 'lifter'"), std::string::npos) << said;
    EXPECT_NE(said.find("radius is -1 m"), std::string::npos) << said;
  }
}

/// A shape of bodies that describes what it is told.
struct Told {
  static constexpr Role role = Role::shape;
  static constexpr int dimension = 2;
  static constexpr std::string_view label = "told shape";
  using Kind = generic::FeatureShapeKind<Told>;

  BodyId body{};
  Outline set{};
  MaterialId material{};

  void check(const PartCheck&) const {}
  void features(std::vector<RoundedPoint>& out) const {
    for (const Vec<2>& vertex : set.vertices) out.push_back({{vertex[0], vertex[1], 0.0}, set.radius});
  }
  Outline outline(const PartCheck&) const { return set; }
};

/// An obstacle likewise.
struct ToldGround {
  static constexpr Role role = Role::obstacle;
  static constexpr std::string_view label = "told ground";
  using Kind = generic::PieceShapeKind<ToldGround>;

  std::vector<GroundPiece> set{};
  MaterialId material{};
  double surface_speed = 0.0;
  Vec<2> pivot = Vec<2>::Zero();
  PrescribedMotion motion{};
  ContactFilter filter{};

  std::vector<GroundPiece> pieces(const PartCheck&) const { return set; }
};

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

void run_on(const Outline& set, bool on_half_plane) {
  System system;
  system.set_default_law(Surface{.friction = 0.3, .normal_restitution = 0.0});
  if (on_half_plane) {
    system.add(HalfPlane{.normal = {0.0, 1.0}});
  } else {
    system.add(Peg{.centre = {0.0, -1.0}, .radius = 1.0});
  }
  const BodyId body = system.add(RigidBody{.mass = disc(1.0, 0.1), .position = {0.0, 0.3}});
  system.add(Told{.body = body, .set = set}, "stone");
  Simulation(system, TimeStepping{}).step();
}

/// A shape whose points are not those of its outline.
struct Contradiction {
  static constexpr Role role = Role::shape;
  static constexpr int dimension = 2;
  static constexpr std::string_view label = "contradiction";
  using Kind = generic::FeatureShapeKind<Contradiction>;

  BodyId body{};
  Outline set{};
  std::vector<RoundedPoint> points{};
  MaterialId material{};

  void check(const PartCheck&) const {}
  void features(std::vector<RoundedPoint>& out) const { out.insert(out.end(), points.begin(), points.end()); }
  Outline outline(const PartCheck&) const { return set; }
};

// It would lie on half-planes at one height and on all other ground at another one.
TEST(OwnShape, PointsThatContradictTheOutlineAreRefused) {
  const Outline square{{{-0.1, -0.1}, {0.1, -0.1}, {0.1, 0.1}, {-0.1, 0.1}}, 0.02};
  const auto run = [&](const std::vector<RoundedPoint>& points) {
    System system;
    system.set_default_law(Surface{.friction = 0.3, .normal_restitution = 0.0});
    system.add(HalfPlane{.normal = {0.0, 1.0}});
    for (const double x : {0.0, 1.0}) {
      const BodyId body = system.add(RigidBody{.mass = disc(1.0, 0.1), .position = {x, 0.3}});
      system.add(Contradiction{.body = body, .set = square, .points = points}, x == 0.0 ? "stone" : "");
    }
    Simulation(system, TimeStepping{}).step();
  };
  std::vector<RoundedPoint> points;
  for (const Vec<2>& corner : square.vertices) points.push_back({{corner[0], corner[1], 0.0}, square.radius});
  EXPECT_NO_THROW(run(points));
  EXPECT_NO_THROW(run({}));  // it touches no half-planes
  const auto expect_refused = [&](const std::vector<RoundedPoint>& told) {
    EXPECT_MODEL_ERROR(run(told), "contradiction 'stone': points that touch", "its outline",
                       "points and an outline of the same set");
  };
  expect_refused({points[0], points[1], points[2]});
  std::vector<RoundedPoint> more = points, moved = points, sharp = points;
  more.push_back({{0.0, 0.15, 0.0}, 0.0});
  moved[2].centre[0] += 1e-3;
  for (RoundedPoint& point : sharp) point.radius = 0.0;
  expect_refused(more);
  expect_refused(moved);
  expect_refused(sharp);
}

TEST(OwnShape, WhatIsNoConvexSetIsRefused) {
  const std::vector<Vec<2>> square{{-0.1, -0.1}, {0.1, -0.1}, {0.1, 0.1}, {-0.1, 0.1}};
  const auto expect_refused = [](const Outline& set, const char* value, const char* allowed) {
    EXPECT_MODEL_ERROR(run_on(set, false), "told shape 'stone': ", value, allowed);
  };
  EXPECT_NO_THROW(run_on({square, 0.0}, false));
  EXPECT_NO_THROW(run_on({{{0.0, 0.0}}, 0.1}, false));
  expect_refused({{square.rbegin(), square.rend()}, 0.0}, "clockwise", "counter-clockwise");
  expect_refused({{square[0], square[1], {0.0, 0.0}, square[3]}, 0.0}, "not convex at (0, 0)", "a convex");
  expect_refused({{square[0], square[1], square[1], square[2]}, 0.0}, "(0.1, -0.1) twice", "that differ");
  expect_refused({{square[0], {0.0, -0.1}, square[1], square[2]}, 0.0}, "not convex at (0, -0.1)",
                 "a vertex at each corner");
  expect_refused({{}, 0.1}, "number of vertices", "at least 1");
  expect_refused({square, -0.1}, "radius", "-0.1 m");
  expect_refused({square, not_a_number}, "radius", "nan");
  expect_refused({{square[0], square[1], {not_a_number, 0.1}}, 0.0}, "nan", "finite");
  EXPECT_MODEL_ERROR(run_on({{{0.0, not_a_number}}, 0.1}, true), "told shape 'stone': place", "nan");
  EXPECT_MODEL_ERROR(run_on({{{0.0, 0.0}}, not_a_number}, true), "told shape 'stone': radius", "nan");
}

TEST(OwnObstacle, WhatIsNoPieceIsRefused) {
  using Form = GroundPiece::Form;
  const auto expect_refused = [](const GroundPiece& piece, const char* value, const char* allowed) {
    System system;
    const std::vector<GroundPiece> pieces{{.points = {{5.0, 0.0}}, .radius = 1.0}, piece};
    EXPECT_MODEL_ERROR(system.add(ToldGround{.set = pieces}, "rock"), "told ground 'rock': ", " of piece 1",
                       value, allowed);
  };
  expect_refused({.points = {}}, "number of points", "at least 1");
  expect_refused({.points = {{-1.0, 0.0}, {0.0, 1.0}, {1.0, 0.0}}}, "clockwise", "counter-clockwise");
  expect_refused({.points = {{-1.0, 0.0}, {1.0, 0.0}, {0.0, 0.1}, {0.0, 1.0}}}, "not convex at (0, 0.1)",
                 "several pieces");
  expect_refused({.points = {{not_a_number, 0.0}}, .radius = 1.0}, "nan", "finite");
  expect_refused({.points = {{0.0, 0.0}}, .radius = -1.0}, "radius", "-1 m");
  expect_refused({.form = Form::face, .points = {{0.0, 0.0}, {1.0, 0.0}}}, "number of points", "4 of a face");
  expect_refused({.form = Form::face, .points = {{-1.0, 0.0}, {0.0, 0.0}, {0.0, 0.0}, {1.0, 0.0}}},
                 "(0, 0) twice", "differ");
  expect_refused({.form = Form::face,
                  .points = {{-1.0, 0.0}, {0.0, 0.0}, {1.0, 0.0}, {2.0, 0.0}},
                  .depth = not_a_number},
                 "depth", "> 0");
  expect_refused({.form = Form::hollow, .points = {{0.0, 0.0}}}, "radius", "> 0");
  expect_refused({.form = static_cast<Form>(7), .points = {{0.0, 0.0}}}, "form", "solid, face or hollow");
  // The vertices beyond ends that are free have no meaning.
  System system;
  system.add(
      ToldGround{.set = {{.form = Form::face,
                          .points = {{not_a_number, 0.0}, {1.0, 0.0}, {-1.0, 0.0}, {not_a_number, 0.0}},
                          .tail_is_free = true,
                          .head_is_free = true,
                          .depth = 1.0}}});
}

/// How the distance of an obstacle may be wrong.
enum class Wrong { distance, endless, normal, length };

/// A round hill that tells something wrong near its top.
class WrongHillKind;
struct WrongHill {
  static constexpr Role role = Role::obstacle;
  using Kind = WrongHillKind;
  Wrong what = Wrong::distance;
};

class WrongHillKind final : public GroundShapeKind {
public:
  static constexpr int part_dimension() { return 2; }
  static constexpr std::string_view part_label() { return "wrong hill"; }
  void add(const WrongHill& part, const PartCheck&) { parts_.push_back(part); }
  [[nodiscard]] std::unique_ptr<ShapeKind> clone() const override {
    return std::make_unique<WrongHillKind>(*this);
  }
  void remove(Index slot) override { parts_.erase(parts_.begin() + slot); }
  [[nodiscard]] std::string_view label() const override { return part_label(); }
  [[nodiscard]] int dimension() const override { return 2; }
  [[nodiscard]] Index size() const override { return static_cast<Index>(parts_.size()); }
  [[nodiscard]] MaterialId material(Index) const override { return {}; }
  [[nodiscard]] Gap gap(Index slot, const double* point) const override {
    constexpr double endless = std::numeric_limits<double>::infinity();
    const Vec<2> at(point[0], point[1]);
    Gap gap{at.norm() - 1.0, {at[0] / at.norm(), at[1] / at.norm(), 0.0}};
    if (gap.distance > 0.2) return gap;
    const Wrong what = parts_[slot].what;
    if (what == Wrong::distance) gap.distance = not_a_number;
    if (what == Wrong::endless) gap.distance = -endless;
    if (what == Wrong::normal) gap.normal[0] = not_a_number;
    if (what == Wrong::length) gap.normal[1] *= 2.0;
    return gap;
  }
  void fingerprint(Fingerprint&) const override {}

private:
  std::vector<WrongHill> parts_;
};

TEST(OwnObstacle, DistancesThatAreNoneAreNamed) {
  const auto scene = [](Wrong what, int balls) {
    System system;
    system.add(Gravity{{0.0, -gravity}});
    system.set_default_law(Surface{.friction = 0.3, .normal_restitution = 0.0});
    system.add(WrongHill{.what = what}, "hill");
    for (int i = 0; i < balls; ++i) {  // many: their centres are looked at together
      const BodyId ball =
          system.add(RigidBody{.mass = disc(1.0, 0.1), .position = {0.0, 1.5}, .velocity = {0.1, 0.0}});
      system.add(Disc{.body = ball, .radius = 0.1, .filter = {.groups = 2, .touches = 1}});
    }
    return system;
  };
  const auto expect_named = [&](Wrong what, const std::string& said) {
    for (const int balls : {1, 12}) {
      for (const Mode& mode : std::vector<Mode>{TimeStepping{}, EventDriven{}}) {
        Simulation simulation(scene(what, balls), mode);
        try {
          simulation.run_until(0.5);
          ADD_FAILURE() << "runs with a wrong " << said;
        } catch (const SolverError& error) {
          const std::string message = error.what();
          EXPECT_NE(message.find("wrong hill 'hill': " + said), std::string::npos) << message;
          EXPECT_NE(message.find("allowed: "), std::string::npos) << message;
        }
        EXPECT_GT(simulation.state().q[1], 0.9);
      }
    }
  };
  expect_named(Wrong::distance, "distance at (");
  expect_named(Wrong::endless, "distance at (");
  expect_named(Wrong::normal, "normal at (");
  expect_named(Wrong::length, "normal at (");
}

TEST(ShapesPage, ShowsWhatIsTestedHere) {
  const std::string source = carom_test::text_of("tests/bodies/own_shape_test.cpp");
  const auto blocks = carom_test::code_blocks("docs/shapes.md", "cpp");
  for (const std::string& block : blocks) EXPECT_NE(source.find(block), std::string::npos) << block;
  EXPECT_EQ(blocks.size(), 2U);
}

}  // namespace
