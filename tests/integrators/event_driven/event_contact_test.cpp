// Traps with lasting contact: flat falls, corners, wedges, slopes, rolling and rest.

#include "tests/integrators/event_runs.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::count;
using carom_test::default_and_tight;

constexpr double g = 9.81;

BodyId add_box(System& system, double width, double height, const RigidBody& start) {
  RigidBody body = start;
  body.mass = planar::box(1.0, width, height);
  const BodyId id = system.add(body);
  const double x = 0.5 * width, y = 0.5 * height;
  system.add(Polygon{.body = id, .vertices = {{-x, -y}, {x, -y}, {x, y}, {-x, y}}});
  return id;
}

/// Runs and keeps an eye on energy, which never rises, and on a gap, which is never below rounding.
void run_watched(Simulation& simulation, double time, const std::function<double(const State&)>& gap) {
  double least = std::numeric_limits<double>::infinity(), highest = -least;
  double before = simulation.energy().total();
  simulation.observe([&](const Simulation& now) {
    least = std::min(least, gap(now.state()));
    const EnergyLedger& energy = now.energy();
    const double total = energy.total() - energy.flow(EnergyFlow::external);
    highest = std::max(highest, total - before);
    before = std::min(before, total);
  });
  simulation.run_until(time);
  EXPECT_GE(least, -1e-9);
  // Of 10 J; steps keep energy to their tolerance.
  EXPECT_LE(highest, 1e-9);
}

TEST(EventContact, ARodFallsFlat) {
  for (const EventDriven& options : default_and_tight()) {
    for (const double tilt : {0.0, 1e-9, 1e-8, 1e-6}) {
      for (const double friction : {0.0, 0.3}) {
        SCOPED_TRACE("tilt " + to_text(tilt) + ", friction " + to_text(friction));
        System system;
        system.add(Gravity{{0.0, -g}});
        system.add(HalfPlane{.normal = {0.0, 1.0}},
                   Surface{.friction = friction, .normal_restitution = 0.5, .tangential_restitution = 0.5});
        const BodyId id = system.add(RigidBody{.mass = rod(1.0, 2.0), .position = {0.0, 1.0}, .angle = tilt});
        system.add(Segment{.body = id, .from = {-1.0, 0.0}, .to = {1.0, 0.0}});
        Simulation simulation(system, options);
        run_watched(simulation, 5.0, [id](const State& state) {
          return state.position(id)[1] - std::abs(std::sin(state.angle(id)));
        });
        // It lies.
        EXPECT_NEAR(simulation.state().position(id)[1], 0.0, 1e-9);
        EXPECT_NEAR(simulation.state().angle(id), 0.0, 1e-9);
        EXPECT_NEAR(simulation.state().velocity(id)[1], 0.0, 1e-12);
        EXPECT_NEAR(simulation.state().spin(id), 0.0, 1e-12);
        EXPECT_GE(count(simulation, EventKind::impact), 10);
      }
    }
  }
}

TEST(EventContact, TwoBodiesOfOneComponentHitAtTheSameInstant) {
  for (const EventDriven& options : default_and_tight()) {
    System system;
    system.add(Gravity{{0.0, -g}});
    system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = 0.2, .normal_restitution = 0.7});
    const BodyId left = system.add(Particle{.mass = 1.0, .position = {-0.5, 1.0}});
    const BodyId right = system.add(Particle{.mass = 3.0, .position = {0.5, 1.0}});
    system.add(SpringDamper{
        .from = End<2>(left), .to = End<2>(right), .stiffness = 100.0, .damping = 0.0, .free_length = 1.0});
    Simulation simulation(system, options);
    simulation.run_until(0.5);
    ASSERT_EQ(simulation.events().size(), 2u);
    EXPECT_EQ(simulation.events()[0].time, simulation.events()[1].time);
    EXPECT_NE(simulation.events()[0].body, simulation.events()[1].body);
    EXPECT_NEAR(simulation.events()[0].time, std::sqrt(2.0 / g), 1e-13);
    simulation.run_until(5.0);
    EXPECT_NEAR(simulation.state().position(left)[1], 0.0, 1e-12);
    EXPECT_NEAR(simulation.state().position(right)[1], 0.0, 1e-12);
  }
}

TEST(EventContact, ABoxComesToRestInACorner) {
  for (const EventDriven& options : default_and_tight()) {
    for (const double e : {0.0, 0.5}) {
      System system;
      system.add(Gravity{{2.0, -g}});
      const Surface surface{.friction = 0.3, .normal_restitution = e, .tangential_restitution = e};
      system.add(HalfPlane{.normal = {0.0, 1.0}}, surface);
      system.add(HalfPlane{.point = {1.0, 0.0}, .normal = {-1.0, 0.0}}, surface);
      const BodyId id =
          add_box(system, 0.4, 0.2, {.position = {0.0, 0.5}, .velocity = {3.0, 0.0}, .spin = 1.0});
      Simulation simulation(system, options);
      run_watched(simulation, 10.0, [id](const State& state) {
        const double c = std::abs(std::cos(state.angle(id))), s = std::abs(std::sin(state.angle(id)));
        return std::min(state.position(id)[1] - 0.1 * c - 0.2 * s,
                        1.0 - state.position(id)[0] - 0.2 * c - 0.1 * s);
      });
      EXPECT_NEAR(simulation.state().velocity(id).norm(), 0.0, 1e-12) << e;
      EXPECT_NEAR(simulation.state().spin(id), 0.0, 1e-12) << e;
    }
  }
}

