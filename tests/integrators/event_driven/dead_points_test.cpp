// Mechanisms with dry friction that start at their dead points: where forces along the guide move nothing,
// the direction of friction is that of the motion that follows.

#include "tests/integrators/event_driven/dead_point_scenes.h"
#include "tests/shares.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

namespace {

using namespace dead_point_scenes;

constexpr double crank_length = 0.1, rod_length = 0.3;  // [m]

/// A slider-crank at rest at its outer or inner dead point, along the x axis.
struct SliderCrank {
  System system;
  BodyId crank, slider;
  JointId pin, guide;

  explicit SliderCrank(bool outer) {
    const double c = outer ? crank_length : -crank_length;
    crank = system.add(RigidBody{
        .mass = rod(1.0, crank_length), .position = {0.5 * c, 0.0}, .angle = outer ? 0.0 : std::numbers::pi});
    const BodyId link =
        system.add(RigidBody{.mass = rod(1.0, rod_length), .position = {c + 0.5 * rod_length, 0.0}});
    slider = system.add(RigidBody{.mass = box(0.5, 0.1, 0.1), .position = {c + rod_length, 0.0}});
    pin = system.add(Revolute{.from = ground, .to = {crank, {-0.5 * crank_length, 0.0}}, .zero_angle = 0.0});
    system.add(Revolute{.from = {crank, {0.5 * crank_length, 0.0}}, .to = {link, {-0.5 * rod_length, 0.0}}});
    system.add(Revolute{.from = {link, {0.5 * rod_length, 0.0}}, .to = slider});
    guide = system.add(Prismatic{.from = ground, .to = slider, .axis = {1.0, 0.0}});
  }
};

double loss_of(const Simulation& run) { return run.energy().flow(EnergyFlow::joint_friction); }

TEST(DeadPoints, ASliderCrankLeavesThemWithFrictionInItsGuide) {
  for (const bool outer : {true, false}) {
    for (const bool by_weight : {true, false}) {
      for (const bool by_force : {true, false}) {
        if (carom_test::with_sanitizers && by_force != by_weight) continue;
        SliderCrank made(outer);
        if (by_weight) {
          made.system.add(Gravity{{0.0, -9.81}});
        } else {
          made.system.add(AppliedTorque{.on = made.crank, .torque = [](double) { return 1.0; }});
        }
        made.system.add(by_force ? JointFriction{.joint = made.guide, .coefficient = 0.1}
                                 : JointFriction{.joint = made.guide, .bound = 0.5});
        Simulation by_events(made.system, EventDriven{}), by_steps(made.system, TimeStepping{.step = 1e-4});
        by_events.run_until(0.5);
        by_steps.run_until(0.5);
        // Steps of 1e-4 s are wrong by some 1e-5 rad then.
        EXPECT_NEAR(by_events.state().angle(made.crank), by_steps.state().angle(made.crank), 5e-5);
        EXPECT_NEAR(loss_of(by_events), loss_of(by_steps), 1e-4 * loss_of(by_steps));
        EXPECT_GT(std::abs(by_events.state().angle(made.crank) - (outer ? 0.0 : std::numbers::pi)), 0.5);
      }
    }
  }
}

// A constant friction force F loses F times the way of the slider, however late the driver begins to move.
TEST(DeadPoints, DrivenSlidersLoseFrictionTimesTheirWay) {
  constexpr double force = 0.5;
  for (const bool outer : {true, false}) {
    for (const int power : {2, 3}) {
      SliderCrank made(outer);
      made.system.add(JointFriction{.joint = made.guide, .bound = force});
      const double start = outer ? 0.0 : std::numbers::pi;
      made.system.add(
          Driver{.joint = made.pin, .position = [=](double t) { return start + std::pow(t, power); }});
      const double x = outer ? rod_length + crank_length : rod_length - crank_length;
      for (const bool by_events : {true, false}) {
        Simulation run(made.system, by_events ? Mode(EventDriven{}) : Mode(TimeStepping{.step = 1e-3}));
        run.run_until(1.0);
        const double way = std::abs(run.state().position(made.slider)[0] - x);
        // Of the works of steps of 1e-3 s that of the first is wrong.
        EXPECT_NEAR(loss_of(run), force * way, (by_events ? 1e-7 : 1e-5) * force * way);
      }
    }
  }
}

// Joints of a framework are held fast for ever: friction in them neither acts nor slips.
TEST(DeadPoints, FrictionInAFrameworkStaysHeld) {
  const auto swing = [](double friction) {
    System system;
    system.add(Gravity{{0.0, -9.81}});
    const std::array<Vec<2>, 3> corners{Vec<2>(0.0, 0.0), Vec<2>(1.0, 0.0), Vec<2>(0.5, 0.8)};
    std::array<BodyId, 3> bars;
    std::array<double, 3> halves{};
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec<2> along = corners[(i + 1) % 3] - corners[i];
      halves[i] = 0.5 * along.norm();
      bars[i] = system.add(RigidBody{.mass = rod(1.0, along.norm()),
                                     .position = corners[i] + 0.5 * along,
                                     .angle = std::atan2(along[1], along[0])});
    }
    JointId pin;
    for (std::size_t i = 0; i < 3; ++i) {
      pin = system.add(Revolute{.from = {bars[i], {halves[i], 0.0}},
                                .to = {bars[(i + 1) % 3], {-halves[(i + 1) % 3], 0.0}}});
    }
    system.add(Revolute{.from = ground, .to = {bars[0], {-halves[0], 0.0}}});
    if (friction > 0.0) system.add(JointFriction{.joint = pin, .bound = friction});
    Simulation run(system, EventDriven{});
    run.run_until(1.0);
    EXPECT_NEAR(loss_of(run), 0.0, 1e-14);  // of some 10 J
    EXPECT_TRUE(run.events().empty());
    return run.state().angle(bars[1]);
  };
  EXPECT_NEAR(swing(0.3), swing(0.0), 1e-7);  // of flows with the tolerance 1e-9
}

