// Several faces in one flight: what closes on the way is found, though the body has left it by the end.

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;

constexpr double bowl_radius = 1.0, disc_radius = 0.1, step = 1e-3;  // [m, s]
constexpr int steps = 50;

/// A bowl of corners on a circle, which turn by `corner` each, the middle of a face lowest; a disc lies on
/// that.
System bowl(double corner, double speed, double friction, double gravity) {
  System system;
  system.add(Gravity{{0.0, -gravity}});
  system.set_default_law({.friction = friction, .normal_restitution = 0.0});
  std::vector<Vec<2>> corners;
  const int half = static_cast<int>(1.4 / corner);
  for (int i = -half; i < half; ++i) {
    const double at = (i + 0.5) * corner - 0.5 * std::numbers::pi;
    corners.emplace_back(bowl_radius * std::cos(at), bowl_radius * std::sin(at));
  }
  system.add(Terrain{.vertices = corners, .depth = 0.2});
  const double height = bowl_radius * std::cos(0.5 * corner) - disc_radius;
  const BodyId body = system.add(RigidBody{.mass = disc(1.0, disc_radius),
                                           .position = {0.0, -height},
                                           .velocity = {speed, 0.0},
                                           .spin = friction > 0.0 ? -speed / disc_radius : 0.0});
  system.add(Disc{.body = body, .radius = disc_radius});
  return system;
}

/// Where the centre of a disc without spin, friction and weight is: it goes along the faces, and each corner
/// takes what is normal to the next one: speed v cos(corner) is left.
Vec<2> slid(double corner, double speed, double time) {
  const double height = bowl_radius * std::cos(0.5 * corner) - disc_radius;
  const double half = height * std::tan(0.5 * corner);  // of the way along a face
  double direction = 0.0, left = time, ahead = half;
  Vec<2> at(0.0, -height);
  for (;;) {
    const Vec<2> along(std::cos(direction), std::sin(direction));
    if (speed * left <= ahead) return at + speed * left * along;
    at += ahead * along;
    left -= ahead / speed;
    direction += corner;
    speed *= std::cos(corner);
    ahead = 2.0 * half;
  }
}

class ManyFaces : public testing::TestWithParam<std::tuple<double, double>> {};

TEST_P(ManyFaces, AreMetOneByOne) {
  const auto [corner, speed] = GetParam();
  Simulation simulation(bowl(corner, speed, 0.0, 0.0),
                        TimeStepping{.step = step, .impacts = ImpactTimes::located});
  for (int i = 0; i < steps; ++i) simulation.step();
  const State& state = simulation.state();
  const Vec<2> exact = slid(corner, speed, steps * step);
  // Closings are found to rounding of 1 m in gaps that close with v sin(corner), 5 mm/s or more: 1e-13 s of
  // a corner, which shifts the body by 1e-15 m; up to 200 corners.
  EXPECT_NEAR(state.q[0], exact[0], 1e-12);
  EXPECT_NEAR(state.q[1], exact[1], 1e-12);
}

TEST_P(ManyFaces, HoldWhatRolls) {
  const auto [corner, speed] = GetParam();
  Simulation simulation(bowl(corner, speed, 0.8, 9.81),
                        TimeStepping{.step = step, .impacts = ImpactTimes::located});
  double deepest = 0.0;
  for (int i = 0; i < steps; ++i) {
    simulation.step();
    const State& state = simulation.state();
    // A disc that touches one face or more is nowhere farther out than at a corner.
    const double reach = (bowl_radius * std::cos(0.5 * corner) - disc_radius) / std::cos(0.5 * corner);
    deepest = std::max(deepest, std::hypot(state.q[0], state.q[1]) - reach);
  }
  // Rounding of 1 m at each corner. Tested against the last face of a step alone, the disc sinks by 0.9 mm in
  // 100 steps (corners of 1.4e-3 rad, 4 m/s).
  EXPECT_LT(deepest, 1e-13);
  EXPECT_NEAR(simulation.energy().residual(), 0.0, 1e-12);  // of some 30 J, rounding of 50 steps
}

// Less than one corner a step, to more than four.
INSTANTIATE_TEST_SUITE_P(Corners, ManyFaces,
                         testing::Combine(testing::Values(5.6e-3, 2.8e-3, 1.4e-3),
                                          testing::Values(4.0, 6.0)));

}  // namespace
