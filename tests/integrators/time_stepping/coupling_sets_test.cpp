// Coupling sets, and scopes of steps: which bodies may act on each other, and what a step advances.

#include "tests/integrators/event_driven/body_scenes.h"

#include <carom/carom.h>
#include <carom/contact/detection/detector.h>
#include <carom/core/assembly.h>
#include <carom/core/numerics/never.h>
#include <carom/integrators/time_stepping/coupling_sets.h>
#include <carom/integrators/time_stepping/step_scope.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

namespace {

using namespace body_scenes;

/// Discs of radius 0.1 m in a row, a metre apart.
System discs(int count) {
  System system;
  system.set_default_law({.friction = 0.0, .normal_restitution = 1.0});
  for (int i = 0; i < count; ++i) add_disc(system, 1.0, 0.1, {1.0 * i, 0.0}, {0.0, 0.0}, 0.0);
  return system;
}

struct Sets {
  explicit Sets(const System& system) : assembly(system), detector(assembly), sets(assembly, detector) {
    for (const BodyOutline& outline : detector.outlines().of_bodies().list()) {
      const Vec<2> place(assembly.initial_state().q[3 * outline.body],
                         assembly.initial_state().q[3 * outline.body + 1]);
      boxes.push_back({place - Vec<2>::Constant(0.1), place + Vec<2>::Constant(0.1)});
    }
    sets.begin();
  }
  std::vector<Index> names() {
    std::vector<Index> all;
    for (Index c = 0; c < assembly.components().size(); ++c) all.push_back(sets.set_of(c));
    return all;
  }
  Assembly assembly;
  Detector detector;
  CouplingSets sets;
  std::vector<Box<2>> boxes;
};

TEST(CouplingSets, AreOfOneComponentUntilSomethingJoinsThem) {
  Sets at(discs(4));
  EXPECT_EQ(at.names(), (std::vector<Index>{0, 1, 2, 3}));
  EXPECT_FALSE(at.sets.join(at.boxes));
  EXPECT_EQ(at.names(), (std::vector<Index>{0, 1, 2, 3}));
}

TEST(CouplingSets, AreJoinedByBoxesThatOverlap) {
  Sets at(discs(4));
  at.boxes[3].extend(at.boxes[1]);  // on its way it passes the two before it
  EXPECT_TRUE(at.sets.join(at.boxes));
  EXPECT_EQ(at.names(), (std::vector<Index>{0, 1, 1, 1}));
  EXPECT_FALSE(at.sets.join(at.boxes));  // they are one
  at.sets.begin();
  EXPECT_EQ(at.names(), (std::vector<Index>{0, 1, 2, 3}));
}

TEST(CouplingSets, AreNotJoinedByBoxesOfWhatPassesThrough) {
  System system = discs(2);
  for (int i = 0; i < 2; ++i) {
    const BodyId body = system.add(RigidBody{.mass = planar::disc(1.0, 0.1), .position = {2.0 + i, 0.0}});
    system.add(Disc{.body = body, .radius = 0.1, .filter = {.groups = 2, .touches = 1}});
  }
  Sets at(system);
  Box<2> everywhere = at.boxes[2];
  everywhere.extend(at.boxes[3]);
  at.boxes[2] = at.boxes[3] = everywhere;
  EXPECT_FALSE(at.sets.join(at.boxes));
  at.boxes[0].extend(everywhere);
  EXPECT_TRUE(at.sets.join(at.boxes));
  EXPECT_EQ(at.sets.set_of(2), at.sets.set_of(3));  // by way of the first
  EXPECT_EQ(at.sets.set_of(1), at.sets.set_of(0));
}

TEST(CouplingSets, AreJoinedByIslands) {
  Sets at(discs(4));
  const std::array<Index, 2> pair{0, 2}, alone{1, 3};
  const std::array<StepIsland, 2> islands{StepIsland{pair, {}, {}, true}, StepIsland{alone, {}, {}, false}};
  at.sets.join(islands);
  EXPECT_EQ(at.names(), (std::vector<Index>{0, 1, 0, 3}));
}

TEST(StepScope, HasItsBodiesBatchByBatch) {
  const Assembly assembly(discs(6));
  const std::vector<Range> batches{{0, 3}, {3, 4}, {4, 6}};
  StepScope scope;
  const std::vector<Index> chosen{1, 2, 3, 5};
  scope.assign(assembly, batches, chosen);
  ASSERT_EQ(scope.batches().size(), 3U);
  EXPECT_EQ(scope.batches()[0].begin, 1U);
  EXPECT_EQ(scope.batches()[0].end, 3U);
  EXPECT_EQ(scope.batches()[1].begin, 3U);
  EXPECT_EQ(scope.batches()[1].end, 4U);
  EXPECT_EQ(scope.batches()[2].begin, 5U);
  EXPECT_EQ(scope.batches()[2].end, 6U);
  std::vector<Index> seen;
  scope.for_each([&](Index component) { seen.push_back(component); });
  EXPECT_EQ(seen, chosen);
  for (Index body = 0; body < 6; ++body) {
    const bool is_chosen = std::find(chosen.begin(), chosen.end(), body) != chosen.end();
    EXPECT_EQ(scope.has(body), is_chosen) << body;
    EXPECT_EQ(scope.chosen().has(body), is_chosen) << body;
  }
  EXPECT_EQ(scope.bodies(), 4U);
  EXPECT_EQ(scope.components(), 4U);
  scope.assign(assembly, batches, {});
  EXPECT_EQ(scope.bodies(), 0U);
  EXPECT_FALSE(scope.has(1));
}

}  // namespace
