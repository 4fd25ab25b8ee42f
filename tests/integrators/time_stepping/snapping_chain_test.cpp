// A chain that hangs from both ends and is let go at one: its bars turn far within steps as it snaps taut.

#include <carom/carom.h>

#include "tests/shares.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace {

using namespace carom;
using namespace carom::planar;

constexpr double length = 1.0, mass = 1.0;  // of the chain [m, kg]
constexpr double end_time = 0.6;            // it snaps at about 0.38 s [s]

/// Pinned bars down and up again; the first one is pinned to the ground.
System folded_chain(int bars) {
  System system;
  system.add(Gravity{{0.0, -9.81}});
  const double own = length / bars;
  double x = 0.0, y = 0.0;
  BodyId before = ground;
  for (int i = 0; i < bars; ++i) {
    const double angle = 0.5 * std::numbers::pi * (i < bars / 2 ? -1.0 : i == bars / 2 ? 0.0 : 1.0);
    const double along = own * std::cos(angle), up = own * std::sin(angle);
    const BodyId bar = system.add(RigidBody{.mass = {mass / bars, mass / bars * own * own / 12.0},
                                            .position = {x + 0.5 * along, y + 0.5 * up},
                                            .angle = angle});
    const End<2> from = before == ground ? End<2>{ground} : End<2>{before, {0.5 * own, 0.0}};
    system.add(Revolute{.from = from, .to = {bar, {-0.5 * own, 0.0}}});
    x += along;
    y += up;
    before = bar;
  }
  return system;
}

// All of the energy that the chain can turn into motion: it hangs at most this far above its lowest place.
constexpr double available = mass * 9.81 * length;  // [J]

TEST(SnappingChain, NoStepEndsWhereTheIterationIsLost) {
  for (const int bars : carom_test::samples({30, 40, 50, 80})) {
    for (const double step : carom_test::samples({1e-3, 5e-4})) {
      for (const ForceRule rule : {ForceRule::trapezoidal, ForceRule::energy_momentum}) {
        Simulation simulation(folded_chain(bars), TimeStepping{.step = step, .force_rule = rule});
        const std::string what = std::to_string(bars) + " bars, step " + std::to_string(step);
        const auto kinetic = [&] { return simulation.energy().kinetic(); };
        try {
          while (simulation.time() < end_time) {
            simulation.step();
            ASSERT_LE(kinetic(), available) << what << " at " << simulation.time();
          }
        } catch (const SolverError& error) {
          EXPECT_LE(kinetic(), available) << what;  // the last good state
          EXPECT_GT(simulation.time(), 0.3) << what << ": " << error.what();
        }
      }
    }
  }
}

TEST(SnappingChain, AFailureNamesTheBarThatTurnsFarthestAndAStep) {
  Simulation simulation(folded_chain(80), TimeStepping{.step = 1e-3});
  try {
    simulation.run_until(end_time);
    FAIL() << "nothing was thrown";
  } catch (const SolverError& error) {
    const SolverFailure& failure = error.failure();
    const std::string message = error.what();
    EXPECT_NE(message.find("turn far within the step (rigid body #"), std::string::npos) << message;
    EXPECT_NE(message.find(" rad)"), std::string::npos) << message;
    EXPECT_TRUE(std::any_of(failure.parts.begin(), failure.parts.end(), [](const std::string& part) {
      return part.starts_with("rigid body #");
    })) << message;
    EXPECT_GT(failure.suggested_step, 0.0);
    EXPECT_LT(failure.suggested_step, failure.step);
  }
}

TEST(SnappingChain, SuggestedStepsComeThrough) {
  Simulation simulation(folded_chain(50), TimeStepping{.step = 1e-3});
  int failures = 0;
  while (simulation.time() < end_time) {
    try {
      simulation.run_until(end_time);
    } catch (const SolverError& error) {
      ASSERT_LE(++failures, 6) << error.what();
      simulation.switch_to(TimeStepping{.step = error.failure().suggested_step});
    }
  }
  EXPECT_GT(failures, 0);
}

TEST(SnappingChain, StepControlComesThrough) {
  Simulation simulation(folded_chain(carom_test::usual_or(50, 30)),
                        TimeStepping{.step = 1e-3, .control = StepControl{}});
  const double begin = simulation.energy().total();
  simulation.run_until(end_time);
  // Steps across the snap cost some of the energy; with a fixed step of 1e-4 s 5e-3 J.
  EXPECT_LE(std::abs(simulation.energy().total() - begin), 5e-3 * available);
}

}  // namespace