/// Sliders that stand on a floor with two corners, of which neither is held fast by joints alone.
void leave_on_a_floor(int trials) {
  carom_test::Random random(7);
  for (int trial = 0; trial < trials; ++trial) {
    SCOPED_TRACE(trial);
    constexpr double height = 0.05;  // of the crank's pin
    const double radius = random.uniform(0.02, 0.04), length = radius * random.uniform(2.0, 5.0);
    const double c = trial % 2 == 0 ? radius : -radius;
    System system;
    system.add(Gravity{{0.0, -9.81}});
    system.set_default_law({.friction = random.uniform(0.05, 0.4), .normal_restitution = 0.0});
    system.add(HalfPlane{.normal = {0.0, 1.0}});
    const BodyId crank = system.add(RigidBody{
        .mass = rod(0.3, radius), .position = {0.5 * c, height}, .angle = c > 0.0 ? 0.0 : std::numbers::pi});
    const BodyId link =
        system.add(RigidBody{.mass = rod(0.2, length), .position = {c + 0.5 * length, height}});
    const BodyId slider =
        system.add(RigidBody{.mass = box(2.0, 0.2, 2.0 * height), .position = {c + length, height}});
    system.add(Polygon{.body = slider,
                       .vertices = {{-0.1, -height}, {0.1, -height}, {0.1, height}, {-0.1, height}}});
    system.add(Revolute{.from = {ground, {0.0, height}}, .to = {crank, {-0.5 * radius, 0.0}}});
    system.add(Revolute{.from = {crank, {0.5 * radius, 0.0}}, .to = {link, {-0.5 * length, 0.0}}});
    system.add(Revolute{.from = {link, {0.5 * length, 0.0}}, .to = slider});
    const double torque = random.uniform(0.1, 0.4) * (random.below(2) == 0 ? 1.0 : -1.0);
    if (trial % 3 != 0) {
      const bool ramps = trial % 3 == 1;
      system.add(
          AppliedTorque{.on = crank, .torque = [=](double t) { return ramps ? 3.0 * torque * t : torque; }});
    }
    Simulation by_events(system, EventDriven{}), by_steps(system, TimeStepping{.step = 2e-5});
    by_events.run_until(0.2);
    by_steps.run_until(0.2);
    // Where the crank stops and is pushed on again, errors of steps grow thirtyfold.
    EXPECT_NEAR(by_events.state().angle(crank), by_steps.state().angle(crank), 1e-3);
    EXPECT_NEAR(by_events.energy().residual(), 0.0, 2e-8 * by_events.energy().scale());
  }
}

TEST(DeadPoints, ASliderOnAFloorLeavesThemToo) { leave_on_a_floor(3); }

TEST(DeadPointsLong, ASliderOnAFloorLeavesThemToo) { leave_on_a_floor(30); }

/// Runs scenes for half a second, and returns how far angles of cranks and losses are apart between the
/// modes.
std::vector<double> compare_modes(carom_test::SeedRange seeds) {
  std::vector<double> distances;
  for (std::uint64_t seed = seeds.first; seed < seeds.last; ++seed) {
    SCOPED_TRACE(seed);
    const Scene scene = random_scene(seed);
    Simulation by_events(scene.system, EventDriven{});
    EXPECT_NO_THROW(by_events.run_until(0.5));
    EXPECT_NEAR(by_events.energy().residual(), 0.0, 2e-8 * by_events.energy().scale());
    Simulation by_steps(scene.system, TimeStepping{.step = 2e-4});
    by_steps.run_until(0.5);
    const double turn = by_events.state().angle(scene.crank) - by_steps.state().angle(scene.crank);
    const double loss = (loss_of(by_events) - loss_of(by_steps)) / by_events.energy().scale();
    distances.push_back(std::max(std::abs(turn), std::abs(loss)));
  }
  std::sort(distances.begin(), distances.end());
  return distances;
}

double quantile(const std::vector<double>& sorted, double part) {
  return sorted[static_cast<std::size_t>(part * static_cast<double>(sorted.size() - 1))];
}

TEST(DeadPoints, RandomMechanismsGoOnAsInTimeStepping) {
  const std::vector<double> distances = compare_modes({1, carom_test::usual_or(9U, 3U)});
  EXPECT_LT(distances.back(), 1e-3);
}

// Where a crank stops near a dead point, the next turn hangs on a hair: one in a hundred may be elsewhere.
TEST(DeadPointsLong, RandomMechanismsGoOnAsInTimeStepping) {
  const std::vector<double> distances = compare_modes(carom_test::seeds_from(1, 400, 4000));
  EXPECT_LT(quantile(distances, 0.5), 1e-5);
  EXPECT_LT(quantile(distances, 0.9), 5e-4);
  EXPECT_LT(quantile(distances, 0.98), 1e-2);
}

}  // namespace
