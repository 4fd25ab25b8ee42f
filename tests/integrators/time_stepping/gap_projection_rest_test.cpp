// Option project_gaps in lasting contact: bodies come to rest, stay there, and gain no energy.

#include "tests/energy/ledger_check.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::ledger_closes;

constexpr double g = 9.81;

std::vector<Vec<2>> corners(double width, double height) {
  const double x = 0.5 * width, y = 0.5 * height;
  return {{-x, -y}, {x, -y}, {x, y}, {-x, y}};
}

enum class Floor : std::uint8_t { half_plane, terrain, body };

/// A box, or a disc, that falls by 2 cm on a slope, on which friction holds it.
System falls(Floor floor, bool round, double slope, double e) {
  const Vec<2> normal = incline(slope), along(normal[1], -normal[0]);
  System system;
  system.add(Gravity{{0.0, -g}});
  system.set_default_law({.friction = 0.8, .normal_restitution = e, .rolling_resistance = round ? 0.1 : 0.0});
  if (floor == Floor::half_plane) system.add(HalfPlane{.normal = normal});
  if (floor == Floor::terrain) {
    system.add(Terrain{.vertices = {-3.0 * along, 0.03 * along, 3.0 * along}, .depth = 0.5});
  }
  if (floor == Floor::body) {
    const BodyId slab =
        system.add(RigidBody{.mass = box(5.0, 6.0, 0.4), .position = -0.2 * normal, .angle = slope}, "slab");
    system.add(Polygon{.body = slab, .vertices = corners(6.0, 0.4)});
    system.add(Weld{.from = {ground, -0.2 * normal}, .to = {slab, {0.0, 0.0}}});
  }
  const BodyId body = system.add(
      RigidBody{
          .mass = round ? disc(1.0, 0.1) : box(1.0, 0.4, 0.2), .position = 0.12 * normal, .angle = slope},
      "falling");
  if (round) {
    system.add(Disc{.body = body, .radius = 0.1});
  } else {
    system.add(Polygon{.body = body, .vertices = corners(0.4, 0.2)});
  }
  return system;
}

void bounces_come_to_an_end(double h) {
  // Bounces of a step or two end in a contact that lasts: every step carries the weight, nothing moves. They
  // must not live on what the projection lifts.
  for (const Floor floor : {Floor::half_plane, Floor::terrain, Floor::body}) {
    for (const bool round : {false, true}) {
      for (const double slope : {0.0, 0.3}) {
        for (const double e : {0.0, 0.3, 0.5, 0.6, 0.8, 0.9}) {
          Simulation simulation(falls(floor, round, slope, e), TimeStepping{.step = h, .project_gaps = true});
          // The last bounces of e = 0.9 lose a twentieth of their speed in a step.
          const double rest = e > 0.8 ? 5.0 : 2.8;
          simulation.run_until(rest);
          const std::int64_t impacts = simulation.statistics().impacts;
          const BodyId body = simulation.system().body("falling");
          const Vec<2> place = simulation.state().position(body);
          double least = std::numeric_limits<double>::infinity(), most = 0.0;
          simulation.observe([&](const Simulation& run) {
            const double force = force_on(run.report(), body).impulse.norm() / h;
            least = std::min(least, force);
            most = std::max(most, force);
          });
          simulation.run_until(rest + 0.7);
          const auto what = [&] {
            return testing::Message()
                   << static_cast<int>(floor) << " " << round << " " << slope << " " << e << " " << h;
          };
          EXPECT_EQ(simulation.statistics().impacts, impacts) << what();
          // Speeds fall by a factor a step, to rounding: 1e-15 m/s over steps of 1 ms, of 9.81 N.
          EXPECT_NEAR(least, g, 1e-9) << what();
          EXPECT_NEAR(most, g, 1e-9) << what();
          EXPECT_NEAR((simulation.state().position(body) - place).norm(), 0.0, 1e-12) << what();
          EXPECT_TRUE(ledger_closes(simulation.energy())) << what();
        }
      }
    }
  }
}

TEST(GapProjectionAtRest, BouncesComeToAnEnd) { bounces_come_to_an_end(7e-3); }

TEST(GapProjectionAtRestLong, BouncesComeToAnEnd) { bounces_come_to_an_end(1e-3); }

