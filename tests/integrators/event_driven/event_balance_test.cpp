// Events of groups that advance one after the other are put in the order of time.

#include <carom/carom.h>
#include <carom/core/assembly.h>
#include <carom/core/constraint_set.h>
#include <carom/integrators/event_driven/event_balance.h>

#include <gtest/gtest.h>

#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;

TEST(EventBalance, EventsInTimeThenAsBooked) {
  System system;
  system.add(Particle{.mass = 1.0});
  const Assembly assembly(system);
  EventBalance balance;
  const auto book = [&](double time, double mark) {
    balance.record(EventKind::slip, time, {}, assembly).residual = mark;
  };
  book(0.2, 0.0);
  book(0.5, 1.0);
  book(0.1, 2.0);
  book(0.2, 3.0);
  book(0.1, 4.0);
  balance.settle();
  balance.order_events();
  std::vector<double> marks;
  for (std::size_t i = 0; i < balance.events.size(); ++i) {
    marks.push_back(balance.events.record(i).residual);
  }
  EXPECT_EQ(marks, (std::vector<double>{2.0, 4.0, 0.0, 3.0, 1.0}));
  EXPECT_EQ(balance.counts[static_cast<std::size_t>(EventKind::slip)], 5);
  balance.clear();
  EXPECT_TRUE(balance.events.empty());
  EXPECT_EQ(balance.counts[static_cast<std::size_t>(EventKind::slip)], 0);
}

TEST(EventBalance, CountsWhatItDoesNotKeep) {
  System system;
  system.add(Particle{.mass = 1.0});
  const Assembly assembly(system);
  for (const EventKeeping& keeping : {EventKeeping{}, EventKeeping{true, 3}, EventKeeping{false, 0}}) {
    EventBalance balance(keeping);
    for (int i = 0; i < 20; ++i) {
      // Two groups, one after the other.
      EventRecord& event = balance.record(EventKind::impact, i < 10 ? 1.0 * i : i - 9.5, {}, assembly);
      event.impulse[0] = i % 2 == 0 ? 1.0 : 0.0;
      event.residual = 1e-15 * i;
      balance.settle();
      if (keeping.limit > 0) {
        EXPECT_LT(balance.events.size(), 2 * keeping.limit);
      }
    }
    balance.finish();
    EXPECT_EQ(balance.counts[static_cast<std::size_t>(EventKind::impact)], 20);
    EXPECT_EQ(balance.tally.impacts, 10);
    EXPECT_EQ(balance.tally.worst_residual, 1e-15 * 19);
    std::vector<double> times;
    for (std::size_t i = 0; i < balance.events.size(); ++i) times.push_back(balance.events.time(i));
    if (!keeping.records) {
      EXPECT_TRUE(times.empty());
    } else if (keeping.limit > 0) {
      EXPECT_EQ(times, (std::vector<double>{8.5, 9.0, 9.5}));
    } else {
      EXPECT_EQ(times.size(), 20U);
    }
  }
}

TEST(EventBalance, RecordsTheBodyAndTheObstacleOfAContact) {
  System system;
  const BodyId ball = system.add(Particle{.mass = 1.0});
  const ObstacleId floor = system.add(HalfPlane{.point = {0, 0}, .normal = {0, 1}},
                                      Surface{.friction = 0.0, .normal_restitution = 0.0});
  const Assembly assembly(system);
  const Detector detector(assembly);
  const State state = assembly.initial_state();
  ConstraintSet contacts;
  detector.find(0, state.view(), make_evaluation(assembly), 1.0, contacts);
  ASSERT_EQ(contacts.size(), 1U);
  EventBalance balance;
  const EventRecord& event = balance.record(EventKind::closing, 0.3, contacts[0], assembly);
  EXPECT_EQ(event.time, 0.3);
  EXPECT_EQ(event.body, ball);
  EXPECT_EQ(event.obstacle, floor);
  EXPECT_EQ(event.contact, contacts[0].key);
}

}  // namespace
