// Closings of ways that are made by hand, against closed forms.

#include "tests/contact/detection/moved_model.h"

#include <carom/carom.h>
#include <carom/core/numerics/never.h>
#include <carom/integrators/time_stepping/step_closings.h>

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <utility>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::MovedModel;

constexpr double g = 9.81, radius = 0.1;
constexpr double capture_speed = 1e-2;
// Gaps are found down to the rounding of gaps, 1e-12 m, at speeds that are not far from 1 m/s.
constexpr double found_to = 4e-12;

TimeStepping options_of(ImpactTimes times, double step) {
  return {.step = step,
          .capture_speed = capture_speed,
          .impacts = times,
          .overlaps = {.never_tunnel = times == ImpactTimes::at_step_start}};
}

/// A model, the way of a step of it, and the search.
class Way {
public:
  Way(System system, double span, std::vector<double> accelerations = {},
      StepContacts contacts = StepContacts::all, ImpactTimes times = ImpactTimes::located)
      : model(std::move(system), span, std::move(accelerations)),
        closings(model.assembly, model.detector, options_of(times, span), contacts) {
    closings.begin_step();
  }
  /// The first closing of all, or of none but passages.
  StepClosing first(bool closes = true) {
    const auto is_wanted = [closes](const SweptPair&) { return closes; };
    return closings.first({model.start, model.end, model.start.v, flights_, acted}, is_wanted);
  }

  MovedModel model;
  StepClosings closings;
  std::vector<std::pair<ConstraintKey, ContactMode>> acted;

private:
  StepFlights flights_;
};

System with_law() {
  System system;
  system.set_default_law({.friction = 0.0, .normal_restitution = 0.5});
  return system;
}

void add_disc(System& system, const Vec<2>& place, const Vec<2>& velocity) {
  const BodyId body =
      system.add(RigidBody{.mass = disc(1.0, radius), .position = place, .velocity = velocity});
  system.add(Disc{.body = body, .radius = radius});
}

enum class Floor { half_plane, block };

/// A disc over a floor at a gap, which falls at a speed.
System over_floor(Floor floor, double gap, double speed) {
  System system = with_law();
  if (floor == Floor::half_plane) {
    system.add(HalfPlane{.normal = {0.0, 1.0}});
  } else {
    system.add(planar::Block{.vertices = {{-9.0, -4.0}, {9.0, -4.0}, {9.0, 0.0}, {-9.0, 0.0}}});
  }
  add_disc(system, {0.0, radius + gap}, {1.0, -speed});
  return system;
}

class StepClosingsOnFloors : public testing::TestWithParam<Floor> {};
INSTANTIATE_TEST_SUITE_P(Floors, StepClosingsOnFloors, testing::Values(Floor::half_plane, Floor::block));

TEST_P(StepClosingsOnFloors, OfABallThatFallsIsTheRootOfAParabola) {
  constexpr double gap = 0.3, speed = 1.0, span = 0.25;
  Way way(over_floor(GetParam(), gap, speed), span, {0.0, -g});
  const StepClosing closing = way.first();
  EXPECT_NEAR(closing.time, (-speed + std::sqrt(speed * speed + 2.0 * g * gap)) / g, found_to);
  EXPECT_FALSE(closing.is_passage);
  EXPECT_FALSE(closing.dips);
  EXPECT_NEAR(closing.gap, gap - speed * span - 0.5 * g * span * span, found_to);
  EXPECT_NEAR(closing.rate, -speed - g * span, found_to);
  EXPECT_EQ(closing.shallow, 0.0);
  EXPECT_EQ(closing.deep, -way.closings.rounding());
  EXPECT_EQ(closing.aim(), -0.5 * way.closings.rounding());
  EXPECT_EQ(closing.key, closing.pair.key);
  EXPECT_FALSE(way.closings.any_left_out());
}

TEST_P(StepClosingsOnFloors, AreNoneOfABallThatDoesNotComeDown) {
  constexpr double gap = 0.3, speed = 1.0, fall = 0.16;  // to a gap of 0.3 - 0.16 - 0.126
  EXPECT_EQ(Way(over_floor(GetParam(), gap, speed), fall, {0.0, -g}).first().time, never);
}

