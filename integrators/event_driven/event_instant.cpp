// Problem: all stages of an event see the same state.

#include <carom/integrators/event_driven/event_instant.h>

#include <algorithm>

namespace carom {

EventInstant::EventInstant(SmoothMotion& group, InstantMemory& memory, double at_time, std::span<double> y_in,
                           EventBalance& books)
    : motion(group),
      time(at_time),
      y(y_in),
      now(memory.now),
      contacts(memory.contacts),
      before(memory.before),
      before_at(memory.before_at),
      islands(memory.islands),
      balance(books) {}

void EventInstant::update() {
  motion.sample(time, y.data(), Forces::without_contact, now);
  contacts.resize(motion.model().pairs.size());
  for (std::size_t i = 0; i < contacts.size(); ++i) motion.contact(i, now, contacts[i]);
}

void EventInstant::take_contacts_before() {
  before = motion.active().list();
  before_at.assign(motion.model().pairs.size(), none);
  for (Index i = 0; i < before.size(); ++i) before_at[before[i].place] = i;
}

void EventInstant::find_islands() {
  // Projections during the event move bodies by less than this.
  constexpr double moved = 4.0;
  const double near = moved * std::max(motion.model().options->gap_tolerance, touch_gap);
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
