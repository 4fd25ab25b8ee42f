// Records of events that are packed, and the log of a run that unpacks them when somebody looks.

#include <carom/integrators/run/packed_events.h>
#include <carom/integrators/run/recorded_events.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <new>
#include <vector>

namespace {

using namespace carom;

/// A record in which every number has a value of its own.
EventRecord full_record(double seed) {
  EventRecord event;
  event.time = seed;
  event.instant = 7;
  event.kind = EventKind::impact_without_collision;
  event.contact = {{FeatureKey::Owner::shape, 1, 2}, {FeatureKey::Owner::obstacle, 3, 4}};
  event.body = {5, 6};
  event.obstacle = {7, 6};
  event.element = {8, 6};
  event.joint = {9, 6};
  event.other = {10, 6};
  event.mode = ContactMode::slip_negative;
  event.outcome = Outcome::several_solutions;
  event.residual = seed * 1e-13;
  event.solver = "dense sweeps";
  event.energy_gain = seed + 0.1;
  event.contact_work = -seed;
  event.restitution_factor = 0.25;
  event.cut_sequence = true;
  event.rolling_moment = seed + 0.2;
  for (std::size_t i = 0; i < 3; ++i) {
    const double number = seed + 10.0 * static_cast<double>(i + 1);
    event.velocity_before[i] = number + 0.1;
    event.velocity_after[i] = number + 0.2;
    event.impulse[i] = number + 0.3;
    event.point[i] = number + 0.4;
    event.normal[i] = number + 0.5;
    event.motions[i].body = {static_cast<Index>(20 + i), 6};
    for (std::size_t k = 0; k < 3; ++k) {
      event.motions[i].position[k] = number + static_cast<double>(k) + 0.6;
      event.motions[i].velocity_before[k] = number + static_cast<double>(k) + 0.7;
      event.motions[i].velocity_after[k] = number + static_cast<double>(k) + 0.8;
    }
  }
  event.gap = -seed * 1e-9;
  event.energy_before = seed + 1.0;
  event.energy_after = seed + 0.5;
  event.stiffness = -0.3;
  event.free_acceleration = -9.81;
  event.accumulation_time = seed + 2.0;
  return event;
}

void expect_equal(const EventRecord& a, const EventRecord& b) {
  EXPECT_EQ(a.time, b.time);
  EXPECT_EQ(a.instant, b.instant);
  EXPECT_EQ(a.kind, b.kind);
  EXPECT_EQ(a.contact, b.contact);
  EXPECT_TRUE(a.body == b.body && a.obstacle == b.obstacle && a.element == b.element && a.joint == b.joint &&
              a.other == b.other);
  EXPECT_TRUE(a.mode == b.mode && a.outcome == b.outcome && a.residual == b.residual && a.solver == b.solver);
  EXPECT_TRUE(a.energy_gain == b.energy_gain && a.contact_work == b.contact_work &&
              a.restitution_factor == b.restitution_factor && a.cut_sequence == b.cut_sequence &&
              a.rolling_moment == b.rolling_moment);
  EXPECT_TRUE(a.velocity_before == b.velocity_before && a.velocity_after == b.velocity_after &&
              a.impulse == b.impulse && a.point == b.point && a.normal == b.normal && a.gap == b.gap);
  for (std::size_t i = 0; i < 3; ++i) {
    const EventMotion &one = a.motions[i], &other = b.motions[i];
    EXPECT_TRUE(one.body == other.body && one.position == other.position &&
                one.velocity_before == other.velocity_before && one.velocity_after == other.velocity_after);
  }
  EXPECT_TRUE(a.energy_before == b.energy_before && a.energy_after == b.energy_after &&
              a.stiffness == b.stiffness && a.free_acceleration == b.free_acceleration);
  EXPECT_TRUE(a.accumulation_time == b.accumulation_time ||
              (std::isnan(a.accumulation_time) && std::isnan(b.accumulation_time)));
}

EventRecord record_at(double time, std::int64_t instant, double mark = 0.0) {
  EventRecord event;
  event.time = time;
  event.instant = instant;
  event.residual = mark;
  return event;
}

std::vector<double> marks(const PackedEvents& events) {
  std::vector<double> found;
  for (std::size_t i = 0; i < events.size(); ++i) found.push_back(events.record(i).residual);
  return found;
}

TEST(PackedEvents, EveryNumberComesBack) {
  PackedEvents events;
  constexpr int count = 500;  // several blocks of memory
  for (int i = 0; i < count; ++i) {
    events.append(full_record(1.0 + i));
    events.append(EventRecord{});
  }
  ASSERT_EQ(events.size(), std::size_t{2 * count});
  for (int i = 0; i < count; ++i) {
    const auto place = static_cast<std::size_t>(2 * i);
    EXPECT_EQ(events.time(place), 1.0 + i);
    EXPECT_EQ(events.instant(place), 7);
    expect_equal(events.record(place), full_record(1.0 + i));
    expect_equal(events.record(place + 1), EventRecord{});
  }
}

/// A record in memory whose bytes, those between members too, were `byte` before.
EventRecord& record_over(std::vector<std::max_align_t>& memory, int byte) {
  memory.resize(sizeof(EventRecord) / sizeof(std::max_align_t) + 1);
  std::memset(memory.data(), byte, memory.size() * sizeof(std::max_align_t));
  auto* const event = new (memory.data()) EventRecord;
  const EventRecord full = full_record(3.0);
  event->kind = full.kind;
  event->contact.a.owner = full.contact.a.owner;
  event->mode = full.mode;
  return *event;
}

TEST(PackedEvents, BytesBetweenMembersTakeNoMemory) {
  PackedEvents events;
  std::vector<std::max_align_t> memory;
  events.append(record_over(memory, 0));
  events.append(record_over(memory, 0xff));
  EXPECT_EQ(events.bytes(0), events.bytes(1));
  expect_equal(events.record(0), events.record(1));
  events.append(EventRecord{});
  EXPECT_LT(events.bytes(2), events.bytes(0));
}

TEST(PackedEvents, InOrderOfTimeThenAsTheyCame) {
  PackedEvents events;
  PackedEvents::OrderMemory memory;
  const std::vector<double> times{0.2, 0.5, 0.1, 0.2, 0.1};
  for (std::size_t i = 0; i < times.size(); ++i) {
    events.append(record_at(times[i], 0, static_cast<double>(i)));
  }
  events.order(memory);
  EXPECT_EQ(marks(events), (std::vector<double>{2.0, 4.0, 0.0, 3.0, 1.0}));
  events.set_instant(1, 3);
  EXPECT_EQ(events.record(1).instant, 3);
  EXPECT_EQ(events.record(0).instant, 0);
}

TEST(PackedEvents, TheFirstAreDropped) {
  PackedEvents events;
  for (int i = 0; i < 1000; ++i) {
    events.append(record_at(i, i, i));
    if (events.size() > 3) events.drop_first(events.size() - 3);
  }
  EXPECT_EQ(marks(events), (std::vector<double>{997.0, 998.0, 999.0}));
  PackedEvents more;
  more.append(record_at(1.0, 0, 5.0));
  more.append(events);
  EXPECT_EQ(marks(more), (std::vector<double>{5.0, 997.0, 998.0, 999.0}));
  more.clear();
  EXPECT_TRUE(more.empty());
  more.append(record_at(1.0, 0, 6.0));
  EXPECT_EQ(marks(more), (std::vector<double>{6.0}));
}

/// Two records of instant 0, one of instant 1.
PackedEvents three(double time) {
  PackedEvents events;
  for (const int instant : {0, 0, 1}) events.append(record_at(time + instant, instant));
  return events;
}

TEST(RecordedEvents, InstantsGoOnWhetherSomebodyLooksOrNot) {
  for (const int looks_after : {0, 1, 2, 3}) {
    RecordedEvents log;
    for (int i = 0; i < 3; ++i) {
      if (i == looks_after) {
        EXPECT_EQ(log.records().size(), 3U * static_cast<std::size_t>(i));
      }
      PackedEvents fresh = three(10.0 * i);
      log.append(fresh, 0);
      EXPECT_TRUE(fresh.empty());
    }
    log.append({record_at(30.0, 99), record_at(30.0, 99)});
    std::vector<std::int64_t> instants;
    for (const EventRecord& event : log.records()) instants.push_back(event.instant);
    EXPECT_EQ(instants, (std::vector<std::int64_t>{0, 0, 1, 2, 2, 3, 4, 4, 5, 6, 6})) << looks_after;
    log.clear();
    EXPECT_TRUE(log.records().empty());
  }
}

TEST(RecordedEvents, AListThatWasAskedForGoesOn) {
  RecordedEvents log;
  const std::vector<EventRecord>& records = log.records();
  PackedEvents fresh = three(1.0);
  log.append(fresh, 0);
  ASSERT_EQ(records.size(), 3U);
  EXPECT_EQ(records[2].time, 2.0);
  log.clear();
  EXPECT_TRUE(records.empty());
  fresh = three(5.0);
  log.append(fresh, 0);
  ASSERT_EQ(records.size(), 3U);
  EXPECT_EQ(records[0].instant, 0);
}

TEST(RecordedEvents, KeepsTheLatest) {
  for (const bool seen : {false, true}) {
    RecordedEvents log;
    if (seen) {
      EXPECT_TRUE(log.records().empty());
    }
    for (int i = 0; i < 5; ++i) {
      PackedEvents fresh = three(10.0 * i);
      log.append(fresh, 4);
    }
    const std::vector<EventRecord>& records = log.records();
    ASSERT_EQ(records.size(), 4U);
    EXPECT_EQ(records.front().time, 31.0);
    EXPECT_EQ(records.front().instant, 7);
    EXPECT_EQ(records.back().instant, 9);
  }
}

}  // namespace