// A point at the centre of mass cannot come to a flat boundary and leave it by turning.
TEST_P(StepClosingsOnFloors, OfTurnsLeaveDiscsBeforeHalfPlanes) {
  Way way(over_floor(GetParam(), 0.3, 1.0), 0.25, {0.0, -g}, StepContacts::of_turns);
  EXPECT_EQ(way.first().time < never, GetParam() == Floor::block);
}

TEST_P(StepClosingsOnFloors, AreNoneOfContactsThatActed) {
  Way way(over_floor(GetParam(), 0.3, 1.0), 0.25, {0.0, -g});
  const StepClosing closing = way.first();
  ASSERT_LT(closing.time, never);
  way.acted = {{closing.key, ContactMode::stick}};
  const StepClosing with_it = way.first();
  EXPECT_TRUE(with_it.time == never || with_it.is_passage);
  // One that opened last is looked for; of several entries the last one counts.
  way.acted.push_back({closing.key, ContactMode::open});
  EXPECT_EQ(way.first().time, closing.time);
  way.acted.push_back({closing.key, ContactMode::slip_negative});
  EXPECT_TRUE(way.first().time == never || way.first().is_passage);
}

TEST_P(StepClosingsOnFloors, AreLeftAsideForARestOfAStep) {
  Way way(over_floor(GetParam(), 0.3, 1.0), 0.25, {0.0, -g});
  const StepClosing closing = way.first();
  ASSERT_LT(closing.time, never);
  way.closings.leave_aside(closing.pair.pair);
  const StepClosing without = way.first();
  EXPECT_TRUE(without.time == never || without.is_passage);
  EXPECT_FALSE(way.closings.any_left_out());
  way.closings.begin_step();
  EXPECT_EQ(way.first().time, closing.time);
}

TEST_P(StepClosingsOnFloors, AreRefutedForOnePhaseAlone) {
  Way way(over_floor(GetParam(), 0.3, 1.0), 0.25, {0.0, -g});
  const StepClosing closing = way.first();
  ASSERT_LT(closing.time, never);
  way.closings.refute(closing.pair.pair);
  EXPECT_TRUE(way.first().time == never || way.first().is_passage);
  way.closings.begin_phase();
  EXPECT_EQ(way.first().time, closing.time);
}

TEST(StepClosing, IsRefutedByAGapThatIsOpenAndGrows) {
  StepClosing dip;
  dip.dips = true;
  dip.gap = 1e-3;
  dip.rate = 0.1;
  EXPECT_TRUE(dip.is_refuted());
  dip.rate = -0.1;
  EXPECT_FALSE(dip.is_refuted());
  dip.rate = 0.1;
  dip.gap = -1e-3;
  EXPECT_FALSE(dip.is_refuted());
  // What was closed at the end of the longer step closes somewhere before.
  dip.gap = 1e-3;
  dip.dips = false;
  EXPECT_FALSE(dip.is_refuted());
}

TEST_P(StepClosingsOnFloors, ThatAreNotLookedForAreLeftOut) {
  Way way(over_floor(GetParam(), 0.3, 1.0), 0.25, {0.0, -g});
  const StepClosing none = way.first(false);
  EXPECT_TRUE(none.time == never || none.is_passage);
  EXPECT_TRUE(way.closings.any_left_out());
  ASSERT_LT(way.first(true).time, never);
  EXPECT_FALSE(way.closings.any_left_out());
  Way open(over_floor(GetParam(), 0.3, 1.0), 0.1, {0.0, -g});
  EXPECT_EQ(open.first(false).time, never);
  EXPECT_FALSE(open.closings.any_left_out());
}

TEST_P(StepClosingsOnFloors, LookAtTheEndOfTheLastWay) {
  constexpr double gap = 0.3, speed = 1.0, shorter = 0.1;
  Way way(over_floor(GetParam(), gap, speed), 0.25, {0.0, -g});
  StepClosing closing = way.first();
  ASSERT_LT(closing.time, never);
  const ConstraintKey key = closing.key;
  StepFlights none_hit;
  const State end = way.model.at(shorter);
  const auto all = [](const SweptPair&) { return true; };
  EXPECT_EQ(way.closings.first({way.model.start, end, way.model.start.v, none_hit, {}}, all).time, never);
  way.closings.look_at_end(closing);
  EXPECT_NEAR(closing.gap, gap - speed * shorter - 0.5 * g * shorter * shorter, found_to);
  EXPECT_NEAR(closing.rate, -speed - g * shorter, found_to);
  EXPECT_EQ(closing.key, key);
}