TEST(EventContact, ABodyWedgedBetweenTwoWalls) {
  // Just as wide as the slot: every wall touches from the start, with and without friction.
  for (const EventDriven& options : default_and_tight()) {
    for (const double friction : {0.0, 0.4}) {
      System system;
      system.add(Gravity{{0.0, -g}});
      const Surface surface{.friction = friction, .normal_restitution = 0.5, .tangential_restitution = 0.5};
      system.add(HalfPlane{.point = {-0.5, 0.0}, .normal = {1.0, 0.0}}, surface);
      system.add(HalfPlane{.point = {0.5, 0.0}, .normal = {-1.0, 0.0}}, surface);
      const BodyId id = add_box(system, 1.0, 0.5, {.position = {0.0, 10.0}});
      Simulation simulation(system, options);
      simulation.run_until(1.0);
      // Forces of friction are not unique; if none presses, it falls freely, else it may stay.
      const double fallen = 10.0 - simulation.state().position(id)[1];
      EXPECT_LE(fallen, 0.5 * g + 1e-9);
      if (friction == 0.0) {
        EXPECT_NEAR(fallen, 0.5 * g, 1e-9);
      }
      EXPECT_NEAR(simulation.state().position(id)[0], 0.0, 1e-9);
      EXPECT_NEAR(simulation.state().angle(id), 0.0, 1e-9);
      const double residual = simulation.energy().residual();
      EXPECT_NEAR(residual, 0.0, 1e-9 * simulation.energy().scale());
    }
  }
}

TEST(EventContact, ABallComesToRestInAV) {
  for (const EventDriven& options : default_and_tight()) {
    for (const double friction : {0.0, 0.2, 0.8}) {
      for (const bool has_spin : {false, true}) {
        SCOPED_TRACE("friction " + to_text(friction));
        System system;
        system.add(Gravity{{0.0, -g}});
        const Surface surface{.friction = friction, .normal_restitution = 0.4, .tangential_restitution = 0.4};
        for (const double side : {-1.0, 1.0}) system.add(HalfPlane{.normal = {side, 1.0}}, surface);
        BodyId id;
        double height = 0.0;
        if (has_spin) {
          id = system.add(RigidBody{.mass = disc(1.0, 0.2), .position = {0.3, 1.0}, .spin = 2.0});
          system.add(Disc{.body = id, .radius = 0.2});
          height = 0.2 * std::sqrt(2.0);
        } else {
          id = system.add(Particle{.mass = 1.0, .position = {0.3, 1.0}});
        }
        Simulation simulation(system, options);
        run_watched(simulation, 10.0, [&](const State& state) {
          return (state.position(id)[1] - std::abs(state.position(id)[0])) / std::sqrt(2.0) -
                 (has_spin ? 0.2 : 0.0);
        });
        EXPECT_NEAR(simulation.state().velocity(id).norm(), 0.0, 1e-9);
        EXPECT_NEAR(simulation.state().position(id)[1], height, 1e-8);
      }
    }
  }
}

TEST(EventContact, ABrickOnASlope) {
  for (const EventDriven& options : default_and_tight()) {
    const double slope = 0.3;
    for (const double ratio : {0.5, 0.999, 1.001, 2.0}) {
      SCOPED_TRACE(ratio);
      const double friction = ratio * std::tan(slope);
      System system;
      system.add(Gravity{{0.0, -g}});
      system.add(HalfPlane{.normal = incline(slope)},
                 Surface{.friction = friction, .normal_restitution = 0.5});
      const Vec<2> normal = incline(slope);
      const BodyId id = add_box(system, 1.0, 0.2, {.position = 0.1 * normal, .angle = slope});
      Simulation simulation(system, options);
      simulation.run_until(2.0);
      const double slid = (simulation.state().position(id) - 0.1 * normal).norm();
      const double free = std::max(0.0, g * (std::sin(slope) - friction * std::cos(slope)));
      EXPECT_NEAR(slid, 0.5 * free * 4.0, 1e-9);
      EXPECT_EQ(count(simulation, EventKind::impact), 0);
      EXPECT_NEAR(simulation.energy().residual(), 0.0, 1e-9);
      // Corners stay closed: two closings and no more.
      EXPECT_EQ(simulation.events().size(), 2u);
    }
  }
}

