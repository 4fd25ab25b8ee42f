// Problem: where a body is within a step, and what it may touch there.

#include <carom/contact/detection/detector.h>
#include <carom/integrators/time_stepping/flight_look.h>
#include <carom/integrators/time_stepping/step_kernels.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace carom {

void FlightLook::go(const LocatedBody& at, const MotionPhase& flight, double share) {
  std::array<double, 6> load0{}, load1{}, response{};
  const std::array<float, 6> nothing{};
  const double part = (share - flight.begin) / (flight.end - flight.begin);
  const Index v = at.slot.v, size = at.slot.v_size;
  for (Index i = 0; i < size; ++i) {
    load0[i] = at.loads.at(v + i, flight.begin, flight.hit);
    load1[i] = at.loads.at(v + i, share, flight.hit);
    if (!flight.constraints.empty()) response[i] = part * at.trial.dv_impulses[v + i];
  }
  const bool first = flight.begin == 0.0;
  sweep_bodies(
      at.kind.masses(at.slot.slot), 1, (share - flight.begin) * at.in.step,
      {flight.q.data(), flight.v0.data(), first ? at.in.companion.rounding.data() + v : nothing.data(),
       load0.data(), load1.data(), response.data(), at.trial.end.q.data() + at.slot.q,
       at.trial.end.v.data() + v, at.trial.rounding.data() + v, at.rule.is_mean()});
}

void FlightLook::rotate(const LocatedBody& at) {
  if (at.slot.rotation == none) return;
  at.kind.rotations({at.slot.slot, at.slot.slot + 1}, at.trial.end.q.data() + at.slot.q,
                    at.trial.at_end.rotation.data() + at.slot.rotation);
}

const ConstraintSet& FlightLook::find(const LocatedBody& at, double share, double margin, bool to_end) {
  return find(at, share, margin, to_end, nullptr);
}

const ConstraintSet& FlightLook::find(const LocatedBody& at, double share, double margin, bool to_end,
                                      const LastingContacts* lasting) {
  StateView view = at.trial.end.view();
  view.time = share < 1.0 ? at.in.start.time + share * at.in.step : at.in.end_time;
  if (at.detector.needs_rotations()) rotate(at);
  at.detector.place(view.time, places_);
  if (to_end) at.detector.place(at.in.end_time, places_at_end_);
  found_.clear();
  at.detector.find_of(
      at.body, {view, at.trial.at_end, places_, to_end ? &places_at_end_ : nullptr, margin, lasting}, found_);
  return found_;
}

const ConstraintSet& FlightLook::find(const LocatedBody& at, double share,
                                      std::span<const ConstraintKey> wanted, bool to_end) {
  constexpr double caution = 4.0;  // what stands out from the body, and ground, move too
  double way = 0.0;
  for (Index i = 0; i < at.slot.v_size; ++i) {
    way += at.in.step * at.kind.length_scale(at.slot.slot, i) * std::abs(at.trial.end.v[at.slot.v + i]);
  }
  // Corners that meet do so as long as both of their contacts are closed.
  lasting_.start(at.in.step);
  for (const ConstraintKey& key : wanted) lasting_.add(key);
  lasting_.finish();
  find(at, share, caution * way, to_end, &lasting_);
  const auto is_found = [&](const ConstraintKey& key) {
    return std::any_of(found_.begin(), found_.end(),
                       [&](const Constraint& contact) { return contact.key == key; });
  };
  if (std::all_of(wanted.begin(), wanted.end(), is_found)) return found_;
  return find(at, share, std::numeric_limits<double>::infinity(), to_end, &lasting_);
}

void FlightLook::take(std::span<const ConstraintKey> wanted, ConstraintSet& out) const {
  out.clear();
  for (const ConstraintKey& key : wanted) {
    const auto found = std::find_if(found_.begin(), found_.end(),
                                    [&](const Constraint& contact) { return contact.key == key; });
    if (found != found_.end()) out.add(*found);
  }
}

}  // namespace carom
