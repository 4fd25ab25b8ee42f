// Findings of System::check() stand in the report of a simulation and are written to its log once.

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;

/// Two discs that pass through each other: there is a law with ice only, of which nothing is.
System two_discs() {
  System system;
  const MaterialId steel = system.material("steel");
  system.between(steel, system.material("ice"), {.friction = 0.1, .normal_restitution = 1.0});
  for (const double x : {0.0, 1.0}) {
    const BodyId body = system.add(
        RigidBody{.mass = disc(1.0, 0.1), .position = {x, 0.0}, .velocity = {x > 0.5 ? -1.0 : 1.0, 0.0}});
    system.add(Disc{.body = body, .radius = 0.1, .material = steel});
  }
  return system;
}

TEST(Findings, AreInTheReportOfEveryStepAndOnceInTheLog) {
  for (const Mode& mode :
       {Mode(TimeStepping{}), Mode(TimeStepping{.control = StepControl{}}), Mode(EventDriven{})}) {
    Simulation simulation(two_discs(), mode);
    std::vector<std::string> lines;
    simulation.log() = Log([&](LogLevel level, std::string_view line) {
      EXPECT_EQ(level, LogLevel::warning);
      lines.emplace_back(line);
    });
    ASSERT_EQ(simulation.report().findings.size(), 2U);
    for (int i = 0; i < 3; ++i) simulation.step();
    ASSERT_EQ(simulation.report().findings.size(), 2U);
    EXPECT_EQ(simulation.report().findings[0].kind, FindingKind::law_without_effect);
    ASSERT_EQ(lines.size(), 2U);
    EXPECT_EQ(lines[0], "law without effect: " + simulation.report().findings[0].text);
    // An edit that leaves them says nothing, one that changes them says what is left.
    simulation.edit([](System& system) { system.add(Particle{.mass = 1.0, .contact = false}); });
    simulation.step();
    EXPECT_EQ(lines.size(), 2U);
    simulation.edit([](System& system) {
      for (const ShapeId shape : system.shapes()) system.remove(shape);
    });
    EXPECT_EQ(simulation.report().findings.size(), 1U);
    simulation.step();
    EXPECT_EQ(simulation.report().findings.size(), 1U);
    EXPECT_EQ(lines.size(), 3U);
  }
}

TEST(Findings, StayAfterAStepThatFails) {
  System system = two_discs();
  const BodyId body = system.bodies().front();
  system.add(AppliedForce{.on = body, .force = [](double t) {
                            return Vec<2>(t > 0.01 ? std::numeric_limits<double>::quiet_NaN() : 0.0, 0.0);
                          }});
  for (const Mode& mode : {Mode(TimeStepping{}), Mode(EventDriven{})}) {
    Simulation simulation(system, mode);
    EXPECT_THROW(simulation.run_until(0.1), SolverError);
    EXPECT_EQ(simulation.report().findings.size(), 2U);
  }
}

}  // namespace