// A ball that dips into the floor, and comes out of it again at the end: it counts if it is deeper there than
// it was at the start by more than the capture speed makes in the step.
TEST_P(StepClosingsOnFloors, OfABallThatTurnsRoundCountIfItComesDeep) {
  constexpr double span = 0.5, up = 0.8, gap = 1e-5;
  for (const double part : {0.9, 1.1}) {
    const double deeper = part * capture_speed * span, speed = 0.5 * up * span + deeper / span;
    Way way(over_floor(GetParam(), gap, speed), span, {0.0, up});
    const StepClosing closing = way.first();
    if (part < 1.0) {
      EXPECT_EQ(closing.time, never);
      continue;
    }
    EXPECT_NEAR(closing.time, (speed - std::sqrt(speed * speed - 2.0 * up * gap)) / up, found_to / speed);
    EXPECT_NEAR(closing.gap, gap - deeper, found_to);
    EXPECT_NEAR(closing.rate, up * span - speed, found_to);
    EXPECT_FALSE(closing.is_refuted());  // it is closed there
  }
}

System discs_that_meet(double offset, double speed) {
  System system = with_law();
  add_disc(system, {-1.0, offset}, {speed, 0.0});
  add_disc(system, {1.0, 0.0}, {-speed, 0.0});
  return system;
}

TEST(StepClosings, OfTwoDiscsHeadOnIsWhereTheyMeet) {
  Way way(discs_that_meet(0.0, 1.5), 0.65);  // they overlap by 0.15 at the end
  const StepClosing closing = way.first();
  EXPECT_NEAR(closing.time, (2.0 - 2.0 * radius) / 3.0, found_to);
  EXPECT_NEAR(closing.gap, 2.0 - 3.0 * 0.65 - 2.0 * radius, found_to);
  EXPECT_NEAR(closing.rate, -3.0, found_to);
  EXPECT_FALSE(closing.dips);
  EXPECT_EQ(closing.pair.body_count, 2U);
}

/// Offset of two discs that close at a rate where they meet at twice a speed.
double offset_of(double rate, double speed) {
  const double part = rate / (2.0 * speed);
  return 2.0 * radius * std::sqrt(1.0 - part * part);
}

TEST(StepClosings, OfDiscsThatGrazeAreFoundIfTheyAreFasterThanTheCaptureSpeed) {
  constexpr double speed = 1.0, span = 2.0;
  for (const double rate : {1.01 * capture_speed, 0.1, 1.0}) {
    const double offset = offset_of(rate, speed);
    Way way(discs_that_meet(offset, speed), span);
    const StepClosing closing = way.first();
    const double along = std::sqrt(4.0 * radius * radius - offset * offset);
    // As well as slow ones tell when.
    EXPECT_NEAR(closing.time, 0.5 * (2.0 - along) / speed, found_to / rate) << rate;
    EXPECT_TRUE(closing.dips);
    const double apart = std::hypot(2.0 - 2.0 * speed * span, offset);
    EXPECT_NEAR(closing.gap, apart - 2.0 * radius, found_to);
    EXPECT_NEAR(closing.rate, 2.0 * speed * (2.0 * speed * span - 2.0) / apart, found_to);
    EXPECT_TRUE(closing.is_refuted());  // there the gap is open and grows
  }
  for (const double rate : {0.99 * capture_speed, 0.1 * capture_speed}) {
    Way way(discs_that_meet(offset_of(rate, speed), speed), span);
    EXPECT_EQ(way.first().time, never) << rate;
    EXPECT_FALSE(way.closings.any_left_out());
  }
}

// Of several the first one on the way, whichever is listed first.
TEST(StepClosings, AreTheFirstOfAll) {
  for (const bool swapped : {false, true}) {
    System system = with_law();
    system.add(HalfPlane{.normal = {0.0, 1.0}});
    const double early = radius + 0.2, late = radius + 0.4;
    add_disc(system, {0.0, swapped ? late : early}, {0.0, -1.0});
    add_disc(system, {5.0, swapped ? early : late}, {0.0, -1.0});
    Way way(std::move(system), 0.5);
    const StepClosing closing = way.first();
    EXPECT_NEAR(closing.time, 0.2, found_to);
    EXPECT_EQ(closing.pair.pair.body, swapped ? 1U : 0U);
  }
}

