// Slow contacts: up to which speed impacts are slow, and how such contacts are closed.

#include "tests/integrators/event_driven/body_scenes.h"

#include <carom/carom.h>
#include <carom/core/assembly.h>
#include <carom/integrators/event_driven/event_balance.h>
#include <carom/integrators/event_driven/event_instant.h>
#include <carom/integrators/event_driven/group_memory.h>
#include <carom/integrators/event_driven/group_set.h>
#include <carom/integrators/event_driven/slow_contacts.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <memory>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace body_scenes;

/// All bodies of a model as one clock group, at the instant at which it begins.
class Instant {
public:
  explicit Instant(const System& system)
      : assembly_(system),
        detector_(assembly_),
        memory_(assembly_, options_, nullptr),
        groups_(assembly_, detector_, options_, memory_),
        group_(make()),
        at_(group_->parts().motion, memory_.instant, 0.0, group_->parts().y, balance_) {
    motion().model().unknowns.gather(assembly_.initial_state(), group_->parts().y);
    at_.update();
    at_.scales = event_scales(motion(), at_.now, at_.contacts);
    at_.touch_gap = 4.0 * at_.scales.gap_noise;
    at_.take_contacts_before();
    at_.find_islands();
  }

  [[nodiscard]] EventInstant& at() { return at_; }
  [[nodiscard]] const EventBalance& balance() const { return balance_; }
  [[nodiscard]] SmoothMotion& motion() { return group_->parts().motion; }
  [[nodiscard]] double kinetic() { return motion().model().kinetic_energy(at_.velocities()); }
  /// All pairs.
  [[nodiscard]] std::vector<Index> pairs() const {
    std::vector<Index> all(at_.contacts.size());
    std::iota(all.begin(), all.end(), Index{0});
    return all;
  }
  /// The pair of a body with another one, or with a shape on ground.
  [[nodiscard]] Index pair(Index body, Index other, Index ground_shape = none) {
    const std::vector<ContactPair>& all = motion().model().pairs;
    for (Index i = 0; i < all.size(); ++i) {
      const bool same = all[i].body == body && all[i].other == other;
      if ((same && all[i].ground_shape == ground_shape) ||
          (other != none && all[i].body == other && all[i].other == body))
        return i;
    }
    ADD_FAILURE() << "no such pair";
    return 0;
  }
  [[nodiscard]] Index on_ground(Index body, Index shape) { return pair(body, none, shape); }
  /// Contacts to be closed.
  [[nodiscard]] std::vector<ActiveContact> closed(
      std::initializer_list<std::pair<Index, ContactMode>> wanted) const {
    std::vector<ActiveContact> list;
    for (const auto& [place, mode] : wanted) {
      ActiveContact& contact = list.emplace_back();
      contact.mode = mode;
      contact.at = at_.contacts[place];
      contact.place = place;
    }
    return list;
  }

private:
  [[nodiscard]] std::unique_ptr<ClockGroup> make() const {
    std::vector<Index> all(assembly_.components().size());
    std::iota(all.begin(), all.end(), Index{0});
    return groups_.make(all);
  }

  Assembly assembly_;
  Detector detector_;
  EventDriven options_;
  GroupMemory memory_;
  GroupSet groups_;
  std::unique_ptr<ClockGroup> group_;
  EventBalance balance_;
  EventInstant at_;
};

constexpr double radius = 0.1, mass = 2.0;
constexpr ContactMode slip = ContactMode::slip_positive, stick = ContactMode::stick;

/// A floor with gravity, and the law of all contacts.
System on_floor(double height = 0.0) {
  System system;
  system.add(Gravity{{0.0, -g}});
  system.set_default_law({.friction = 0.5, .normal_restitution = 0.5});
  system.add(HalfPlane{.point = {0.0, height}, .normal = {0.0, 1.0}});
  return system;
}

