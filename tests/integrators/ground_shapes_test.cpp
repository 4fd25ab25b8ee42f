// Bodies on walls, blocks, pegs, terrain, in boxes and circles, in both modes: closed forms.

#include "tests/energy/ledger_check.h"
#include "tests/integrators/event_run.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::ledger_closes;
using carom_test::LedgerWatch;
using carom_test::tight;

constexpr double g = 9.81;

BodyId add_brick(System& system, const Vec<2>& position, double angle, const Vec<2>& velocity) {
  const BodyId brick = system.add(
      RigidBody{.mass = box(1.0, 0.4, 0.2), .position = position, .angle = angle, .velocity = velocity},
      "brick");
  system.add(Polygon{.body = brick, .vertices = {{-0.2, -0.1}, {0.2, -0.1}, {0.2, 0.1}, {-0.2, 0.1}}});
  return brick;
}

BodyId add_disc(System& system, const Vec<2>& position, const Vec<2>& velocity, double spin,
                double radius = 0.1) {
  const BodyId body = system.add(
      RigidBody{.mass = disc(1.0, radius), .position = position, .velocity = velocity, .spin = spin}, "disc");
  system.add(Disc{.body = body, .radius = radius});
  return body;
}

/// A straight line in many faces, through the origin, rising at a slope [rad].
Terrain straight(double slope, int faces, double length) {
  Terrain line{.depth = 1.0};
  for (int i = 0; i <= faces; ++i) {
    // Uneven, so that no step of a run knows them.
    const double at = length * (static_cast<double>(i) + 0.3 * std::sin(static_cast<double>(i))) / faces;
    line.vertices.push_back((at - 0.5 * length) * Vec<2>(std::cos(slope), std::sin(slope)));
  }
  return line;
}

/// A brick that slides down a slope; on a plane, or on a line of many faces.
/// \param above how far it falls before [m]
System sliding_brick(bool on_plane, double friction, double above) {
  const double slope = 0.4;
  System system;
  system.add(Gravity{{0.0, -g}});
  const Surface law{.friction = friction, .normal_restitution = 0.5};
  if (on_plane) {
    system.add(HalfPlane{.normal = incline(slope)}, law);
  } else {
    system.add(straight(slope, 37, 40.0), law);
  }
  add_brick(system, 10.0 * Vec<2>(std::cos(slope), std::sin(slope)) + (above + 0.1) * incline(slope), slope,
            {0.0, 0.0});
  return system;
}

double largest_difference(const State& a, const State& b) {
  double most = 0.0;
  for (std::size_t i = 0; i < a.q.size(); ++i) most = std::max(most, std::abs(a.q[i] - b.q[i]));
  for (std::size_t i = 0; i < a.v.size(); ++i) most = std::max(most, std::abs(a.v[i] - b.v[i]));
  return most;
}

// Rounding of where faces join, over 2,000 steps.
TEST(GroundShapes, AStraightLineOfFacesIsAPlaneInTimeStepping) {
  for (const double friction : {0.0, 0.2, 0.5}) {
    Simulation on_plane(sliding_brick(true, friction, 1e-3), TimeStepping{.step = 1e-3});
    Simulation on_faces(sliding_brick(false, friction, 1e-3), TimeStepping{.step = 1e-3});
    for (int i = 0; i < 2000; ++i) {
      on_plane.step();
      on_faces.step();
      ASSERT_EQ(on_faces.report().contacts.size(), on_plane.report().contacts.size()) << i;
    }
    EXPECT_LE(largest_difference(on_plane.state(), on_faces.state()), 1e-12);
    EXPECT_TRUE(ledger_closes(on_faces.energy())) << on_faces.energy();
    EXPECT_EQ(on_faces.state().q[0] < 9.0, friction < 0.4);
    EXPECT_EQ(on_faces.statistics().impacts, on_plane.statistics().impacts);
    EXPECT_EQ(on_faces.report().contacts.size(), 2U);
  }
}

TEST(GroundShapes, AStraightLineOfFacesIsAPlaneFromEventToEvent) {
  for (const double friction : {0.0, 0.2}) {
    Simulation on_plane(sliding_brick(true, friction, 0.0), tight());
    Simulation on_faces(sliding_brick(false, friction, 0.0), tight());
    const LedgerWatch watch(on_faces);
    on_plane.run_until(2.0);
    on_faces.run_until(2.0);
    EXPECT_LE(largest_difference(on_plane.state(), on_faces.state()), 1e-11);
    EXPECT_TRUE(watch.closes());
    EXPECT_LT(on_faces.state().q[0], 6.0);
    for (const EventRecord& event : on_faces.events()) EXPECT_NE(event.kind, EventKind::impact) << event.time;
  }
}

