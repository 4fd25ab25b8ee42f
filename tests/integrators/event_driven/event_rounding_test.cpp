// Scenes whose rounding is large: far from the origin, after many turns, of masses that differ a millionfold.
// They come to the same rest as scenes of ordinary numbers.

#include "tests/integrators/event_driven/body_scenes.h"
#include "tests/random.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace {

using namespace body_scenes;
using namespace carom_test;

constexpr double epsilon = std::numeric_limits<double>::epsilon();

// Bounces of a bar that comes to lie: below the rounding of gaps each would begin deeper than the one before.
TEST(EventRounding, BarComesToLieFarFromTheOrigin) {
  constexpr double radius = 0.02, end = 5.0;
  for (const double far : {0.0, 1e3, 1e6}) {
    System system;
    system.add(Gravity{{0.0, -g}});
    system.add(HalfPlane{.point = {far, far}, .normal = {0.0, 1.0}},
               Surface{.friction = 0.3, .normal_restitution = 0.8});
    const BodyId bar = system.add(RigidBody{.mass = rod(1.0, 1.0),
                                            .position = {far, far + 1.0},
                                            .angle = 0.4,
                                            .velocity = {1.0, 0.0},
                                            .spin = 1.0});
    system.add(Segment{.body = bar, .from = {-0.5, 0.0}, .to = {0.5, 0.0}, .radius = radius});
    Simulation simulation(system, EventDriven{});
    simulation.run_until(end);
    // Where gaps count as closed, and 256 roundings of the coordinates that they are differences of.
    const double rounding = 1e-9 + 256.0 * epsilon * far;
    EXPECT_NEAR(simulation.state().position(bar)[1] - far, radius, rounding) << far;
    EXPECT_NEAR(simulation.state().angle(bar), 0.0, 4.0 * rounding) << far;
    EXPECT_EQ(simulation.contact_forces().size(), 2u) << far;
    EXPECT_LT(simulation.events().size(), 400u) << far;  // 145 at the origin
  }
}

// Rounding of gaps is larger there than gap_tolerance: all that touches by it has to be looked at.
TEST(EventRounding, RowsOfDiscsComeToLieFarFromTheOrigin) {
  constexpr double radius = 0.1, pitch = 0.25;
  constexpr int columns = 3, rows = 3;
  for (const double far : {0.0, 1e5, 1e6, 1e7, 1e8}) {
    System system;
    system.add(Gravity{{0.0, -g}});
    system.set_default_law(Surface{.friction = 0.3, .normal_restitution = 0.2});
    system.add(HalfPlane{.point = {far, far}, .normal = {0.0, 1.0}});
    std::vector<BodyId> discs;
    for (int i = 0; i < columns * rows; ++i) {
      const Vec<2> place(pitch * (i % columns), 0.15 + pitch * (i / columns));
      discs.push_back(
          system.add(RigidBody{.mass = disc(1.0, radius), .position = {far + place[0], far + place[1]}}));
      system.add(Disc{.body = discs.back(), .radius = radius});
    }
    Simulation simulation(system, EventDriven{});
    simulation.run_until(0.4);
    const double rounding = 1e-8 + 256.0 * epsilon * far;
    for (int i = 0; i < columns; ++i) {
      EXPECT_NEAR(simulation.state().position(discs[static_cast<std::size_t>(i)])[1] - far, radius, rounding)
          << far;
    }
    // Each falls 0.05 m, and the gap of each row below; columns stand upright, and do not fall yet.
    EXPECT_NEAR(simulation.state().position(discs.back())[1] - far, radius + 2.0 * radius * (rows - 1),
                rounding)
        << far;
  }
}

TEST(EventRounding, BoxComesToLieAfterManyTurns) {
  constexpr double end = 3.0;
  for (const double turns : {0.0, 1e3, 159155.0}) {
    const double turned = 2.0 * std::numbers::pi * turns;
    System system;
    system.add(Gravity{{0.0, -g}});
    system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = 0.4, .normal_restitution = 0.5});
    const BodyId box = add_box(system, 1.0, 0.4, 0.2, {0.0, 1.0}, turned + 0.2, {0.3, 0.0}, 2.0);
    Simulation simulation(system, EventDriven{});
    simulation.run_until(end);
    // Gaps are sums of the height and the angle times 0.2 m.
    EXPECT_NEAR(simulation.state().position(box)[1], 0.1, 1e-9 + epsilon * turned) << turns;
    EXPECT_NEAR(simulation.state().angle(box), turned, 1e-8 + 4.0 * epsilon * turned) << turns;
    EXPECT_EQ(simulation.contact_forces().size(), 2u) << turns;
    EXPECT_LT(simulation.events().size(), 400u) << turns;
  }
}

// Forces of 1e7 N nearly cancel on a disc of 1 kg.
TEST(EventRounding, HeavyDiscRestsOnALightOne) {
  for (const double friction : {0.0, 0.3}) {
    for (const double heavy : {1e3, 1e5, 1e6, 1e7}) {
      System system;
      system.add(Gravity{{0.0, -g}});
      system.set_default_law({.friction = friction, .normal_restitution = 0.5});
      system.add(HalfPlane{.normal = {0.0, 1.0}});
      const BodyId below = add_disc(system, 1.0, 0.1, {0.0, 0.1});
      const BodyId above = add_disc(system, heavy, 0.5, {0.0, 0.7});
      Simulation simulation(system, EventDriven{});
      simulation.run_until(0.1);
      EXPECT_NEAR(simulation.state().position(above)[1], 0.7, 1e-9) << heavy;  // gap_tolerance
      const auto forces = simulation.contact_forces();
      // Twice the weights times the rounding of some ten operations.
      const double rounding = 20.0 * epsilon * (1.0 + heavy) * g;
      EXPECT_NEAR(force_on(forces, below).mean_force[1], g, 10.0 * rounding) << heavy;
      EXPECT_NEAR(force_on(forces, above).mean_force[1], heavy * g, 1e-9 * heavy * g) << heavy;
    }
  }
}