TEST(SlowContacts, AreSlowUpToTheOption) {
  System system = on_floor();
  add_disc(system, mass, radius, {0.0, radius});
  add_disc(system, mass, radius, {1.0, radius});
  Instant instant(system);
  const std::vector<Index> pairs = instant.pairs();
  // A fall through four times the rounding of a gap: 2e-6 m/s within a metre of the origin.
  const double fall = std::sqrt(2.0 * 4.0 * gap_noise_of(1.0, EventDriven{}) * g);
  EXPECT_NEAR(speed_of_rounding(pairs, instant.at()), fall, 1e-3 * fall + 1e-6);
  EXPECT_EQ(capture_speed(pairs, instant.at()), EventDriven{}.capture_speed);
}

TEST(SlowContacts, AreFasterWhereGapsAreRoundedMore) {
  constexpr double far = 1e6;
  System system = on_floor(far);
  add_disc(system, mass, radius, {0.0, far + radius});
  add_disc(system, mass, radius, {1.0, far + radius});
  Instant instant(system);
  const double fall = std::sqrt(2.0 * 4.0 * gap_noise_of(far, EventDriven{}) * g);
  EXPECT_GT(fall, EventDriven{}.capture_speed);
  EXPECT_NEAR(capture_speed(instant.pairs(), instant.at()), fall, 1e-3 * fall);
}

TEST(SlowContacts, AreFasterWhereForcesOfContactThrewBodies) {
  constexpr double times = 1e6;  // its weight, by a heavy body above
  System system = on_floor();
  add_disc(system, mass, radius, {0.0, radius});
  add_disc(system, mass, radius, {1.0, 2.0 * radius});  // does not touch
  Instant instant(system);
  const std::vector<Index> pairs = instant.pairs();
  const double before = speed_of_rounding(pairs, instant.at());
  const Constraint& touching = instant.at().contacts[instant.on_ground(0, 0)];
  const Constraint& apart = instant.at().contacts[instant.on_ground(1, 0)];
  instant.at().acceleration_before[apart.blocks[0].v + 1] = 2.0 * times * g;
  EXPECT_EQ(speed_of_rounding(pairs, instant.at()), before);
  instant.at().acceleration_before[touching.blocks[0].v + 1] = times * g;
  EXPECT_NEAR(speed_of_rounding(pairs, instant.at()), std::sqrt(times) * before, 1e-6 * before);
}

TEST(ContactClosing, TakesNormalVelocitiesAndGapsAndBooksTheEnergy) {
  constexpr double left = 1e-14, parts = 5e-5, slides = 3e-5;
  System system = on_floor();
  add_disc(system, mass, radius, {0.0, radius + left}, {slides, parts});
  add_disc(system, mass, radius, {1.0, radius});
  Instant instant(system);
  EventInstant& at = instant.at();
  const Index place = instant.on_ground(0, 0);
  const double gap = at.contacts[place].gap;  // rounded
  std::vector<ActiveContact> contacts = instant.closed({{place, slip}});
  ContactClosing closing;
  ASSERT_TRUE(closing.close(contacts, {}, at));
  EXPECT_NEAR(at.contacts[place].gap, 0.0, at.scales.gap_noise);
  EXPECT_NEAR(at.approach(place), 0.0, at.scales.speed_noise);
  EXPECT_EQ(at.contacts[place].tangential_velocity(at.velocities()), slides);  // slides on
  const double lost = 0.5 * mass * parts * parts;
  EXPECT_NEAR(at.balance.flows[EnergyFlow::accumulation], lost + mass * g * gap, 1e-9 * lost);
  EXPECT_TRUE(instant.motion().active().list().empty());  // nothing is in the active set by it
}

