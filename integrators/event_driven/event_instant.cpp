// Problem: all stages of an event see the same state.

#include <carom/contact/detection/rolling_resistance.h>
#include <carom/integrators/event_driven/event_instant.h>

#include <algorithm>
#include <limits>

namespace carom {

EventInstant::EventInstant(SmoothMotion& group, InstantMemory& memory, double at_time, std::span<double> y_in,
                           EventBalance& books)
    : motion(group),
      time(at_time),
      y(y_in),
      now(memory.now),
      acceleration_before(memory.acceleration_before),
      contacts(memory.contacts),
      before(memory.before),
      before_at(memory.before_at),
      islands(memory.islands),
      balance(books) {
  // Who asks has contact pairs.
  if (!motion.model().pairs.empty()) acceleration_before.resize(now.acceleration.size());
}

void EventInstant::update() {
  motion.sample(time, y.data(), Forces::without_contact, now);
  contacts.resize(motion.model().pairs.size());
  const GroupModel& model = motion.model();
  const double near = near_gap(*model.options);
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (model.pairs[i].rolling) {
      contacts[i] =
          rolling_resistance(contacts[i - 1], motion_of(*model.detector, model.pairs[i], now.places));
      continue;
    }
    motion.contact_if_near(i, now, near, contacts[i]);
    const Index bound = model.bound_of(i);
    if (bound == none || contacts[i].gap > near || model.bounds[bound].rounding > 0.0) continue;
    if (!motion.regions(model.pairs[i], now).may_touch()) {
      contacts[i].gap = std::numeric_limits<double>::infinity();
    }
  }
}

void EventInstant::take_accelerations_before() {
  if (motion.model().pairs.empty()) return;
  motion.model().unknowns.for_velocities([&](Range v, std::size_t) {
    std::copy(now.acceleration.begin() + v.begin, now.acceleration.begin() + v.end,
              acceleration_before.begin() + v.begin);
  });
}

void EventInstant::take_contacts_before() {
  before = motion.active().list();
  before_at.assign(motion.model().pairs.size(), none);
  for (Index i = 0; i < before.size(); ++i) before_at[before[i].place] = i;
}

double EventInstant::longest_shift() const {
  constexpr double moved = 4.0;
  return moved * std::max(motion.model().options->gap_tolerance, touch_gap);
}

void EventInstant::find_islands() {
  const double near = longest_shift();
  const auto is_near = [&](std::size_t pair) {
    return before_at[pair] != none || contacts[pair].gap <= near;
  };
  islands.find(motion.model(), is_near);
}

void EventInstant::take_velocities() {
  for (const auto& part : motion.model().parts()) {
    const Range v = part.ranges.v;
    std::copy(now.state.v.begin() + v.begin, now.state.v.begin() + v.end, y.data() + part.v);
  }
}

}  // namespace carom