TEST(GapProjectionAtRest, BouncesAreNoHigherThanTheLawSays) {
  // A disc that falls by 2 cm: after n impacts it comes up to e^2n of that, and no step has more energy than
  // one before. Impacts are noticed up to a step late, which must not make them stronger.
  for (const Floor floor : {Floor::half_plane, Floor::terrain, Floor::body}) {
    for (const double e : {0.6, 0.8, 0.95, 0.99}) {
      for (const double h : {1e-3, 7e-3}) {
        Simulation simulation(falls(floor, true, 0.0, e), TimeStepping{.step = h, .project_gaps = true});
        const BodyId body = simulation.system().body("falling");
        const double start = simulation.energy().total();
        double energy = start;
        simulation.observe([&](const Simulation& run) {
          const double now = run.energy().total();
          EXPECT_LE(now, energy + 1e-13) << e << " " << h;  // rounding of 1 J
          energy = now;
          const double height = run.state().position(body)[1] - 0.1;
          const double allowed = 0.02 * std::pow(e, 2.0 * static_cast<double>(run.statistics().impacts));
          if (run.state().velocity(body)[1] > 0.0) {
            EXPECT_LE(height, allowed + 1e-12) << e << " " << h;
          }
        });
        simulation.run_until(1.0);
        EXPECT_TRUE(ledger_closes(simulation.energy()));
      }
    }
  }
}

TEST(GapProjectionAtRest, AJointedBodyBouncesNoHigherThanTheLawSays) {
  // A rod on a pin falls on a peg with its middle: gravity presses the contact by what the pin leaves of it.
  for (const double e : {0.6, 0.9}) {
    for (const double h : {1e-3, 5e-3}) {
      System system;
      system.add(Gravity{{0.0, -g}});
      system.set_default_law({.friction = 0.0, .normal_restitution = e});
      system.add(Peg{.centre = {0.5, -0.1}, .radius = 0.1});
      const BodyId rod = system.add(RigidBody{.mass = planar::rod(1.0, 1.0), .position = {0.5, 0.02}}, "rod");
      system.add(Segment{.body = rod, .from = {-0.5, 0.0}, .to = {0.5, 0.0}});
      system.add(Revolute{.from = {ground, {0.0, 0.02}}, .to = {rod, {-0.5, 0.0}}});
      Simulation simulation(system, TimeStepping{.step = h, .project_gaps = true});
      simulation.run_until(3.0);
      const std::int64_t impacts = simulation.statistics().impacts;
      simulation.run_until(3.5);
      EXPECT_EQ(simulation.statistics().impacts, impacts) << e << " " << h;
      EXPECT_NEAR(simulation.state().spin(rod), 0.0, 1e-9) << e << " " << h;
    }
  }
}

TEST(GapProjectionAtRest, ABlockThatSlidesDownAFreeWedgeNeitherTipsNorGains) {
  // Block and wedge without friction: constant accelerations, which steps follow to rounding. A corner whose
  // gap rounding opens for a step must not be lost: what projection then lifts is energy from nothing.
  constexpr double slope = 0.5, mass = 1.0, heavy = 3.0, width = 3.0;
  const Vec<2> down(std::cos(slope), -std::sin(slope)), normal(std::sin(slope), std::cos(slope));
  System system;
  system.add(Gravity{{0.0, -g}});
  system.set_default_law({.friction = 0.0, .normal_restitution = 0.0});
  system.add(HalfPlane{.normal = {0.0, 1.0}});
  const double height = width * std::tan(slope);
  std::vector<Vec<2>> triangle{{0.0, 0.0}, {width, 0.0}, {0.0, height}};
  const MassProperties<2> properties = polygon(heavy, triangle);
  for (Vec<2>& vertex : triangle) vertex -= properties.centre;
  const BodyId wedge = system.add(RigidBody{.mass = centred(properties), .position = properties.centre});
  system.add(Polygon{.body = wedge, .vertices = triangle});
  const Vec<2> start = Vec<2>(0.0, height) + 0.6 * down + 0.05 * normal;
  const BodyId block = system.add(RigidBody{.mass = box(mass, 0.3, 0.1), .position = start, .angle = -slope});
  system.add(Polygon{.body = block, .vertices = corners(0.3, 0.1)});
  const double s = std::sin(slope), pushed = -mass * g * s * std::cos(slope) / (heavy + mass * s * s);
  for (const double h : {2e-3, 1.01e-3, 1e-3, 5e-4}) {
    Simulation simulation(system, TimeStepping{.step = h, .project_gaps = true});
    const double energy = simulation.energy().total();
    simulation.run_until(0.5);
    EXPECT_NEAR(simulation.state().velocity(wedge)[0], 0.5 * pushed, 1e-9) << h;
    EXPECT_NEAR(simulation.state().angle(block), -slope, 1e-9) << h;
    EXPECT_NEAR(simulation.energy().total(), energy, 1e-9) << h;
    EXPECT_NEAR(simulation.energy().flow(EnergyFlow::projection), 0.0, 1e-9) << h;
  }
}

}  // namespace
