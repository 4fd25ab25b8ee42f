// Clock groups that are joined where bodies meet and part again: bullets, the start of a pile and
// determinism.

#include "tests/integrators/event_driven/body_scenes.h"
#include "tests/integrators/event_run.h"
#include "tests/integrators/same_run.h"
#include "tests/random.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <exception>
#include <limits>
#include <memory>
#include <stdexcept>
#include <vector>

namespace {

using namespace body_scenes;
using namespace carom_test;

/// Time at which a disc meets a wall of another body, of the first impact of the two.
double first_hit(const Simulation& simulation) {
  for (const EventRecord& event : simulation.events()) {
    if (event.kind == EventKind::impact && event.other.valid()) return event.time;
  }
  return -1.0;
}

// A wall 1 mm thick that stands free, and a ball that would cross it in 1e-7 s.
TEST(EventMeetings, ABulletHitsAThinWall) {
  for (const double speed : {1e2, 1e4, 1e6}) {
    System system;
    system.set_default_law({.friction = 0.0, .normal_restitution = 1.0});
    const BodyId bullet = add_disc(system, 0.01, 0.005, {-7.0, 0.1}, {speed, 0.0});
    const BodyId wall = add_box(system, 100.0, 0.001, 2.0, {3.0, 0.0});
    Simulation simulation(system, EventDriven{});
    simulation.run_until(20.0 / speed);
    const double way = 10.0 - 0.005 - 0.0005;
    EXPECT_NEAR(first_hit(simulation), way / speed, 1e-12 * way / speed + 1e-12 / speed) << speed;
    EXPECT_LT(simulation.state().velocity(bullet)[0], 0.0);
    EXPECT_GT(simulation.state().velocity(wall)[0], 0.0);
    EXPECT_EQ(simulation.statistics().impacts, 1);
  }
}

// Bodies that start side by side are searched for meetings in a frame that goes with them. A box that had
// come to rest stayed where it was in that frame too, and the disc that rolls behind it went through it.
TEST(EventMeetings, ABodyAtRestIsMetByOneThatStartedBesideIt) {
  constexpr double speed = 3.0, friction = 0.5, half = 0.1, apart = 5.0;
  System system;
  system.add(Gravity{{0.0, -g}});
  system.set_default_law({.friction = friction, .normal_restitution = 0.0});
  system.add(HalfPlane{.normal = {0.0, 1.0}});
  add_disc(system, 1.0, half, {0.0, half}, {speed, 0.0}, -speed / half);
  add_box(system, 1.0, 2.0 * half, 2.0 * half, {apart, half}, 0.0, {speed, 0.0});
  Simulation simulation(system, EventDriven{});
  simulation.run_until(2.5);
  const double stops = apart + 0.5 * speed * speed / (friction * g);
  // As exact as the time at which the box stops, by the tolerances.
  EXPECT_NEAR(first_hit(simulation), (stops - 2.0 * half) / speed, 1e-8);
}

// Times of meetings are rounded, those of fast discs by more than what counts as touching: rounded down they
// met again and again at one time, until event_limit ended the run; at 1e5 s at the first meeting.
TEST(EventMeetings, FastDiscsMeetAtLateTimes) {
  for (const double start : {0.0, 1e3, 1e5, 1e6}) {
    System system;
    system.set_default_law({.friction = 0.0, .normal_restitution = 1.0});
    system.add(planar::BoxInside{.lower = {0.0, 0.0}, .upper = {1.0, 1.0}});
    Random random(3);
    for (int i = 0; i < 9; ++i) {
      add_disc(system, 1.0, random.uniform(0.05, 0.1), {0.2 + 0.3 * (i % 3), 0.2 + 0.3 * (i / 3)},
               {random.uniform(-4.0, 4.0), random.uniform(-4.0, 4.0)});
    }
    Simulation simulation(system, EventDriven{.record_events = false});
    State state = simulation.state();
    state.time = start;
    simulation.set_state(state);
    ASSERT_NO_THROW(simulation.run_until(start + 10.0)) << start;
    EXPECT_GT(simulation.statistics().impacts, 500) << start;
    EXPECT_NEAR(simulation.energy().total(), simulation.energy().initial(), 1e-11) << start;
  }
}

// Two balls above each other that bounce for half an hour.
TEST(EventMeetings, TwoBallsBounceOnEachOtherInTheLongRun) {
  System system;
  system.set_default_law({.friction = 0.0, .normal_restitution = 1.0});
  system.add(Gravity{{0.0, -g}});
  system.add(HalfPlane{.normal = {0.0, 1.0}});
  add_disc(system, 1.0, 0.1, {0.0, 1.0}, {0.0, 0.0});
  add_disc(system, 2.0, 0.1, {0.0, 1.4}, {0.0, 0.0});
  Simulation simulation(system, EventDriven{.record_events = false});
  ASSERT_NO_THROW(simulation.run_until(2000.0));
  EXPECT_GT(simulation.statistics().impacts, 10'000);
  // Some 11,000 impacts, each of which rounds energies of 36 J.
  EXPECT_NEAR(simulation.energy().total(), simulation.energy().initial(), 1e-11);
}

// Two of them head on, and a capsule that turns, under gravity.
TEST(EventMeetings, BulletsHitEachOtherAndACapsule) {
  System system;
  system.set_default_law({.friction = 0.3, .normal_restitution = 0.5});
  system.add(Gravity{{0.0, -g}});
  const BodyId left = add_disc(system, 0.01, 0.005, {-7.0, 1.0}, {1e4, 0.0});
  const BodyId right = add_disc(system, 0.01, 0.005, {7.0, 1.0}, {-1e4, 0.0});
  const BodyId thrown = add_disc(system, 0.01, 0.005, {-20.0, -1.0}, {1e4, 0.0});
  const BodyId bar =
      system.add(RigidBody{.mass = box(1.0, 0.002, 1.0), .position = {5.0, -1.0}, .spin = 3.0});
  system.add(Segment{.body = bar, .from = {0.0, -0.5}, .to = {0.0, 0.5}, .radius = 0.001});
  Simulation simulation(system, EventDriven{});
  simulation.run_until(0.01);
  EXPECT_LT(simulation.state().velocity(left)[0], 0.0);
  EXPECT_GT(simulation.state().velocity(right)[0], 0.0);
  EXPECT_LT(simulation.state().velocity(thrown)[0], 1e4);
  EXPECT_GT(simulation.state().velocity(bar)[0], 0.0);
  EXPECT_EQ(simulation.statistics().impacts, 2);
}

System poured(int count, double friction, double restitution) {
  System system;
  system.add(Gravity{{0.0, -g}});
  system.set_default_law({.friction = friction, .normal_restitution = restitution});
  Random random(8);
  for (int i = 0; i < count; ++i) {
    const double dx = random.uniform(-0.05, 0.05);
    const double spin = random.uniform(-1.0, 1.0);
    add_disc(system, 1.0, 0.1, {0.3 * (i % 3 - 1) + dx, 1.0 + 0.3 * (i / 3)}, Vec<2>::Zero(), spin);
  }
  system.add(HalfPlane{.normal = Vec<2>(1.0, 1.0).normalized()});
  system.add(HalfPlane{.normal = Vec<2>(-1.0, 1.0).normalized()});
  return system;
}

// Six discs poured into a V: they fall, meet, accumulate impacts and come to rest on each other. Groups are
// joined and part all the time; the ledger closes, and what is at rest stays.
TEST(EventMeetings, DiscsPouredIntoAVComeToRest) {
  const System system = poured(6, 0.5, 0.3);
  Simulation simulation(system, EventDriven{.interval = 0.05, .record_events = false});
  LedgerWatch ledger(simulation, 6.0);
  simulation.run_until(8.0);
  EXPECT_TRUE(ledger.closes());
  EXPECT_LT(simulation.energy().kinetic(), 1e-12);
  double overlap = 0.0;
  std::vector<Vec<2>> x;
  for (const BodyId body : system.bodies()) x.push_back(simulation.state().position(body));
  for (std::size_t i = 0; i < x.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) overlap = std::max(overlap, 0.2 - (x[i] - x[j]).norm());
    overlap = std::max(overlap, 0.1 - (x[i][1] - std::abs(x[i][0])) / std::sqrt(2.0));
  }
  EXPECT_LT(overlap, 1e-9);
}

TEST(EventMeetings, TheSameBitsWhateverRanBefore) {
  const System system = poured(6, 0.5, 0.3);
  const EventDriven mode{.interval = 0.05};
  Simulation first(system, mode), other(poured(6, 0.5, 0.1), mode);
  first.run_until(0.7);
  other.run_until(0.6);
  Simulation second(system, mode);
  second.run_until(0.7);
  EXPECT_EQ(bits_of(first), bits_of(second));
}

/// A load on a body that fails from a time on while it is armed: no number, or an exception.
struct Fault {
  double time = 0.0;
  bool throws = false;
  bool armed = true;