// The work of friction is that of the half-plane; nothing else takes energy.
TEST(GroundShapes, ADiscRollsOverJointsAtItsSpeed) {
  for (const bool event_driven : {false, true}) {
    System system;
    system.add(Gravity{{0.0, -g}});
    system.add(straight(0.0, 41, 40.0), Surface{.friction = 0.6, .normal_restitution = 0.5});
    add_disc(system, {-10.0, 0.1}, {5.0, 0.0}, -50.0);
    Simulation simulation(system, event_driven ? Mode(tight()) : Mode(TimeStepping{.step = 1e-3}));
    simulation.run_until(4.0);
    EXPECT_NEAR(simulation.state().q[0], 10.0, 1e-12 * 20.0);
    EXPECT_NEAR(simulation.state().v[0], 5.0, 5e-12);
    EXPECT_NEAR(simulation.state().v[2], -50.0, 5e-11);
    EXPECT_NEAR(simulation.energy().lost(), 0.0, 1e-12 * simulation.energy().initial());
    EXPECT_EQ(simulation.statistics().impacts, 0);
  }
}

/// Period of theta'' = -w0^2 sin theta from rest at an amplitude, by the arithmetic-geometric mean.
double period_of(double w0, double amplitude) {
  double a = 1.0, b = std::cos(0.5 * amplitude);
  while (std::abs(a - b) > 1e-15) {
    const double mean = 0.5 * (a + b);
    b = std::sqrt(a * b);
    a = mean;
  }
  return 2.0 * std::numbers::pi / (w0 * a);
}

// A disc of radius r that rolls in a circle of radius R: (3/2) (R - r) theta'' = -g sin theta.
TEST(GroundShapes, ADiscSwingsInACircleWithThePeriodOfAPendulum) {
  const double radius = 1.0, r = 0.1, amplitude = 1.2;
  System system;
  system.add(Gravity{{0.0, -g}});
  system.add(CircleInside{.centre = {0.3, 2.0}, .radius = radius},
             Surface{.friction = 2.0, .normal_restitution = 0.0});
  const Vec<2> start = Vec<2>(0.3, 2.0) + (radius - r) * Vec<2>(std::sin(amplitude), -std::cos(amplitude));
  add_disc(system, start, {0.0, 0.0}, 0.0, r);
  Simulation simulation(system, tight());
  const LedgerWatch watch(simulation);
  const double energy = simulation.energy().total();
  const double period = period_of(std::sqrt(2.0 * g / (3.0 * (radius - r))), amplitude);
  simulation.run_until(3.0 * period);
  EXPECT_NEAR(simulation.state().q[0], start[0], 1e-8);
  EXPECT_NEAR(simulation.state().q[1], start[1], 1e-8);
  EXPECT_NEAR(simulation.state().q[2], 0.0, 1e-7);
  EXPECT_NEAR(simulation.energy().total(), energy, 1e-9 * energy);
  EXPECT_TRUE(watch.closes());
  simulation.run_until(3.5 * period);
  EXPECT_NEAR(simulation.state().q[0], 0.6 - start[0], 1e-8);
}

// It slips for v/(mu g), then it goes with the belt: half of the work of the belt is lost.
TEST(GroundShapes, ABrickOnAConveyorSlipsAndThenSticks) {
  const double speed = 1.5, friction = 0.25, slips = speed / (friction * g);
  for (const int ground_kind : {0, 1, 2, 3}) {
    for (const bool event_driven : {false, true}) {
      System system;
      system.add(Gravity{{0.0, -g}});
      const Surface law{.friction = friction, .normal_restitution = 0.0};
      if (ground_kind == 0) system.add(HalfPlane{.normal = {0.0, 1.0}, .surface_speed = speed}, law);
      if (ground_kind == 1) {
        Terrain belt = straight(0.0, 21, 20.0);
        belt.surface_speed = speed;
        system.add(belt, law);
      }
      if (ground_kind == 2)
        system.add(Wall{.from = {-9, -0.5}, .to = {9, -0.5}, .radius = 0.5, .surface_speed = speed}, law);
      if (ground_kind == 3)
        system.add(BoxInside{.lower = {-9, 0}, .upper = {9, 9}, .surface_speed = speed}, law);
      add_brick(system, {-1.0, 0.1}, 0.0, {0.0, 0.0});
      const double step = slips / 400.0;
      Simulation simulation(system, event_driven ? Mode(tight()) : Mode(TimeStepping{.step = step}));
      simulation.run_until(0.75 * slips);
      EXPECT_NEAR(simulation.state().v[0], 0.75 * speed, 1e-11);
      simulation.run_until(2.0 * slips);
      EXPECT_NEAR(simulation.state().v[0], speed, 1e-11);
      EXPECT_NEAR(simulation.state().q[0], -1.0 + 1.5 * speed * slips, 1e-11);
      EXPECT_NEAR(simulation.energy().flow(EnergyFlow::external), speed * speed, 1e-10);
      EXPECT_NEAR(simulation.energy().lost(), 0.5 * speed * speed, 1e-10);
      if (!event_driven) {
        EXPECT_TRUE(ledger_closes(simulation.energy())) << simulation.energy();
        continue;
      }
      EXPECT_NEAR(simulation.energy().residual(), 0.0, 1e-10);
      const auto stick =
          std::find_if(simulation.events().begin(), simulation.events().end(),
                       [](const EventRecord& event) { return event.kind == EventKind::stick; });
      ASSERT_NE(stick, simulation.events().end()) << ground_kind;
      EXPECT_NEAR(stick->time, slips, 1e-10);
      EXPECT_EQ(stick->obstacle, system.obstacles().front());
    }
  }
}

}  // namespace
