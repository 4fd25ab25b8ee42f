// The page docs/shapes.md: the shape of a body and the obstacle that it shows.

#include <carom/carom.h>

#include "tests/model_error.h"
#include "tests/page_blocks.h"
#include "tests/round_hill.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
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

TEST(ShapesPage, ShowsWhatIsTestedHere) {
  const std::string source = carom_test::text_of("tests/bodies/own_shape_test.cpp");
  const auto blocks = carom_test::code_blocks("docs/shapes.md", "cpp");
  for (const std::string& block : blocks) EXPECT_NE(source.find(block), std::string::npos) << block;
  EXPECT_EQ(blocks.size(), 2U);
}

}  // namespace
