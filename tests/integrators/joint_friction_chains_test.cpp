// Chains whose pins rub: both modes agree, they come to rest and stay there, and their steps allocate
// nothing.

#include "tests/allocation_counter.h"
#include "tests/energy/ledger_check.h"
#include "tests/integrators/joint_run.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <numbers>
#include <vector>

namespace {

using namespace joint_scenes;
using carom_test::events_of;
using carom_test::ledger_closes;

constexpr double pi = std::numbers::pi;

/// Three rods pinned to each other and to the ground, each pin with friction.
struct RubbingChain {
  Scene scene;
  std::vector<JointId> pins, frictions;
  explicit RubbingChain(double bound, double coefficient) {
    scene.system.add(Gravity{{0.0, -g}});
    for (int i = 0; i < 3; ++i) {
      const BodyId link = scene.system.add(RigidBody{.mass = rod(1.0, 1.0), .position = {i + 0.5, 0.0}});
      const End<2> before = i == 0 ? End<2>(ground) : End<2>(scene.bodies.back(), {0.5, 0.0});
      pins.push_back(scene.system.add(Revolute{.from = before, .to = {link, {-0.5, 0.0}}}));
      frictions.push_back(
          scene.system.add(JointFriction{.joint = pins.back(), .bound = bound, .coefficient = coefficient}));
      scene.bodies.push_back(link);
    }
  }
};

void chains_agree_in_both_modes(std::initializer_list<double> steps) {
  for (const double coefficient : {0.0, 0.02}) {
    const RubbingChain chain(0.3, coefficient);
    constexpr double time = 0.8;
    WatchedRun event(chain.scene);
    event.simulation.run_until(time);
    EXPECT_GE(events_of(event.simulation, EventKind::slip).size(), 3u);
    for (const double step : steps) {
      Simulation stepping(chain.scene.system, TimeStepping{.step = step});
      JointCheck check(stepping);
      stepping.run_until(time);
      EXPECT_LE(check.gap, gap_limit);
      EXPECT_LE(check.speed, speed_limit);
      EXPECT_TRUE(ledger_closes(stepping.energy()));
      double error = 0.0;
      for (const BodyId body : chain.scene.bodies) {
        error =
            std::max(error, std::abs(stepping.state().angle(body) - event.simulation.state().angle(body)));
      }
      // A turn somewhere within a step leaves an impulse of up to 2 h M unsaid: order 1, with a factor that
      // depends on where it is.
      EXPECT_LT(error, 0.3 * step) << coefficient;
    }
  }
}

TEST(JointFriction, ChainsAgreeInBothModes) { chains_agree_in_both_modes({1e-3}); }

TEST(JointFrictionLong, ChainsAgreeInBothModes) { chains_agree_in_both_modes({2.5e-4, 6.25e-5}); }

TEST(JointFrictionLong, ChainsComeToRestAndStay) {
  for (const double coefficient : {0.0, 0.05}) {
    const RubbingChain chain(2.0, coefficient);
    WatchedRun event(chain.scene);
    double energy = event.simulation.energy().total();
    event.simulation.observe([&](const Simulation& now) {
      EXPECT_LE(now.energy().total(), energy + 1e-9);  // the tolerance of a run with these numbers
      energy = now.energy().total();
    });
    event.simulation.run_until(30.0);
    Simulation stepping(chain.scene.system, TimeStepping{.step = 1e-3});
    stepping.run_until(30.0);
    for (const Simulation* const run : {&event.simulation, &stepping}) {
      double moved = 0.0;
      for (const BodyId body : chain.scene.bodies) {
        moved = std::max(moved, std::abs(run->state().spin(body)));
        EXPECT_GT(std::abs(run->state().angle(body) + 0.5 * pi), 1e-4);
      }
      EXPECT_LE(moved, 1e-13);
      for (std::size_t i = 0; i < chain.pins.size(); ++i) {
        const JointReaction force = run->reaction(chain.pins[i]);
        EXPECT_LE(std::abs(run->reaction(chain.frictions[i]).moment),
                  2.0 + coefficient * std::hypot(force.force[0], force.force[1]) + 1e-9);
      }
    }
  }
}

TEST(JointFriction, SteadyStepsAllocateNothing) {
  const RubbingChain chain(0.3, 0.02);
  Simulation stepping(chain.scene.system, TimeStepping{.step = 1e-3});
  stepping.run_until(0.5);
  const std::int64_t before = carom_test::allocations();
  stepping.run_until(0.6);
  EXPECT_EQ(carom_test::allocations() - before, 0);
}

}  // namespace
