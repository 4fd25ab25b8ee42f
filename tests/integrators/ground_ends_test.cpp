// Bodies that lie flat beside an end of terrain, or a convex corner of it: they are held by the face that
// they lie on alone, in both modes, however far the solid reaches behind the next face.

#include "tests/integrators/event_driven/body_scenes.h"
#include "tests/integrators/throws.h"
#include "tests/random.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace {

using namespace body_scenes;

struct Scene {
  System system;
  BodyId body;
  Vec<2> normal;
  bool is_on_top = false;  // wholly
};

/// A convex polygon that lies on terrain of two metres, near one of its ends, or of the corners there.
Scene lies_near_an_end(std::uint64_t seed, bool corners, double drop) {
  carom_test::Random random(seed);
  Scene scene;
  System& system = scene.system;
  const double depth = random.uniform(0.1, 0.6), tilt = random.uniform(-0.3, 0.3),
               lean = random.uniform(-0.6, 0.6);
  const Vec<2> normal = incline(tilt), along(normal[1], -normal[0]);
  scene.normal = normal;
  system.add(Gravity{-g * normal});
  system.set_default_law({.friction = 0.5, .normal_restitution = 0.0});
  std::vector<Vec<2>> line{-along, along};
  if (corners) {
    line.insert(line.begin(), (lean - 1.0) * along - normal);
    line.push_back((1.0 - lean) * along - normal);
  }
  system.add(Terrain{.vertices = line, .depth = depth});
  const double width = random.uniform(0.1, 0.4);
  std::vector<Vec<2>> vertices{
      {0.0, 0.0}, {width, 0.0}, {width * random.uniform(0.2, 0.8), random.uniform(0.05, 0.2)}};
  if (random.below(2) == 0) {
    const double top = random.uniform(0.05, 0.2);
    vertices = {{0.0, 0.0},
                {width, 0.0},
                {width * random.uniform(0.6, 1.2), top},
                {width * random.uniform(-0.2, 0.4), top}};
  }
  const MassProperties<2> properties = polygon(1.0, vertices);
  for (Vec<2>& vertex : vertices) vertex -= properties.centre;
  const double from_end = random.uniform(0.0, depth);
  const double left = random.below(2) == 0 ? 1.0 - from_end - width : from_end - 1.0;
  scene.is_on_top = left >= -1.0 && left + width <= 1.0;
  const Vec<2> place = (left + properties.centre[0]) * along + (properties.centre[1] + drop) * normal;
  scene.body = system.add(RigidBody{.mass = centred(properties), .position = place, .angle = tilt});
  system.add(Polygon{.body = scene.body, .vertices = vertices});
  return scene;
}

TEST(GroundEnds, WhatLiesFlatBesideThemIsHeldByItsFaceAlone) {
  int scenes = 0;
  for (std::uint64_t seed = 0; seed < 150; ++seed) {
    for (const bool corners : {false, true}) {
      for (const bool events : {false, true}) {
        // In time stepping a body that has fallen stays sunk in by a fraction of a millimetre.
        Scene scene = lies_near_an_end(seed, corners, events ? 0.0 : 1e-3);
        if (!scene.is_on_top) continue;
        ++scenes;
        Simulation run = events ? Simulation(scene.system, EventDriven{.interval = 1e-2})
                                : Simulation(scene.system, TimeStepping{.step = 1e-3});
        const Vec<2> start = run.state().position(scene.body);
        run.run_until(0.1);
        EXPECT_LE((run.state().position(scene.body) - start).norm(), 2e-3)
            << seed << " " << corners << events;
        const std::vector<LastingContact> forces = run.contact_forces();
        EXPECT_EQ(forces.size(), 2U) << seed << " " << corners << events;
        for (const LastingContact& contact : forces) {
          EXPECT_GT(contact.normal[0] * scene.normal[0] + contact.normal[1] * scene.normal[1], 1.0 - 1e-6)
              << seed << " " << corners << events;
        }
      }
    }
  }
  EXPECT_GT(scenes, 500);
}

/// Places of a disc after a time, in each mode.
std::vector<Vec<2>> places_after(const System& system, BodyId body, double time) {
  std::vector<Vec<2>> places;
  for (const Mode& mode : std::vector<Mode>{
           TimeStepping{.step = 1e-3}, TimeStepping{.step = 1e-3, .impacts = ImpactTimes::located},
           TimeStepping{.step = 1e-3, .project_gaps = true}, EventDriven{}}) {
    Simulation run(system, mode);
    run.run_until(time);
    places.push_back(run.state().position(body));
  }
  return places;
}

// The side at the end of a line stands at a right angle to the last face. Below a cliff it reaches far under
// the line, and what is above the line is behind it.
TEST(GroundEnds, WhatIsAboveALineIsFreeOfTheSideAtItsEnd) {
  for (const double mirror : {1.0, -1.0}) {
    std::vector<Vec<2>> line{{-3.0 * mirror, 0.0}, {-0.2 * mirror, 0.0}, {0.0, 0.3}, {0.05 * mirror, -1.0}};
    if (mirror < 0.0) std::reverse(line.begin(), line.end());
    System system;
    system.add(Gravity{{0.0, -g}});
    system.set_default_law({.friction = 0.5, .normal_restitution = 0.0});
    system.add(Terrain{.vertices = line, .depth = 2.0});
    const BodyId ball = add_disc(system, 1.0, 0.1, {-1.7 * mirror, 0.35}, {0.0, 1.0});
    constexpr double time = 0.2;
    for (const Vec<2>& place : places_after(system, ball, time)) {
      EXPECT_NEAR(place[0], -1.7 * mirror, 1e-12);
      EXPECT_NEAR(place[1], 0.35 + time - 0.5 * g * time * time, 1e-12);
    }
  }
}

// Below its depth the ground touches nothing. What comes up from there is in it at once.
TEST(GroundEnds, WhatComesFromBelowEndsWithAnErrorThatNamesTheGround) {
  System system;
  system.add(Gravity{{0.0, -g}});
  system.set_default_law({.friction = 0.0, .normal_restitution = 0.5});
  system.add(Terrain{.vertices = {{-1.0, 0.0}, {0.0, 0.0}, {1.0, 0.0}}, .depth = 0.3}, "ground");
  add_disc(system, 1.0, 0.1, {0.0, -0.6}, {0.0, 6.0});
  Simulation run(system, EventDriven{.evaluation_limit = 50000});
  EXPECT_THROWS(SolverError, run.run_until(0.3), "on terrain 'ground' is -0.", "allowed: not below");
}

// A wall thinner than the depth of its line is hit on the side that a body comes to, and not from within.
TEST(GroundEnds, WallsThatAreThinnerThanTheDepthKeepTheirSides) {
  System system;
  system.add(Gravity{{0.0, -g}});
  system.set_default_law({.friction = 0.0, .normal_restitution = 0.5});
  system.add(Terrain{.vertices = {{-1.0, 0.0}, {0.0, 0.0}, {0.0, 1.0}, {0.1, 1.0}, {0.1, 0.0}, {1.0, 0.0}},
                     .depth = 0.5});
  const BodyId ball = add_disc(system, 1.0, 0.1, {0.3, 0.1}, {-1.0, 0.0});
  // It comes to the wall after 0.1 s, and goes back half as fast; steps hit up to one step late.
  for (const Vec<2>& place : places_after(system, ball, 0.3)) EXPECT_NEAR(place[0], 0.3, 2e-3);
}

}  // namespace
