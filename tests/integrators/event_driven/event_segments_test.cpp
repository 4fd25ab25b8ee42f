// Segments without thickness on bodies: corners of others do not pass through them, from either side.

#include "tests/integrators/event_driven/body_scenes.h"
#include "tests/integrators/event_run.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>

namespace {

using namespace body_scenes;
using carom_test::tight;

/// A box that falls on a slope, which is a half-plane, or a long segment of a body that is fixed.
/// \param turned whether the segment's ends are given the other way round
System falls_on(bool segment, bool turned, double slope, double angle, double spin) {
  const Vec<2> normal = incline(slope), along(normal[1], -normal[0]);
  System system;
  system.add(Gravity{{0.0, -g}});
  system.set_default_law({.friction = 0.4, .normal_restitution = 0.6, .tangential_restitution = 0.2});
  if (segment) {
    const BodyId rod = system.add(RigidBody{.mass = planar::rod(1.0, 8.0)}, "rod");
    const double end = turned ? -4.0 : 4.0;
    system.add(Segment{.body = rod, .from = -end * along, .to = end * along});
    system.add(Weld{.from = ground, .to = {rod, {0.0, 0.0}}});
  } else {
    system.add(HalfPlane{.normal = normal});
  }
  const BodyId falling = system.add(RigidBody{.mass = box(1.0, 0.3, 0.2),
                                              .position = 0.5 * normal,
                                              .angle = angle,
                                              .velocity = {0.3, -0.2},
                                              .spin = spin},
                                    "box");
  system.add(Polygon{.body = falling, .vertices = corners_of(0.3, 0.2)});
  return system;
}

TEST(EventSegments, CornersHitThemAsTheyHitAHalfPlane) {
  for (const bool turned : {false, true}) {
    for (const double slope : {0.0, 0.4, 2.8}) {
      for (const double angle : {0.0, 0.3, 0.8}) {
        for (const double spin : {0.0, -7.0, 20.0}) {
          if (slope > 2.0 && angle == 0.3) continue;
          // A slope beyond a right angle is hit from below, where gravity draws away: thrown at it.
          System onto = falls_on(true, turned, slope, angle, spin),
                 flat = falls_on(false, turned, slope, angle, spin);
          Simulation segment(onto, tight()), plane(flat, tight());
          const Vec<2> up = slope > 2.0 ? Vec<2>(0.0, 6.0) : Vec<2>(0.0, 0.0);
          for (Simulation* const run : {&segment, &plane}) {
            State state = run->state();
            state.velocity(run->system().body("box")) += up;
            run->set_state(state);
            run->run_until(0.6);
          }
          const BodyId one = segment.system().body("box"), other = plane.system().body("box");
          EXPECT_GT(plane.statistics().events[static_cast<std::size_t>(EventKind::impact)], 0)
              << slope << " " << angle << " " << spin;
          // Some impacts, each of which makes rounding a little larger.
          EXPECT_NEAR((segment.state().position(one) - plane.state().position(other)).norm(), 0.0, 1e-9)
              << turned << " " << slope << " " << angle << " " << spin;
          EXPECT_NEAR(segment.state().angle(one), plane.state().angle(other), 1e-9)
              << turned << " " << slope << " " << angle << " " << spin;
        }
      }
    }
  }
}

TEST(EventSegments, EndsOfOthersHitThem) {
  for (const double angle : {0.5, 1.4, -0.9, 2.5}) {
    Vec<2> on_plane = Vec<2>::Zero();
    for (const bool segment : {false, true}) {
      System system = falls_on(segment, false, 0.2, 0.0, 0.0);
      const BodyId body = system.add(
          RigidBody{.mass = planar::rod(1.0, 0.4), .position = {1.0, 0.8}, .angle = angle, .spin = 1.0},
          "falling");
      system.add(Segment{.body = body, .from = {-0.2, 0.0}, .to = {0.2, 0.0}});
      Simulation simulation(system, tight());
      simulation.run_until(0.8);
      const Vec<2> at = simulation.state().position(body);
      if (!segment) on_plane = at;
      EXPECT_NEAR((at - on_plane).norm(), 0.0, 1e-9) << angle;
    }
  }
}

TEST(EventSegments, WhatFliesStraightAtThemHitsThem) {
  // No loads: the distance falls by the speed times the time to 0, and rises by as much on the other side, so
  // that the bound of its rate alone does not tell that it was closed. Time stepping with located impacts
  // does the same, from either side, whichever end of the segment is the first: flights are exact in both.
  for (const double side : {1.0, -1.0}) {
    for (const bool turned : {false, true}) {
      for (const bool polygon : {false, true}) {
        System system;
        system.set_default_law({.friction = 0.0, .normal_restitution = 0.5});
        const BodyId wall = system.add(RigidBody{.mass = planar::rod(1.0, 2.0)});
        const double end = turned ? -1.0 : 1.0;
        system.add(Segment{.body = wall, .from = {-end, 0.0}, .to = {end, 0.0}});
        system.add(Weld{.from = ground, .to = {wall, {0.0, 0.0}}});
        const BodyId body = system.add(RigidBody{.mass = polygon ? box(1.0, 0.2, 0.2) : planar::rod(1.0, 0.4),
                                                 .position = {0.3, 0.5 * side},
                                                 .angle = polygon ? 0.5 : 1.2,
                                                 .velocity = {0.0, -side}});
        if (polygon) {
          system.add(Polygon{.body = body, .vertices = corners_of(0.2, 0.2)});
        } else {
          system.add(Segment{.body = body, .from = {-0.2, 0.0}, .to = {0.2, 0.0}});
        }
        Simulation events(system, tight());
        Simulation steps(system, TimeStepping{.step = 1.37e-3, .impacts = ImpactTimes::located});
        events.run_until(1.0);
        steps.run_until(1.0);
        EXPECT_GT(side * events.state().position(body)[1], 0.2) << turned << " " << polygon;
        // One impact or two, of rows that turn within a step by rounding only.
        EXPECT_NEAR((events.state().position(body) - steps.state().position(body)).norm(), 0.0, 1e-9)
            << side << " " << turned << " " << polygon;
        EXPECT_NEAR(events.state().angle(body), steps.state().angle(body), 1e-9)
            << side << " " << turned << " " << polygon;
      }
    }
  }
}

TEST(EventSegments, FreeOnesAreHitToo) {
  // A fast box meets a segment in free flight (momentum of both is kept), and goes round the end of another.
  System system;
  system.set_default_law({.friction = 0.3, .normal_restitution = 0.5});
  const BodyId rod = system.add(RigidBody{.mass = planar::rod(1.3, 0.26),
                                          .position = {0.0, 0.0},
                                          .angle = 3.9,
                                          .velocity = {-2.5, 0.5},
                                          .spin = 11.0});
  system.add(Segment{.body = rod, .from = {-0.13, 0.0}, .to = {0.13, 0.0}});
  const BodyId hits = add_box(system, 1.0, 0.18, 0.1, {-0.12, 0.05}, -2.6, {1.4, 1.7}, -53.0);
  Simulation simulation(system, tight());
  const double before = simulation.energy().total();
  simulation.run_until(0.05);
  const Vec<2> sum =
      1.3 * Vec<2>(simulation.state().velocity(rod)) + Vec<2>(simulation.state().velocity(hits));
  EXPECT_NEAR((sum - (1.3 * Vec<2>(-2.5, 0.5) + Vec<2>(1.4, 1.7))).norm(), 0.0, 1e-12);
  EXPECT_GT(simulation.statistics().events[static_cast<std::size_t>(EventKind::impact)], 0);
  EXPECT_LT(simulation.energy().total(), before);

  System round;
  round.set_default_law({.friction = 0.3, .normal_restitution = 0.5});
  const BodyId fixed = round.add(RigidBody{.mass = planar::rod(1.0, 2.0)});
  round.add(Segment{.body = fixed, .from = {-1.0, 0.0}, .to = {1.0, 0.0}});
  round.add(Weld{.from = ground, .to = {fixed, {0.0, 0.0}}});
  // Its corners pass the end by 3 mm at the least; the middle stays above, then comes below.
  const BodyId passing = add_box(round, 1.0, 0.4, 0.1, {1.205, 0.3}, 0.0, {0.0, -1.0});
  Simulation passes(round, tight());
  passes.run_until(0.6);
  EXPECT_EQ(passes.statistics().events[static_cast<std::size_t>(EventKind::impact)], 0);
  EXPECT_NEAR(passes.state().position(passing)[1], -0.3, 1e-12);
}

}  // namespace
