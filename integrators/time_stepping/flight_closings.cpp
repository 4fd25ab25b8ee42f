// Problem: the first instant within a flight at which a gap closes.

#include <carom/integrators/time_stepping/flight_closings.h>

#include <algorithm>
#include <cmath>

namespace carom {

namespace {

constexpr double together = 1e-8;  // shares of a step that differ by less are one instant

/// Rate of the normal velocity of a contact of a body in a flight, with the contacts that take part in it.
double acceleration_along(const Constraint& contact, const LocatedBody& at, const MotionPhase& flight) {
  const double time = (flight.end - flight.begin) * at.in.step;
  double change = 0.0;
  for (Index i = 0; i < at.slot.v_size; ++i) change += contact.row(0)[i] * (flight.v1[i] - flight.v0[i]);
  return change / time + contact.drift[0];
}

/// A gap where it was looked at.
struct SeenGap {
  double share;  // of the step
  double gap;    // [m]
  double rate;   // [m/share]
};

/// The zero of a gap that has the values and rates of two looks, near the second: of a cubic, by Newton's
/// method from where that look alone leads, which is all if both are one. Flights under constant loads are
/// parabolas.
double zero_by(const SeenGap& before, const SeenGap& last) {
  constexpr int tries = 4;  // each squares what is wrong
  double way = -last.gap / last.rate;
  const double far = before.share - last.share;
  if (far == 0.0) return last.share + way;
  const double mean = (before.gap - last.gap) / far;
  const double second = (3.0 * mean - 2.0 * last.rate - before.rate) / far;
  const double third = (last.rate + before.rate - 2.0 * mean) / (far * far);
  for (int i = 0; i < tries; ++i) {
    const double gap = last.gap + way * (last.rate + way * (second + way * third));
    way -= gap / (last.rate + way * (2.0 * second + way * 3.0 * third));
  }
  return last.share + way;
}

}  // namespace

std::span<const FlightClosing> FlightClosings::find(const LocatedBody& at, const MotionPhase& flight,
                                                    std::span<const ConstraintKey> known, FlightLook& look) {
  known_.assign(known.begin(), known.end());
  list_.clear();
  add(at, flight, flight.end, look.find(at, flight.end, 0.0, false));
  if (list_.empty()) return list_;
  // Those that are found on the way are looked for too.
  for (std::size_t i = 0; i < list_.size(); ++i) locate(at, flight, i, look);
  const auto earlier = [](const FlightClosing& a, const FlightClosing& b) {
    return a.share < b.share || (a.share == b.share && a.key < b.key);
  };
  std::sort(list_.begin(), list_.end(), earlier);
  const double last = list_.front().share + together;
  std::erase_if(list_, [&](const FlightClosing& closing) { return closing.share > last; });
  return list_;
}

/// Adds contacts that are not open any more and were not known. At the end of a flight those that touch and
/// approach too; on the way only what goes deeper: what was hit before may still be leaving.
void FlightClosings::add(const LocatedBody& at, const MotionPhase& flight, double share,
                         const ConstraintSet& found) {
  const bool at_end = share == flight.end;
  const double* const v = at.trial.end.v.data();
  for (const Constraint& contact : found) {
    if (std::find(known_.begin(), known_.end(), contact.key) != known_.end()) continue;
    const double rate = contact.normal_velocity(v);
    const bool inside = contact.gap < 0.0, approaches = rate < 0.0;
    if (!(at_end ? inside || approaches : inside && approaches)) continue;
    const auto is_it = [&](const FlightClosing& closing) { return closing.key == contact.key; };
    if (std::any_of(list_.begin(), list_.end(), is_it)) continue;
    list_.push_back({contact.key, contact.gap, rate, acceleration_along(contact, at, flight),
                     contact.speed(0, v), share, false});
  }
}

/// When a gap closes that is not open any more at a time of a flight: by Newton's method, kept between a time
/// at which the gap is open and one at which it is not. A contact is open where it is not found: the body has
/// not come to its face yet. Another face may be closed there that the body has left by the end.
void FlightClosings::locate(const LocatedBody& at, const MotionPhase& flight, std::size_t which,
                            FlightLook& look) {
  constexpr int most_tries = 100;
  constexpr double close = 1e-15;  // of the step
  constexpr double caution = 4.0;  // velocities change on the way
  FlightClosing closing = list_[which];
  const double margin = std::abs(closing.gap) + caution * at.in.step * closing.speed;
  double open = flight.begin, closed = closing.share, share = closed;
  SeenGap last{share, closing.gap, closing.rate * at.in.step};  // where it was found last
  SeenGap before = last;                                        // and the time before
  bool found = true;                                            // at the last look
  bool jumps = false;                                           // not found at `open`: its gap has no zero
  for (int tries = 0; tries < most_tries && !(found && last.gap == 0.0); ++tries) {
    double next = found ? zero_by(before, last) : open;
    if (!(next > open && next < closed)) next = 0.5 * (open + closed);
    if (std::abs(next - share) <= close || !(next > open && next < closed)) break;
    if (jumps && closed - open <= together) break;
    share = next;
    FlightLook::go(at, flight, share);
    const ConstraintSet& near = look.find(at, share, margin, false);
    add(at, flight, share, near);
    const auto is_it = [&](const Constraint& contact) { return contact.key == closing.key; };
    const auto contact = std::find_if(near.begin(), near.end(), is_it);
    found = contact != near.end();
    if (found) {
      before = last;
      last = {share, contact->gap, at.in.step * contact->normal_velocity(at.trial.end.v.data())};
      closing.acceleration = acceleration_along(*contact, at, flight);
    }
    if (found && last.gap < 0.0) {
      closed = share;
      closing.rate = last.rate / at.in.step;
    } else {
      open = share;
      jumps = !found;
    }
  }
  list_[which].share = found ? share : closed;
  const double rate = found ? last.rate / at.in.step : closing.rate;
  const CaptureRule& capture = at.rules.capture;
  list_[which].rebounds = capture.is_fast(rate) || capture.is_free(rate, closing.acceleration);
}

}  // namespace carom