// Bodies that overlap where the way begins do not close on it.
TEST(StepClosings, AreNoneOfWhatIsClosedAtTheStart) {
  const double deep = 1e-3;
  EXPECT_EQ(Way(over_floor(Floor::half_plane, -deep, 1.0), 0.1).first().time, never);
  EXPECT_LT(Way(over_floor(Floor::half_plane, deep, 1.0), 0.1).first().time, never);
}

constexpr double half = 1e-3, allowed = (radius + half) / 8.0;

/// A disc that goes 20 m through a thin wall in a step of 1 s. \param at where it is at the start
System through_a_wall(double at) {
  System system = with_law();
  system.add(Wall{.from = {0.0, -1.0}, .to = {0.0, 1.0}, .radius = half});
  add_disc(system, {at, 0.0}, {20.0, 0.0});
  return system;
}

TEST(StepClosings, OfThinThingsThatArePassedAreFoundAtADepth) {
  Way way(through_a_wall(-10.0), 1.0, {}, StepContacts::nothing, ImpactTimes::at_step_start);
  ASSERT_TRUE(way.closings.finds_any());
  const StepClosing closing = way.first();
  EXPECT_TRUE(closing.is_passage);
  // Found from the depth that is allowed down to half of it more.
  const double meets = (10.0 - radius - half) / 20.0;
  EXPECT_GE(closing.time, meets + allowed / 20.0 - found_to);
  EXPECT_LE(closing.time, meets + 1.5 * allowed / 20.0 + found_to);
  const Outlines& outlines = way.model.detector.outlines();
  const std::optional<ContactPair> pair = outlines.pair_of(closing.key);
  ASSERT_TRUE(pair);
  EXPECT_EQ(pair->body, 0U);
  EXPECT_EQ(pair->outline, outlines.of_ground(0));
}

TEST(StepClosings, OfPassagesAreDeeperThanWhatOverlapsAtTheStart) {
  const double deep = 0.03;
  Way way(through_a_wall(-radius - half + deep), 1.0, {}, StepContacts::nothing, ImpactTimes::at_step_start);
  const StepClosing closing = way.first();
  EXPECT_TRUE(closing.is_passage);
  EXPECT_GE(closing.time, allowed / 20.0 - found_to);
  EXPECT_LE(closing.time, 1.5 * allowed / 20.0 + found_to);
}

// A rebound leaves a gap that is rounding, and grows: such a one was taken for the next closing.
TEST(StepClosing, IsReachedWhereTheGapFalls) {
  StepClosing closing;
  closing.deep = -1e-12;
  for (const double gap : {-1e-12, -1e-13, 0.0, 1e-13, 1e-3}) {
    for (const double rate : {-2.0, -1e-9, 0.0, 1e-9, 2.0}) {
      closing.gap = gap;
      closing.rate = rate;
      EXPECT_EQ(closing.is_reached(), gap <= 0.0 && rate < 0.0) << gap << ", " << rate;
      if (rate < 0.0) {
        EXPECT_NEAR(closing.time_by_rate(1.0), 1.0 + (gap + 0.5e-12) / -rate, 1e-9 * std::abs(gap / rate));
      } else {
        EXPECT_EQ(closing.time_by_rate(1.0), never);
      }
    }
  }
}

// Contacts that are given up are not passed through all the same.
TEST(StepClosings, OfContactsThatAreNotLookedForArePassages) {
  Way way(through_a_wall(-10.0), 1.0);
  const double meets = (10.0 - radius - half) / 20.0;
  const StepClosing contact = way.first(true), passage = way.first(false);
  EXPECT_FALSE(contact.is_passage);
  EXPECT_NEAR(contact.time, meets, found_to);
  EXPECT_TRUE(contact.dips);  // behind the wall it is open
  EXPECT_TRUE(passage.is_passage);
  EXPECT_GT(passage.time, meets + allowed / 20.0 - found_to);
}

// Half-planes cannot be passed, one body alone neither.
TEST(StepClosings, FindNothingWhereNothingCanBePassed) {
  for (const int bodies : {1, 2}) {
    System system = over_floor(Floor::half_plane, 0.3, 1.0);
    if (bodies == 2) add_disc(system, {5.0, 1.0}, {0.0, -1.0});
    const Way passages(system, 0.25, {}, StepContacts::nothing, ImpactTimes::at_step_start);
    EXPECT_EQ(passages.closings.finds_any(), bodies == 2);
    EXPECT_TRUE(Way(system, 0.25).closings.finds_any());
  }
}

}  // namespace
