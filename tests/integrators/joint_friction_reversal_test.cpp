// Dry friction in a joint of a mechanism that turns round: both modes against equations of their own.

#include <carom/carom.h>

#include "tests/shares.h"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace carom;
using namespace carom::planar;

/// A slider-crank, crank 0.5 m, rod 1 m, whose crank stands at 0.3 rad and turns at 3 rad/s, against gravity:
/// it turns round. \param in_guide whether the slider rubs in its guide, or the crank in its bearing
System rubbing_slider_crank(bool in_guide) {
  constexpr double l1 = 0.5, l2 = 1.0, a = 0.3, speed = 3.0;
  const double b = std::asin(-l1 * std::sin(a) / l2);
  const double rate = -l1 * std::cos(a) * speed / (l2 * std::cos(b));
  const Vec<2> pin(l1 * std::cos(a), l1 * std::sin(a)), end(pin[0] + l2 * std::cos(b), 0.0);
  const Vec<2> pin_speed(-speed * pin[1], speed * pin[0]),
      end_speed(pin_speed[0] - l2 * std::sin(b) * rate, 0.0);
  System system;
  system.add(Gravity{{0.0, -9.81}});
  const BodyId crank = system.add(RigidBody{.mass = rod(1.0, l1),
                                            .position = 0.5 * pin,
                                            .angle = a,
                                            .velocity = 0.5 * pin_speed,
                                            .spin = speed},
                                  "crank");
  const BodyId link = system.add(RigidBody{.mass = rod(1.5, l2),
                                           .position = 0.5 * (pin + end),
                                           .angle = b,
                                           .velocity = 0.5 * (pin_speed + end_speed),
                                           .spin = rate});
  const BodyId slider =
      system.add(RigidBody{.mass = box(2.0, 0.1, 0.1), .position = end, .velocity = end_speed});
  const JointId bearing = system.add(Revolute{.from = ground, .to = {crank, {-0.5 * l1, 0.0}}});
  system.add(Revolute{.from = {crank, {0.5 * l1, 0.0}}, .to = {link, {-0.5 * l2, 0.0}}});
  system.add(Revolute{.from = {link, {0.5 * l2, 0.0}}, .to = slider});
  const JointId guide = system.add(Prismatic{.from = ground, .to = slider, .axis = {1.0, 0.0}});
  system.add(JointFriction{.joint = in_guide ? guide : bearing, .coefficient = in_guide ? 0.2 : 0.01});
  return system;
}

TEST(JointFrictionReversal, OfASliderCrankIsTheSameInBothModes) {
  // Angles of the crank after 1 s by equations of its own (nine coordinates and the multipliers of eight
  // rows, the bound of friction by the quadratic equation that it obeys, Dormand-Prince of order 8 at 1e-12,
  // reversals located). Time stepping takes a reversal at the end of the step in which it is: friction acts
  // the wrong way for up to a step, and turns round by less than 7 rad/s^2, so that an angle may be off by 7
  // h after 1 s. By how much depends on where in a step that is. With halved steps the end is often the same:
  // then halving changes nothing, until an end comes between (errors of 7e-4 rad at 1 ms as at 0.5 ms).
  for (const bool in_guide : {false, true}) {
    const double exact = in_guide ? -1.778730710 : -2.027213263;
    const auto angle = [&](const auto& options) {
      Simulation simulation(rubbing_slider_crank(in_guide), options);
      simulation.run_until(1.0);
      return simulation.state().angle(simulation.system().body("crank"));
    };
    // Of nine decimals.
    EXPECT_NEAR(angle(EventDriven{.relative_tolerance = 1e-11, .absolute_tolerance = 1e-11}), exact, 2e-9);
    for (const ImpactTimes impacts : {ImpactTimes::at_step_start, ImpactTimes::located}) {
      for (const double h : carom_test::samples({1e-3, 5e-4, 7.3e-4, 1.37e-4})) {
        EXPECT_NEAR(angle(TimeStepping{.step = h, .impacts = impacts}), exact, 7.0 * h)
            << in_guide << " " << h;
      }
    }
  }
}

}  // namespace
