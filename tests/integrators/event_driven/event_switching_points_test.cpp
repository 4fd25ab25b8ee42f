#include <carom/carom.h>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace {

using namespace carom;
using namespace carom::planar;

constexpr double gravity = 9.81;

// A mass dropped from the point where its cable is held: free fall over the free length L, then, with x the
// stretch, x'' = g - k x/m with x(0) = 0 and x'(0) = sqrt(2 g L), until it is slack again.
TEST(EventSwitchingPoints, MassOnACableGoesTautAndSlackOnTime) {
  constexpr double mass = 2.0, stiffness = 500.0, length = 1.5;
  System system;
  system.add(Gravity{{0.0, -gravity}});
  const BodyId body = system.add(Particle{.mass = mass, .position = {0.0, -1e-3}});
  const ElementId cable = system.add(
      Cable{.from = {ground, {0.0, 0.0}}, .to = body, .stiffness = stiffness, .free_length = length},
      "cable");
  Simulation simulation(system, EventDriven{.relative_tolerance = 1e-11, .absolute_tolerance = 1e-13});
  simulation.run_until(1.5);

  const double drop = length - 1e-3;
  const double taut = std::sqrt(2.0 * drop / gravity), speed = gravity * taut;
  const double omega = std::sqrt(stiffness / mass), sag = mass * gravity / stiffness;
  // x = sag (1 - cos) + (speed/omega) sin = 0 again at omega t = 2 pi - 2 atan(sag omega/speed).
  const double stretched =
      (2.0 * std::numbers::pi - 2.0 * (std::numbers::pi / 2.0 - std::atan(sag * omega / speed))) / omega;
  std::vector<double> passages;
  for (const EventRecord& event : simulation.events()) {
    if (event.kind != EventKind::switching_point) continue;
    EXPECT_EQ(event.element, cable);
    passages.push_back(event.time);
  }
  ASSERT_GE(passages.size(), 2U);
  // 1e-11 of every step, a dozen of them.
  EXPECT_NEAR(passages[0], taut, 1e-10);
  EXPECT_NEAR(passages[1], taut + stretched, 1e-9);
  EXPECT_NEAR(simulation.energy().residual(), 0.0, 1e-9);
}

// A force that is switched on and off: a particle's velocity is the time it was on.
TEST(EventSwitchingPoints, StepsEndAtDiscontinuitiesOfLaws) {
  System system;
  const BodyId body = system.add(Particle{.mass = 1.0});
  system.add(
      AppliedForce{.on = body,
                   .force = [](double time) { return Vec<2>(time >= 0.3 && time < 0.7 ? 2.0 : 0.0, 0.0); },
                   .breaks = {0.3, 0.7}});
  Simulation simulation(system, EventDriven{});
  simulation.run_until(1.0);
  // Within a step the law is polynomial: nothing but rounding is left.
  EXPECT_NEAR(simulation.state().velocity(body)[0], 0.8, 1e-12);
  EXPECT_NEAR(simulation.state().position(body)[0], 0.16 + 0.24, 1e-12);
  std::vector<double> times;
  for (const EventRecord& event : simulation.events()) {
    EXPECT_EQ(event.kind, EventKind::discontinuity);
    times.push_back(event.time);
  }
  EXPECT_EQ(times, (std::vector<double>{0.3, 0.7}));
  EXPECT_NEAR(simulation.energy().residual(), 0.0, 1e-12);
}

}  // namespace
