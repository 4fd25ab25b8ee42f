// Bodies of different clock groups meet: flights between two moments, guesses in the queue, times of
// meetings, and impacts of a row of bodies that all but touch.

#include "tests/random.h"

#include <carom/carom.h>
#include <carom/integrators/event_driven/body_flights.h>
#include <carom/integrators/event_driven/meeting_queue.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <set>

namespace {

using namespace carom;
using namespace carom::planar;

/// A polynomial of degree 5 and its derivatives at a time.
CoordinateMotion on_polynomial(const std::array<double, 6>& c, double t) {
  CoordinateMotion at;
  for (std::size_t k = c.size(); k-- > 0;) {
    at.acceleration = at.acceleration * t + 2.0 * at.rate;
    at.rate = at.rate * t + at.place;
    at.place = at.place * t + c[k];
  }
  return at;
}

TEST(BodyFlight, IsTheCurveOfDegreeFiveThroughBothItsEnds) {
  carom_test::Random random(1);
  for (int run = 0; run < 100; ++run) {
    std::array<std::array<double, 6>, 3> of{};
    for (auto& polynomial : of) {
      for (double& c : polynomial) c = random.uniform(-1.0, 1.0);
    }
    BodyFlight flight;
    flight.is_curve = true;
    flight.time = 2.0;
    flight.due = 2.0 + random.uniform(0.1, 1.0);
    for (std::size_t k = 0; k < of.size(); ++k) {
      flight.begin[k] = on_polynomial(of[k], flight.time);
      flight.end[k] = on_polynomial(of[k], flight.due);
    }
    const double at = random.uniform(flight.time, flight.due);
    const BodyMoment moment = flight.moment(at);
    const double length = flight.due - flight.time;
    for (std::size_t k = 0; k < of.size(); ++k) {
      const CoordinateMotion right = on_polynomial(of[k], at);
      constexpr double rounding = 1e-12;  // of sums up to 100, divided by the length once and twice
      EXPECT_NEAR(moment[k].place, right.place, rounding);
      EXPECT_NEAR(moment[k].rate, right.rate, rounding / length);
      EXPECT_NEAR(moment[k].acceleration, right.acceleration, rounding / (length * length));
    }
  }
}

TEST(BodyFlight, IsAParabolaUnderConstantFieldsAndStandsAtRest) {
  BodyFlight flight;
  flight.is_free = true;
  flight.time = 1.0;
  flight.due = 3.0;
  flight.begin = {{{1.0, 2.0, -10.0}, {0.5, -1.0, 0.0}, {0.1, 4.0, 0.0}}};
  const BodyMoment flown = flight.moment(1.5);
  EXPECT_EQ(flown[0].place, 1.0 + 0.5 * (2.0 - 2.5));
  EXPECT_EQ(flown[0].rate, -3.0);
  EXPECT_EQ(flown[1].place, 0.0);
  EXPECT_EQ(flown[2].place, 2.1);
  flight.is_free = false;
  flight.is_curve = true;
  flight.due = std::numeric_limits<double>::infinity();
  flight.begin = {{{1.0, 0.0, 0.0}, {0.5, 0.0, 0.0}, {0.1, 0.0, 0.0}}};
  EXPECT_EQ(flight.moment(7.0)[0].place, 1.0);
}

TEST(MeetingQueue, HandsOnGuessesInTheOrderOfTime) {
  MeetingQueue queue;
  queue.start(3);
  queue.add(2.0, 0, 1, {.pair = {.body = 4, .other = 5}, .from = 0.5});
  queue.add(1.0, 1, 2);
  Appointment at;
  ASSERT_TRUE(queue.take(3.0, at));
  EXPECT_EQ(at.time, 1.0);
  EXPECT_EQ(at.guess.pair.body, none);
  ASSERT_TRUE(queue.take(3.0, at));
  EXPECT_EQ(at.guess.pair.other, 5u);
  EXPECT_EQ(at.guess.from, 0.5);
  queue.add(2.0, 0, 1, {.pair = {.body = 4, .other = 5}, .from = 0.5});
  queue.change(1);
  EXPECT_FALSE(queue.take(3.0, at));
}

// Each body swings on a spring of its own, so that the steps of both end at times of their own.
TEST(MeetingTimes, OfBodiesOnSpringsAreAtTheTimesOfTheClosedForm) {
  const double radius = 0.1, speed = 3.0, omega = 4.0, apart = 1.0;
  for (const FlowMethod method :
       {FlowMethod::explicit_runge_kutta, FlowMethod::adams, FlowMethod::bdf, FlowMethod::one_step}) {
    System system;
    system.set_default_law({.friction = 0.0, .normal_restitution = 1.0, .tangential_restitution = 0.0});
    for (const double side : {-1.0, 1.0}) {
      const Vec<2> place(0.5 * side * apart, 0.0);
      const BodyId body = system.add(
          RigidBody{.mass = disc(1.0, radius), .position = place, .velocity = {-side * speed, 0.0}});
      system.add(Disc{.body = body, .radius = radius});
      // Behind the body, along the line: it stays linear.
      system.add(SpringDamper{.from = {ground, place + Vec<2>(side, 0.0)},
                              .to = body,
                              .stiffness = omega * omega,
                              .free_length = 1.0});
    }
    Simulation simulation(system, EventDriven{.method = method});
    simulation.run_until(0.5);
    ASSERT_FALSE(simulation.events().empty());
    const double right = std::asin(0.5 * (apart - 2.0 * radius) * omega / speed) / omega;
    EXPECT_NEAR(simulation.events().front().time, right, 1e-9) << static_cast<int>(method);  // the tolerance
  }
}

/// Discs in a row, the first of which comes at 1 m/s. \param gap between all others [m]
System row_of_discs(double gap) {
  System system;
  system.set_default_law({.friction = 0.0, .normal_restitution = 0.5, .tangential_restitution = 0.0});
  for (int i = 0; i < 6; ++i) {
    const double place = i == 0 ? -0.3 : i * (0.2 + gap);
    const BodyId body = system.add(
        RigidBody{.mass = disc(1.0, 0.1), .position = {place, 0.0}, .velocity = {i == 0 ? 1.0 : 0.0, 0.0}});
    system.add(Disc{.body = body, .radius = 0.1});
  }
  return system;
}

// Below gap_tolerance bodies touch, at events as at a start: a chain of impacts nanoseconds apart is one.
TEST(MeetingTimes, ARowOverGapsBelowTheToleranceIsHitAtOnce) {
  const auto instants = [](Simulation& simulation) {
    std::set<std::int64_t> all;
    for (const EventRecord& event : simulation.events()) all.insert(event.instant);
    return all.size();
  };
  Simulation touching(row_of_discs(0.0), EventDriven{});
  touching.run_until(0.4);
  Simulation near(row_of_discs(1e-10), EventDriven{});
  near.run_until(0.4);
  Simulation apart(row_of_discs(1e-6), EventDriven{});
  apart.run_until(0.4);
  EXPECT_EQ(instants(near), instants(touching));
  EXPECT_GT(instants(apart), instants(near));
  for (std::size_t i = 0; i < touching.state().v.size(); ++i)
    EXPECT_NEAR(near.state().v[i], touching.state().v[i], 1e-9);  // levers turn by the gaps
}

}  // namespace
