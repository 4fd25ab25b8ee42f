// A body that a driver, or a shape on ground, pushes against what does not give way: there are no impulses,
// and the error names who pushes, whichever component it belongs to, in both modes.

#include "tests/integrators/throws.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <string>

namespace {

using namespace carom;
using namespace carom::planar;

System between(bool driver) {
  System system;
  system.set_default_law({.friction = 0.0, .normal_restitution = 0.0});
  system.add(HalfPlane{.point = {1.0, 0.0}, .normal = {-1.0, 0.0}}, "wall");
  const BodyId ball = system.add(RigidBody{.mass = disc(1.0, 0.1), .position = {0.85, 0.0}}, "ball");
  system.add(Disc{.body = ball, .radius = 0.1}, "ball");
  if (driver) {
    const BodyId ram = system.add(RigidBody{.mass = disc(1.0, 0.1), .position = {0.6, 0.0}}, "ram");
    system.add(Disc{.body = ram, .radius = 0.1}, "ram");
    const JointId guide = system.add(Prismatic{.from = ground, .to = ram, .axis = {1.0, 0.0}}, "guide");
    system.add(Driver{.joint = guide, .position = [](double t) { return t; }}, "press");
  } else {
    const PrescribedMotion motion{.displacement = [](double t) { return Vec<2>(t, 0.0); },
                                  .velocity = [](double) { return Vec<2>(1.0, 0.0); }};
    system.add(HalfPlane{.point = {0.5, 0.0}, .normal = {1.0, 0.0}, .motion = motion}, "plate");
  }
  return system;
}

TEST(DrivenJam, NamesTheDriverOfAnotherComponent) {
  for (const Mode& mode : {Mode(TimeStepping{}), Mode(EventDriven{})}) {
    Simulation simulation(between(true), mode);
    EXPECT_THROWS(SolverError, simulation.run_until(1.0), "no solution", "driven by driver 'press'", "wall");
    EXPECT_LT(simulation.state().time, 0.2);
  }
}

TEST(DrivenJam, NamesTheShapeOnGroundThatPushes) {
  for (const Mode& mode : {Mode(TimeStepping{}), Mode(EventDriven{})}) {
    Simulation simulation(between(false), mode);
    EXPECT_THROWS(SolverError, simulation.run_until(1.0), "pressed by the motion of half-plane 'plate'",
                  "wall");
  }
}

}  // namespace