TEST(ContactClosing, StopsTheSlidingOfWhatSticks) {
  constexpr double slides = 3e-5;
  System system = on_floor();
  add_disc(system, mass, radius, {0.0, radius}, {slides, 0.0});
  add_disc(system, mass, radius, {1.0, radius});
  Instant instant(system);
  EventInstant& at = instant.at();
  const double before = instant.kinetic();
  const Index place = instant.on_ground(0, 0);
  std::vector<ActiveContact> contacts = instant.closed({{place, stick}});
  ContactClosing closing;
  ASSERT_TRUE(closing.close(contacts, {}, at));
  EXPECT_NEAR(at.contacts[place].tangential_velocity(at.velocities()), 0.0, at.scales.speed_noise);
  // It rolls on: of a solid disc friction takes a third of the energy of sliding.
  EXPECT_NEAR(instant.kinetic(), 2.0 / 3.0 * before, 1e-9 * before);
  EXPECT_NEAR(at.balance.flows[EnergyFlow::accumulation], before - instant.kinetic(), 1e-9 * before);
}

// A disc in a corner of two planes that are almost parallel, 1e-10 m from the second: both gaps close only
// 2e-6 m away.
TEST(ContactClosing, LeavesAllAsItWasWhereBodiesWouldMoveFar) {
  constexpr double angle = 5e-5, left = 1e-10;
  System system = on_floor();
  const Vec<2> inclined(std::sin(angle), std::cos(angle)), rest(0.0, radius);
  system.add(HalfPlane{.point = rest - (radius + left) * inclined, .normal = inclined});
  add_disc(system, mass, radius, rest, {0.0, 1e-6});
  add_disc(system, mass, radius, {1.0, 2.0 * radius});
  Instant instant(system);
  EventInstant& at = instant.at();
  const std::vector<double> before(at.y.begin(), at.y.end());
  std::vector<ActiveContact> both =
      instant.closed({{instant.on_ground(0, 0), slip}, {instant.on_ground(0, 1), slip}});
  ContactClosing closing;
  EXPECT_FALSE(closing.close(both, {}, at));
  EXPECT_EQ(std::vector<double>(at.y.begin(), at.y.end()), before);
  EXPECT_EQ(at.approach(instant.on_ground(0, 0)), -1e-6);  // the instant too
  EXPECT_EQ(at.balance.flows[EnergyFlow::accumulation], 0.0);
  std::vector<ActiveContact> one = instant.closed({{instant.on_ground(0, 0), slip}});
  EXPECT_TRUE(closing.close(one, {}, at));
}

/// Two discs of which the second parts from the first, and a third one above, which the first runs into once
/// it follows the second.
System pushed(double speed) {
  System system;
  system.set_default_law({.friction = 0.0, .normal_restitution = 0.5});
  constexpr double high = 1.3;  // of the line to the third one [rad]
  add_disc(system, mass, radius, {0.0, 0.0});
  add_disc(system, mass, radius, {2.0 * radius, 0.0}, {speed, 0.0});
  add_disc(system, mass, radius, 2.0 * radius * Vec<2>(std::cos(high), std::sin(high)));
  return system;
}

TEST(ContactClosing, ClosesWhatItPushesIfAskedFor) {
  constexpr double speed = 1e-5;
  ContactClosing closing;
  Instant alone(pushed(speed)), together(pushed(speed));
  const Index first = alone.pair(0, 1), second = alone.pair(0, 2);
  std::vector<ActiveContact> contacts = alone.closed({{first, slip}});
  ASSERT_TRUE(closing.close(contacts, {}, alone.at()));
  EXPECT_GT(alone.at().approach(second), 0.1 * speed);
  EXPECT_EQ(contacts.size(), 1U);
  contacts = together.closed({{first, slip}});
  ASSERT_TRUE(closing.close(contacts, together.pairs(), together.at()));
  EXPECT_EQ(contacts.size(), 2U);
  for (const Index place : {first, second})
    EXPECT_NEAR(together.at().approach(place), 0.0, together.at().scales.speed_noise);
  EXPECT_NEAR(together.balance().flows[EnergyFlow::accumulation],
              0.5 * mass * speed * speed - together.kinetic(), 1e-9 * mass * speed * speed);
}

}  // namespace
