// Problem: end what is too slow to be followed.

#include <carom/integrators/event_driven/group_closure.h>
#include <carom/integrators/event_driven/slow_contacts.h>

#include <algorithm>
#include <cmath>

namespace carom {

double speed_of_rounding(std::span<const Index> pairs, const EventInstant& at) {
  double fall = 0.0;
  for (const Index i : pairs) {
    const Constraint& contact = at.contacts[i];
    if (!at.touches(i)) continue;
    for (const double* acceleration : {at.now.acceleration.data(), at.acceleration_before.data()})
      fall = std::max(fall, std::abs(contact.normal_acceleration(acceleration)));
  }
  return std::sqrt(2.0 * 4.0 * at.scales.gap_noise * fall);
}

double capture_speed(std::span<const Index> pairs, const EventInstant& at) {
  return std::max(at.motion.model().options->capture_speed, speed_of_rounding(pairs, at));
}

bool ContactClosing::close(std::vector<ActiveContact>& contacts, std::span<const Index> others,
                           EventInstant& at) {
  before_.assign(at.y.begin(), at.y.end());
  if (project(contacts, others, at)) return true;
  std::copy(before_.begin(), before_.end(), at.y.begin());
  at.update();
  return false;
}

bool ContactClosing::add_approaching(std::vector<ActiveContact>& contacts, std::span<const Index> others,
                                     const EventInstant& at) {
  const std::size_t before = contacts.size();
  for (const Index i : others) {
    const Constraint& contact = at.contacts[i];
    if (!at.touches(i) || at.approach(i) <= at.scales.speed_noise) continue;
    const auto same = [&](const ActiveContact& known) { return known.place == i; };
    const auto known = contacts.begin() + static_cast<std::ptrdiff_t>(before);
    if (std::any_of(contacts.begin(), known, same)) continue;  // rounding, or a turned row
    ActiveContact& added = contacts.emplace_back();
    added.mode = ContactMode::slip_positive;
    added.at = contact;
    added.place = i;
  }
  return contacts.size() > before;
}

/// Speed that a contact loses by closing [m/s].
double ContactClosing::speed_to_stop(const ActiveContact& contact, const EventInstant& at) {
  const double normal = std::abs(contact.at.normal_velocity(at.velocities()));
  if (contact.mode != ContactMode::stick) return normal;
  return std::max(normal, contact.at.sliding_speed(at.velocities()));
}

/// Largest change of a velocity since the state before, of spins times the radius of gyration [m/s].
double ContactClosing::largest_change(const EventInstant& at) const {
  const std::vector<double>& lengths = at.motion.memory().closure.lengths;
  double largest = 0.0;
  for (const auto& part : at.motion.model().parts()) {
    for (Index i = part.ranges.v.begin; i < part.ranges.v.end; ++i) {
      const std::size_t in_y = part.v + (i - part.ranges.v.begin);
      largest = std::max(largest, lengths[i] * std::abs(at.y[in_y] - before_[in_y]));
    }
  }
  return largest;
}

bool ContactClosing::project(std::vector<ActiveContact>& contacts, std::span<const Index> others,
                             EventInstant& at) const {
  constexpr int most_projections = 3;  // a shift turns rows
  std::vector<ActiveContact>& active = at.motion.active().list();
  const auto is_closed = [&](const ActiveContact& contact) {
    return std::abs(contact.at.normal_velocity(at.velocities())) <= at.scales.speed_noise;
  };
  // Rows that are almost parallel have both gaps closed far away only. Deep gaps, as steps in time leave at a
  // start, are farther than what touches at an event. So it is with velocities: where to stop what is slow is
  // to stop a whole mechanism of bodies, it moves on. Levers in piles of sharp polygons amplify a
  // hundredfold.
  constexpr double most_of_gap = 16.0, most_of_speed = 256.0;
  double lost = 0.0, shift = 0.0, longest = at.longest_shift(), stopped = 0.0;
  for (const ActiveContact& contact : contacts) {
    longest = std::max(longest, most_of_gap * std::abs(contact.at.gap));
    stopped = std::max(stopped, speed_to_stop(contact, at));
  }
  const double fastest = most_of_speed * std::max(stopped, at.motion.model().options->capture_speed);
  for (int i = 0; i < most_projections;) {
    active.swap(contacts);
    const Closure closure = carom::close(at.motion, at.now, at.y);
    active.swap(contacts);
    lost += closure.lost;
    shift += closure.shift;
    if (shift > longest) return false;
    if (closure.changed) at.update();
    if (largest_change(at) > fastest) return false;
    for (ActiveContact& contact : contacts) contact.at = at.contacts[contact.place];
    if (add_approaching(contacts, others, at)) {
      i = 0;
    } else if (!closure.changed || std::all_of(contacts.begin(), contacts.end(), is_closed)) {
      at.balance.flows[EnergyFlow::accumulation] += lost;
      at.balance.shift = std::max(at.balance.shift, shift);
      return true;
    } else {
      ++i;
    }
  }
  return false;
}

}  // namespace carom