// A disc of a micrometre in a field of a million g: its flights are a millionth of the step of 1 s that free
// flight takes, and fall 5e6 m below the ground within it. It rebounded from ever deeper in the ground, by
// 1e-9 m a bounce, and gained energy; bigger ones did not get on at all.
TEST(EventRounding, BouncesInAStrongFieldAreThoseOfAWeakOne) {
  for (const double length : {1.0, 1e-4, 1e-6}) {
    for (const double duration : {1.0, 1e-4, 1e-6}) {
      const double speed = length / duration;
      System system;
      system.add(Gravity{{0.0, -g * speed / duration}});
      system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = 0.0, .normal_restitution = 0.7});
      const BodyId ball =
          system.add(RigidBody{.mass = disc(1.2, 0.1 * length), .position = {0.0, 1.1 * length}});
      system.add(Disc{.body = ball, .radius = 0.1 * length});
      EventDriven mode{.capture_speed = 1e-4 * speed, .event_limit = 1e12};
      Simulation simulation(system, mode);
      simulation.run_until(1.4 * duration);
      const std::vector<EventRecord>& events = simulation.events();
      const double fall = std::sqrt(2.0 / g);  // from 1 m
      ASSERT_EQ(events.size(), 2u) << length << " " << duration;
      // Gaps are located to 256 roundings of 1 m, which is the least size of coordinates.
      const double rounding = 256.0 * epsilon / length + 64.0 * epsilon;
      EXPECT_NEAR(events[0].time / duration, fall, rounding);
      EXPECT_NEAR(events[1].time / duration, 2.4 * fall, 4.0 * rounding);
      EXPECT_NEAR(events[1].velocity_before[0] / speed, -0.7 * g * fall, 4.0 * rounding);
    }
  }
}

// A corner that is open by less than the clock can tell, and falls, closes: it is not looked for in the
// middle of the step, where it may have been and gone. Near t = 0 the same gas has some 20 impacts a second
// of each.
TEST(EventRounding, PolygonsMeetAtLateTimes) {
  constexpr double run = 2.0, fastest = 12.0;
  for (const double start : {1e3, 1e5, 1e7}) {
    System system;
    system.set_default_law({.friction = 0.0, .normal_restitution = 1.0});
    system.add(BoxInside{.lower = {0.0, 0.0}, .upper = {1.0, 1.0}});
    Random random(3);
    for (int i = 0; i < 16; ++i) {
      const double side = random.uniform(0.03, 0.08);
      const Vec<2> velocity = random.vec<2>(3.0);
      add_box(system, 1.0, side, side, {0.15 + 0.23 * (i / 4), 0.15 + 0.23 * (i % 4)}, 0.0, velocity);
    }
    Simulation simulation(system, EventDriven{});
    State state = simulation.state();
    state.time = start;
    simulation.set_state(state);
    ASSERT_NO_THROW(simulation.run_until(start + run)) << start;
    EXPECT_GT(simulation.statistics().impacts, 150) << start;
    // Elastic impacts without loads: rounding of some hundred.
    EXPECT_NEAR(simulation.energy().total() / simulation.energy().initial(), 1.0, 1e-12) << start;
    // Times of events are found to four roundings, and both bodies move.
    const double resolution = 8.0 * epsilon * start * fastest;
    for (const EventRecord& event : simulation.events())
      EXPECT_GT(event.gap, -1e-12 - resolution) << start << " s, at " << event.time;
  }
}

// A box and a disc stand side by side on a belt; the disc has come to its round end, and rolls down it with
// g/1.7 while nothing presses it to the box. Where rounding left a force of 1e-46 N between them, the two
// were taken to stick to each other, and the disc tore the corner of the box into the belt.
TEST(EventRounding, ADiscLeavesABoxBesideIt) {
  constexpr double speed = 0.8, end = 0.02;
  carom_test::Random random(12);
  for (int i = 0; i < 200; ++i) {
    const double past = i * 1e-16, angle = random.uniform(-1e-15, 1e-15);
    System system;
    system.add(Gravity{{0.0, -g}});
    system.set_default_law({.friction = 0.4, .normal_restitution = 0.2});
    system.add(Wall{.from = {-1.0, 1.0}, .to = {0.0, 1.0}, .radius = 0.05, .surface_speed = speed}, "belt");
    const BodyId box = add_box(system, 1.0, 0.1, 0.08, {past - 0.11, 1.09}, angle, {speed, 0.0}, 0.0);
    const BodyId ball =
        system.add(RigidBody{.mass = disc(0.5, 0.06), .position = {past, 1.11}, .velocity = {speed, 0.0}});
    system.add(Disc{.body = ball, .radius = 0.06});
    Simulation simulation(system, EventDriven{});
    simulation.run_until(end);
    // The angle that it begins with, and tolerances.
    EXPECT_NEAR(simulation.state().angle(box), 0.0, 1e-12) << i;
    EXPECT_NEAR(simulation.state().position(box)[0], past - 0.11 + speed * end, 1e-12) << i;
    EXPECT_GT(simulation.state().position(ball)[0], past + speed * end) << i;
  }
}

}  // namespace
