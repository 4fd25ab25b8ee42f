// The check at the end of a step: what is in each other is named, what touches is left alone.

#include "tests/integrators/event_driven/body_scenes.h"
#include "tests/model_error.h"

#include <carom/carom.h>
#include <carom/core/assembly.h>
#include <carom/integrators/event_driven/event_balance.h>
#include <carom/integrators/event_driven/event_instant.h>
#include <carom/integrators/event_driven/group_memory.h>
#include <carom/integrators/event_driven/group_set.h>
#include <carom/integrators/event_driven/overlap_check.h>

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <variant>

namespace {

using namespace body_scenes;

/// Two boxes side by side on a floor, a gap between them; and what the check says of them.
class TwoBoxes {
public:
  TwoBoxes(double gap, double height) {
    system_.set_default_law({.friction = 0.3, .normal_restitution = 0.0});
    system_.add(HalfPlane{.normal = {0.0, 1.0}});
    add_box(system_, 1.0, 0.2, 0.1, {-0.1, 0.05 + height});
    add_box(system_, 1.0, 0.2, 0.1, {0.1 + gap, 0.05 + height});
  }

  [[nodiscard]] std::string told() const {
    const Simulation start(system_, TimeStepping{.step = 1e-3});
    const Assembly assembly(system_);
    const Detector detector(assembly);
    const EventDriven options;
    OverlapCheck check(assembly, detector, options);
    Evaluation evaluation = make_evaluation(assembly);
    evaluate_positions(assembly, start.state().view(), evaluation);
    try {
      check.demand_apart(start.state(), evaluation, assembly.length_scales(), -0.25);
    } catch (const SolverError& error) {
      EXPECT_EQ(error.failure().time, -0.25);
      EXPECT_EQ(error.failure().step, 0.25);
      EXPECT_EQ(error.failure().parts.size(), 1U);
      return error.what();
    }
    return {};
  }

  /// At an event of a group of both.
  [[nodiscard]] std::string told_at_event() const {
    const Simulation start(system_, TimeStepping{.step = 1e-3});
    const Assembly assembly(system_);
    const Detector detector(assembly);
    const EventDriven options;
    GroupMemory memory(assembly, options, nullptr);
    GroupSet groups(assembly, detector, options, memory);
    const Index both[] = {0, 1};
    const std::unique_ptr<ClockGroup> group = groups.make(both);
    GroupParts& parts = group->parts();
    parts.motion.model().unknowns.gather(start.state(), parts.y);
    EventBalance balance;
    EventInstant at(parts.motion, memory.instant, 0.0, parts.y, balance);
    at.update();
    try {
      demand_apart(at, parts.failure);
    } catch (const SolverError& error) {
      EXPECT_EQ(error.failure().parts.size(), 1U);
      return error.what();
    }
    return {};
  }

private:
  System system_;
};

TEST(OverlapCheck, LeavesAloneWhatTouchesOrIsApart) {
  EXPECT_EQ(TwoBoxes(0.01, 0.01).told(), "");
  EXPECT_EQ(TwoBoxes(0.0, 0.0).told(), "");
  // 10 (gap_tolerance + relative_tolerance * 0.1 m + absolute_tolerance) = 1.1e-8 m.
  EXPECT_EQ(TwoBoxes(-1.0e-8, 0.0).told(), "");
}

TEST(OverlapCheck, NamesTheDeepestContact) {
  const std::string of_bodies = TwoBoxes(-1e-3, -1e-4).told();
  EXPECT_NE(of_bodies.find("rigid body #0 on polygon #1"), std::string::npos) << of_bodies;
  EXPECT_NE(of_bodies.find("is -0.001"), std::string::npos) << of_bodies;
  const std::string of_ground = TwoBoxes(-1e-4, -2e-3).told();
  EXPECT_NE(of_ground.find("on half-plane #0"), std::string::npos) << of_ground;
  EXPECT_NE(TwoBoxes(-1.3e-8, 0.0).told(), "");
}

TEST(OverlapCheck, LooksAtTheContactsOfAnEventToo) {
  EXPECT_EQ(TwoBoxes(0.01, 0.01).told_at_event(), "");
  EXPECT_EQ(TwoBoxes(0.0, 0.0).told_at_event(), "");
  EXPECT_EQ(TwoBoxes(0.01, -1.0e-8).told_at_event(), "");
  EXPECT_NE(TwoBoxes(0.01, -1.3e-8).told_at_event(), "");
  const std::string of_ground = TwoBoxes(-1e-4, -2e-3).told_at_event();
  EXPECT_NE(of_ground.find("on half-plane #0 is -0.002"), std::string::npos) << of_ground;
}

/// Two shapes that cross each other, or one and a wall. No corner of either is in the other one.
System crossing_shapes(bool capsules, bool wall) {
  System system;
  system.set_default_law({.friction = 0.3, .normal_restitution = 0.3});
  for (int i = 0; i < (wall ? 1 : 2); ++i) {
    const BodyId body = system.add(RigidBody{.mass = disc(1.0, 0.2), .angle = 0.1 + 1.5 * i});
    if (capsules) {
      system.add(Segment{.body = body, .from = {-0.5, 0.0}, .to = {0.5, 0.0}, .radius = 0.02});
    } else {
      system.add(Polygon{.body = body, .vertices = {{-0.5, -0.05}, {0.5, -0.05}, {0.5, 0.05}, {-0.5, 0.05}}});
    }
  }
  if (wall) system.add(Wall{.from = {0.0, -1.0}, .to = {0.0, 1.0}, .radius = 0.01}, "wall");
  return system;
}

// They were taken for apart, and the first step failed by a closing that it was said to have missed.
TEST(OverlapCheck, RefusesAStartInWhichShapesCross) {
  for (const bool capsules : {false, true}) {
    const System bodies = crossing_shapes(capsules, false), wall = crossing_shapes(capsules, true);
    EXPECT_MODEL_ERROR(Simulation(bodies, EventDriven{}), "of rigid body #0", "of rigid body #1",
                       "m at the start; allowed: not below -gap_tolerance");
    EXPECT_MODEL_ERROR(Simulation(wall, EventDriven{}), "of rigid body #0", "on wall 'wall'",
                       "m at the start; allowed: not below -gap_tolerance");
  }
}

// They are moved apart there.
TEST(OverlapCheck, AtAChangeOfTheModeShapesThatCrossComeApart) {
  Simulation simulation(crossing_shapes(false, false), TimeStepping{});
  simulation.switch_to(EventDriven{});
  // Each by half of the height of both at least, or out over an end.
  EXPECT_GT(simulation.report().projected, 0.05);
  simulation.run_until(1.0);
}

}  // namespace