  [[nodiscard]] Vec<2> force(double now) const {
    if (!armed || now <= time) return Vec<2>::Zero();
    if (throws) throw std::runtime_error("the load is out of range");
    return Vec<2>::Constant(std::numeric_limits<double>::quiet_NaN());
  }
};

// Groups have been joined and have parted before the failure. What is left is the state that observers saw
// last, and the run goes on from it as one that never failed. Steps look ahead by 0.1 s at most
// (longest_step).
TEST(EventMeetings, AFailureLeavesTheLastGoodState) {
  for (const double time : {0.42, 0.46, 0.58}) {
    for (const bool throws : {false, true}) {
      SCOPED_TRACE(to_text(time) + (throws ? ", an exception" : ", no number"));
      const auto fault = std::make_shared<Fault>(Fault{time, throws});
      System system = poured(6, 0.3, 0.5);
      system.add(
          AppliedForce{.on = system.bodies()[1], .force = [fault](double t) { return fault->force(t); }});
      Simulation good(system, tight()), failing(system, tight());
      auto last = bits_of(failing);
      std::size_t events = 0;
      failing.observe([&](const Simulation& now) {
        last = bits_of(now);
        events = now.events().size();
      });
      for (int again = 0; again < 2; ++again) {
        EXPECT_THROW(failing.run_until(0.7), std::exception);
        EXPECT_EQ(bits_of(failing), last);
        EXPECT_EQ(failing.events().size(), events);
      }
      EXPECT_GT(failing.time(), 0.3);
      EXPECT_LE(failing.time(), time);
      EXPECT_GT(failing.statistics().impacts, 0);
      fault->armed = false;
      good.run_until(0.65);
      failing.run_until(0.65);
      // Two hundred tolerances for each of the impacts that follow, which magnify errors.
      for (const BodyId body : system.bodies()) {
        const Vec<2> difference = good.state().position(body) - failing.state().position(body);
        EXPECT_LT(difference.norm(), 1e-8);
      }
    }
  }
}

// From any state the same motion follows within the tolerance: groups start anew there.
TEST(EventMeetings, ARunGoesOnFromAStateOfItself) {
  const System system = poured(6, 0.3, 0.5);
  Simulation whole(system, tight()), parted(system, tight());
  parted.run_until(0.3);
  parted.edit([](System&) {});
  whole.run_until(0.5);
  parted.run_until(0.5);
  for (const BodyId body : system.bodies()) {
    const Vec<2> difference = whole.state().position(body) - parted.state().position(body);
    EXPECT_LT(difference.norm(), 1e-8);
  }
}

}  // namespace
