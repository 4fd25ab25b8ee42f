// Shapes and obstacles of users that describe what is no set, or two of them, are refused by name.

#include <carom/carom.h>

#include "tests/model_error.h"

#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;

constexpr double gravity = 9.81;

/// A shape of bodies that describes what it is told.
struct Told {
  static constexpr Role role = Role::shape;
  static constexpr int dimension = 2;
  static constexpr std::string_view label = "told shape";
  using Kind = generic::FeatureShapeKind<Told>;

  BodyId body{};
  Outline set{};
  std::vector<RoundedPoint> points{};
  MaterialId material{};

  void check(const PartCheck&) const {}
  void features(std::vector<RoundedPoint>& out) const { out.insert(out.end(), points.begin(), points.end()); }
  Outline outline(const PartCheck&) const { return set; }
};

/// An obstacle that is the set it is told.
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

std::vector<RoundedPoint> corners_of(const Outline& set) {
  std::vector<RoundedPoint> points;
  for (const Vec<2>& vertex : set.vertices) points.push_back({{vertex[0], vertex[1], 0.0}, set.radius});
  return points;
}

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
  system.add(Told{.body = body, .set = set, .points = corners_of(set)}, "stone");
  Simulation(system, TimeStepping{}).step();
}

// It would lie on half-planes at one height and on all other ground at another one.
TEST(DescribedSets, PointsThatContradictTheOutlineAreRefused) {
  const Outline square{{{-0.1, -0.1}, {0.1, -0.1}, {0.1, 0.1}, {-0.1, 0.1}}, 0.02};
  const auto run = [&](const std::vector<RoundedPoint>& points) {
    System system;
    system.set_default_law(Surface{.friction = 0.3, .normal_restitution = 0.0});
    system.add(HalfPlane{.normal = {0.0, 1.0}});
    for (const double x : {0.0, 1.0}) {
      const BodyId body = system.add(RigidBody{.mass = disc(1.0, 0.1), .position = {x, 0.3}});
      system.add(Told{.body = body, .set = square, .points = points}, x == 0.0 ? "stone" : "");
    }
    Simulation(system, TimeStepping{}).step();
  };
  const std::vector<RoundedPoint> points = corners_of(square);
  EXPECT_NO_THROW(run(points));
  EXPECT_NO_THROW(run({}));  // it touches no half-planes
  const auto expect_refused = [&](const std::vector<RoundedPoint>& told) {
    EXPECT_MODEL_ERROR(run(told), "told shape 'stone': points that touch", "its outline",
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

TEST(DescribedSets, WhatIsNoConvexSetIsRefused) {
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

TEST(DescribedSets, WhatIsNoPieceIsRefused) {
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

TEST(DescribedSets, DistancesThatAreNoneAreNamed) {
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

}  // namespace
