// Chains whose pins rub: both modes agree, they come to rest and stay there, they turn in flight, and their
// steps allocate nothing.

#include "tests/allocation_counter.h"
#include "tests/energy/ledger_check.h"
#include "tests/integrators/joint_run.h"
#include "tests/random.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <numbers>
#include <utility>
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

/// Two rods in line that turn about their pin in the air: without its friction nothing would change their
/// relative spin, but for rounding. (Friction was taken for a force that grew without bound against that.)
TEST(JointFriction, RodsInLineTurnInFlight) {
  carom_test::Random random(5);
  for (int repeat = 0; repeat < 40; ++repeat) {
    SCOPED_TRACE(repeat);
    System system;
    system.add(Gravity{{0.0, -9.81}});
    const double angle = random.uniform(-3.0, 3.0);
    const Vec<2> along(std::cos(angle), std::sin(angle)), across(-along[1], along[0]);
    const Vec<2> pin = random.vec<2>(2.0), velocity = random.vec<2>(2.0);
    std::array<double, 2> half{}, mass{};
    std::array<BodyId, 2> rods;
    for (std::size_t i = 0; i < 2; ++i) {
      half[i] = (i == 0 ? -1.0 : 1.0) * random.uniform(0.2, 0.6);
      mass[i] = random.uniform(0.3, 2.0);
      const double spin = random.uniform(-4.0, 4.0);
      rods[i] = system.add(RigidBody{.mass = rod(mass[i], 2.0 * std::abs(half[i])),
                                     .position = pin + half[i] * along,
                                     .angle = angle,
                                     .velocity = velocity + half[i] * spin * across,
                                     .spin = spin});
    }
    const JointId joint =
        system.add(Revolute{.from = {rods[0], {-half[0], 0.0}}, .to = {rods[1], {-half[1], 0.0}}});
    system.add(JointFriction{.joint = joint, .bound = random.uniform(0.01, 0.5)});
    Simulation simulation(std::move(system), EventDriven{});
    // About the centre of mass of both: friction is a pair of moments.
    const auto angular_momentum = [&] {
      const State& now = simulation.state();
      const Vec<2> apart = now.position(rods[1]) - now.position(rods[0]);
      const Vec<2> rate = now.velocity(rods[1]) - now.velocity(rods[0]);
      double sum = mass[0] * mass[1] / (mass[0] + mass[1]) * (apart[0] * rate[1] - apart[1] * rate[0]);
      for (std::size_t i = 0; i < 2; ++i) sum += mass[i] * half[i] * half[i] / 3.0 * now.spin(rods[i]);
      return sum;
    };
    const double before = angular_momentum();
    simulation.run_until(0.5);
    // Tolerances of some hundred steps, 1e-9 of numbers up to 10.
    EXPECT_NEAR(angular_momentum(), before, 1e-7);
    EXPECT_NEAR(simulation.energy().residual(), 0.0, 1e-7);
    EXPECT_GT(simulation.energy().flow(EnergyFlow::joint_friction), 0.0);
  }
}

}  // namespace
