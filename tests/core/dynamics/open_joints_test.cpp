// Joints that a description leaves open: named with the gap, in metres or radians; none where a drawing has
// three digits.

#include <carom/carom.h>
#include <carom/core/assembly.h>
#include <carom/core/dynamics/joint_closure.h>
#include <carom/core/dynamics/open_joints.h>

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;

std::optional<ModelFinding> found_in(const System& system) {
  const Assembly assembly(system);
  State state = assembly.initial_state();
  return finding_of(system, close_joints(assembly, state).open);
}

/// A rod of a length, pinned to the origin at its end, whose centre is drawn somewhere.
System pendulum(Vec<2> centre, double length = 1.0) {
  System system;
  const BodyId body = system.add(RigidBody{.mass = rod(1.0, length), .position = centre});
  system.add(Revolute{.from = {ground, {0.0, 0.0}}, .to = {body, {-0.5 * length, 0.0}}});
  return system;
}

TEST(OpenJoints, AreNamedWithTheirGaps) {
  const std::optional<ModelFinding> found = found_in(pendulum({0.0, 0.0}));
  ASSERT_TRUE(found);
  EXPECT_EQ(found->kind, FindingKind::open_joint);
  EXPECT_EQ(to_string(found->kind), "open joint");
  EXPECT_EQ(found->parts, std::vector<std::string>{"revolute joint #0"});
  EXPECT_EQ(found->text,
            "revolute joint #0 by 0.5 m: open as described, so that bodies are moved to close it");
}

TEST(OpenJoints, AreNoneOfADrawingWithThreeDigits) {
  EXPECT_FALSE(found_in(pendulum({0.5, 0.0})));
  EXPECT_FALSE(found_in(pendulum({0.5, 4e-4})));
  EXPECT_TRUE(found_in(pendulum({0.5, 6e-4})));
  // In any unit of length.
  for (const double unit : {1e-6, 1e-3, 1e3}) {
    EXPECT_FALSE(found_in(pendulum({0.5 * unit, 4e-4 * unit}, unit))) << unit;
    EXPECT_TRUE(found_in(pendulum({0.5 * unit, 6e-4 * unit}, unit))) << unit;
  }
}

TEST(OpenJoints, OfAnglesAreToldInRadians) {
  for (const double length : {1e-3, 1.0, 1e3}) {
    for (const double off : {0.0, 9e-4, 1.1e-3, 0.25}) {
      System system = pendulum({0.5 * length, 0.0}, length);
      system.add(Driver{.joint = system.joints().front(), .position = [off](double) { return off; }});
      const std::optional<ModelFinding> found = found_in(system);
      EXPECT_EQ(found.has_value(), off > 1e-3) << length << ", " << off;
      if (found && off == 0.25) {
        EXPECT_NE(found->text.find("#1 by 0.25 rad:"), std::string::npos) << found->text;
      }
    }
  }
}

TEST(OpenJoints, AreListedOnceEachAndNotWithoutEnd) {
  System system;
  for (int i = 0; i < 6; ++i) {
    const BodyId body = system.add(RigidBody{.mass = rod(1.0, 1.0), .position = {0.7, 0.3 * i}});
    system.add(
        Revolute{.from = {ground, {0.0, 0.3 * i}}, .to = {body, {-0.5, 0.1}}});  // open along both axes
  }
  const std::optional<ModelFinding> found = found_in(system);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->parts.size(), 6U);
  EXPECT_NE(found->text.find(" and 3 more: open as described, so that bodies are moved to close them"),
            std::string::npos)
      << found->text;
}

TEST(OpenJoints, AreThoseOfParticlesToo) {
  for (const double length : {1.0, 1.1999}) {
    System system;
    const BodyId body = system.add(Particle{.mass = 1.0, .position = {0.0, -1.2}, .contact = false});
    system.add(Rod{.from = ground, .to = body, .length = length});
    EXPECT_EQ(found_in(system).has_value(), length == 1.0);
  }
}

TEST(OpenJoints, StandInTheReportAndInTheLogOnce) {
  System drawn = pendulum({0.0, 0.0});
  drawn.close_joints();
  Simulation simulation(drawn, TimeStepping{});
  std::vector<std::string> lines;
  simulation.log() = Log([&](LogLevel, std::string_view line) { lines.emplace_back(line); });
  ASSERT_EQ(simulation.report().findings.size(), 1U);
  EXPECT_GT(simulation.report().projected, 0.4);
  simulation.step();
  simulation.step();
  ASSERT_EQ(simulation.report().findings.size(), 1U);
  EXPECT_EQ(lines, std::vector<std::string>{"open joint: " + simulation.report().findings[0].text});
  // Behind an edit joints are as the run has closed them.
  simulation.edit([](System& system) { system.add(Gravity{{0.0, -9.81}}); });
  EXPECT_TRUE(simulation.report().findings.empty());
  simulation.edit([](System& system) {
    const BodyId loose = system.add(RigidBody{.mass = rod(1.0, 1.0), .position = {3.0, 0.0}});
    system.add(Revolute{.from = {system.bodies().front(), {0.5, 0.0}}, .to = {loose, {-0.5, 0.0}}});
  });
  ASSERT_EQ(simulation.report().findings.size(), 1U);
  EXPECT_EQ(simulation.report().findings[0].parts, std::vector<std::string>{"revolute joint #1"});
}

}  // namespace