TEST(EventContact, ABrickThatSlidesUpStopsAndStaysOrTurns) {
  const double slope = 0.3, speed = 2.0;
  for (const EventDriven& options : default_and_tight()) {
    for (const double friction : {0.5, 0.1}) {
      System system;
      system.add(Gravity{{0.0, -g}});
      system.add(HalfPlane{.normal = incline(slope)},
                 Surface{.friction = friction, .normal_restitution = 0.0});
      const Vec<2> normal = incline(slope), up(std::cos(slope), std::sin(slope));
      const BodyId id =
          add_box(system, 1.0, 0.2, {.position = 0.1 * normal, .angle = slope, .velocity = speed * up});
      Simulation simulation(system, options);
      simulation.run_until(2.0);
      const double brake = g * (std::sin(slope) + friction * std::cos(slope)), stop = speed / brake;
      const double pull = std::max(0.0, g * (std::sin(slope) - friction * std::cos(slope)));
      const double rest = 2.0 - stop;
      const double expected = 0.5 * speed * stop - 0.5 * pull * rest * rest;
      const Vec<2> way = simulation.state().position(id) - 0.1 * normal;
      EXPECT_NEAR(way.dot(up), expected, 1e-9) << friction;
      EXPECT_NEAR(way.dot(normal), 0.0, 1e-12);
    }
  }
}

TEST(EventContact, ADiscRollsOnAtLittleCost) {
  for (const EventDriven& options : default_and_tight()) {
    System system;
    system.add(Gravity{{0.0, -g}});
    system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = 0.3, .normal_restitution = 0.5});
    const BodyId id =
        system.add(RigidBody{.mass = disc(1.0, 0.5), .position = {0.0, 0.5}, .velocity = {3.0, 0.0}});
    system.add(Disc{.body = id, .radius = 0.5});
    EventDriven rarely = options;
    rarely.interval = 10.0;
    Simulation simulation(system, rarely);
    simulation.run_until(1000.0);
    // Slides until v = 2/3 of 3 m/s, at mu g.
    const double slides = 1.0 / (0.3 * g);
    EXPECT_NEAR(simulation.state().velocity(id)[0], 2.0, 1e-9);
    EXPECT_NEAR(simulation.state().spin(id), -4.0, 1e-9);
    EXPECT_NEAR(simulation.state().position(id)[0], 2.5 * slides + 2.0 * (1000.0 - slides), 1e-6);
    EXPECT_NEAR(simulation.state().position(id)[1], 0.5, 1e-12);
    // longest_step makes 10,000 of them.
    EXPECT_LE(simulation.statistics().flow_steps, 10200);
    EXPECT_LE(simulation.events().size(), 3u);
  }
}

TEST(EventContact, ARestingBodyCostsNothing) {
  for (const EventDriven& options : default_and_tight()) {
    System system;
    system.add(Gravity{{0.0, -g}});
    system.add(HalfPlane{.normal = incline(0.1)}, Surface{.friction = 0.5, .normal_restitution = 0.5});
    const BodyId id = add_box(system, 1.0, 0.2, {.position = {0.0, 0.4}, .angle = 0.05});
    EventDriven rarely = options;
    rarely.interval = 1e5;
    Simulation simulation(system, rarely);
    simulation.run_until(20.0);
    const State before = simulation.state();
    const std::int64_t steps = simulation.statistics().flow_steps;
    const std::size_t events = simulation.events().size();
    simulation.run_until(1e6);
    EXPECT_EQ(simulation.state().q, before.q);
    EXPECT_NEAR(simulation.state().velocity(id).norm(), 0.0, 1e-14);
    EXPECT_LE(simulation.statistics().flow_steps - steps, 10);
    EXPECT_EQ(simulation.events().size(), events);
  }
}

TEST(EventContact, ADiscIsLiftedWhereItsNormalForceEnds) {
  for (const EventDriven& options : default_and_tight()) {
    System system;
    system.add(Gravity{{0.0, -g}});
    system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = 0.3, .normal_restitution = 0.5});
    const BodyId id = system.add(
        RigidBody{.mass = disc(1.0, 0.1), .position = {0.0, 0.1}, .velocity = {1.0, 0.0}, .spin = -10.0});
    system.add(Disc{.body = id, .radius = 0.1});
    system.add(AppliedForce{.on = id, .force = [](double t) { return Vec<2>(0.0, 2.0 * g * t); }});
    Simulation simulation(system, options);
    simulation.run_until(1.0);
    ASSERT_EQ(count(simulation, EventKind::lift_off), 1);
    const EventRecord& event = simulation.events().back();
    EXPECT_EQ(event.kind, EventKind::lift_off);
    EXPECT_NEAR(event.time, 0.5, 1e-9);
    // y'' = 2 g t - g from t = 1/2 on.
    EXPECT_NEAR(simulation.state().position(id)[1], 0.1 + g / 3.0 * 0.125, 1e-9);
  }
}

}  // namespace
