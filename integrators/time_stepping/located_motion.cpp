// Problem: a step of one body that is hit at instants within it.

#include <carom/core/dynamics/body_response.h>
#include <carom/integrators/time_stepping/located_motion.h>
#include <carom/integrators/time_stepping/step_kernels.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace carom {

namespace {

template <std::size_t N>
void read(const std::vector<double>& from, Index first, Index count, std::array<double, N>& out) {
  std::copy_n(from.begin() + first, count, out.begin());
}

template <std::size_t N>
void write(const std::array<double, N>& from, Index first, Index count, std::vector<double>& out) {
  std::copy_n(from.begin(), count, out.begin() + first);
}

}  // namespace

void LocatedMotion::begin(Index body, std::span<const Constraint> contacts, bool struck) {
  body_ = body;
  struck_ = struck;
  start_.assign(contacts.begin(), contacts.end());
  used_ = 0;
  hit_ = 2.0;
  failed_ = nullptr;
}

bool LocatedMotion::advance(const LocatedStep& step) {
  const BodySlot slot = step.in.assembly.layout()->bodies()[body_];
  At at{step, slot, *step.in.assembly.body_kinds()[slot.kind]};
  at.loads.at_impact = is_hit();  // in the iterate that the jumps are of
  used_ = 0;
  failed_ = nullptr;
  hit_ = 2.0;
  closed_.clear();
  for (const Constraint& contact : start_) closed_.push_back(contact.key);
  const State& start = step.in.start;
  std::copy_n(start.q.begin() + slot.q, slot.q_size, step.trial.end.q.begin() + slot.q);
  std::copy_n(start.v.begin() + slot.v, slot.v_size, step.trial.end.v.begin() + slot.v);
  return move(at);
}

/// Flights and impacts in turn. A contact that rounding alone opens behind an answer without rebound closes
/// again at once: then it takes part in the flight. Such answers are bounded like impacts.
bool LocatedMotion::move(const At& at) {
  int impacts = 0, captures = 0;
  double now = 0.0, captured = -1.0;
  if (struck_) {
    if (!strike(at, now, true)) return false;
    ++impacts;
  }
  while (now < 1.0) {
    MotionPhase& flight = add_phase(at, now, 1.0);
    if (now == 0.0 && !struck_) {
      flight.constraints = start_;
    } else if (!closed_.empty()) {
      observe(at, now, std::numeric_limits<double>::infinity(), true);
      take_closed(flight.constraints);
    }
    if (!fly(at, flight)) return false;
    if (!find_closing(at, flight)) {
      rotate(at);
      return true;
    }
    write(flight.q, at.slot.q, at.slot.q_size, at.trial.end.q);
    write(flight.v0, at.slot.v, at.slot.v_size, at.trial.end.v);
    const double hit = closing_.front().share;
    if (hit > now) {
      for (Constraint& contact : flight.constraints) contact.shorten((hit - now) / (1.0 - now));
      flight.end = hit;
      if (!fly(at, flight)) return false;
    } else {
      --used_;
    }
    now = hit;
    const bool fast = std::any_of(closing_.begin(), closing_.end(), [](const Closing& c) { return c.fast; });
    int& count = fast ? impacts : captures;
    if (count == at.most_impacts || (!fast && now == captured)) continue;
    if (!strike(at, now, fast)) return false;
    ++count;
    if (!fast) captured = now;
  }
  rotate(at);
  return true;
}

/// A phase from where the body is, without contacts.
MotionPhase& LocatedMotion::add_phase(const At& at, double begin, double end) {
  if (used_ == phases_.size())
    phases_.emplace_back().problem = IslandProblem({.plastic_jams = !at.refuse_jams});
  MotionPhase& phase = phases_[used_++];
  phase.begin = begin;
  phase.end = end;
  phase.hit = hit_;
  phase.turning_work = 0.0;
  read(at.trial.end.q, at.slot.q, at.slot.q_size, phase.q);
  read(at.trial.end.v, at.slot.v, at.slot.v_size, phase.v0);
  phase.constraints.clear();
  return phase;
}

/// The body, at the begin of the flight, comes to its end. Where contacts turn on the way their impulses act
/// along the directions halfway, and the law holds along those at both ends: as joints are held.
bool LocatedMotion::fly(const At& at, MotionPhase& flight) {
  constexpr int most_tries = 20;
  constexpr double rounding = 1e-15;
  of_flight_.begin = flight.constraints;
  flight.turning_work = 0.0;
  if (!fly_once(at, flight)) return false;
  if (std::none_of(of_flight_.begin.begin(), of_flight_.begin.end(),
                   [](const Constraint& contact) { return contact.turns(); })) {
    return true;
  }
  double last = std::numeric_limits<double>::infinity();
  for (int tries = 0; tries < most_tries; ++tries) {
    const std::array<double, 6> before = flight.v1;
    turn(at, flight);
    write(flight.v0, at.slot.v, at.slot.v_size, at.trial.end.v);
    if (!fly_once(at, flight)) return false;
    double change = 0.0, size = 0.0;
    for (Index i = 0; i < at.slot.v_size; ++i) {
      const double length = at.kind.length_scale(at.slot.slot, i);
      change = std::max(change, length * std::abs(flight.v1[i] - before[i]));
      size = std::max(size, length * std::abs(flight.v1[i]));
    }
    if (change <= rounding * size || !(change < last)) break;
    last = change;
  }
  book_turning(flight);
  return true;
}

/// Work on the motion of the ground that turn() made up.
void LocatedMotion::book_turning(MotionPhase& flight) const {
  for (std::size_t c = 0; c < flight.constraints.size(); ++c) {
    const Constraint &taken = flight.constraints[c], &begin = of_flight_.begin[c], &end = of_flight_.end[c];
    for (int i = 0; i < begin.rows; ++i) {
      const auto row = static_cast<std::size_t>(i);
      const double made_up = taken.surface_velocity[row] - begin.surface_velocity[row] +
                             taken.surface_velocity_after[row] - end.surface_velocity[row];
      flight.turning_work += 0.5 * flight.problem.map().impulse(c, i) * made_up;
    }
  }
}

bool LocatedMotion::fly_once(const At& at, MotionPhase& flight) {
  if (!flight.constraints.empty() && !solve(at, flight)) return false;
  sweep(at, flight, flight.end);
  read(at.trial.end.v, at.slot.v, at.slot.v_size, flight.v1);
  return true;
}

/// Brings the contacts of a flight to the directions halfway. What these make of the velocities at both ends,
/// beyond what the directions there make of them, is taken for a motion of the ground.
void LocatedMotion::turn(const At& at, MotionPhase& flight) {
  const double* const v = at.trial.end.v.data();
  const auto find = [&](double share, std::vector<Constraint>& out) {
    sweep(at, flight, share);
    observe(at, share, std::numeric_limits<double>::infinity(), false);
    out.clear();
    take_closed(out);
  };
  find(0.5 * (flight.begin + flight.end), of_flight_.middle);
  find(flight.end, of_flight_.end);
  const std::size_t count = flight.constraints.size();
  if (of_flight_.middle.size() != count || of_flight_.end.size() != count) return;  // a shape without an end
  for (std::size_t c = 0; c < count; ++c) {
    flight.constraints[c].jacobian = of_flight_.middle[c].jacobian;
    for (int i = 0; i < of_flight_.begin[c].rows; ++i) {
      const auto row = static_cast<std::size_t>(i);
      flight.constraints[c].surface_velocity_after[row] =
          of_flight_.middle[c].times(i, v) - of_flight_.end[c].velocity(i, v);
    }
  }
  write(flight.v0, at.slot.v, at.slot.v_size, at.trial.end.v);
  for (std::size_t c = 0; c < count; ++c) {
    for (int i = 0; i < of_flight_.begin[c].rows; ++i) {
      const auto row = static_cast<std::size_t>(i);
      flight.constraints[c].surface_velocity[row] =
          of_flight_.middle[c].times(i, v) - of_flight_.begin[c].velocity(i, v);
    }
  }
}

/// Impulses of the contacts of a phase, as changes of velocity in StepTrial::dv_impulses. The loads of a
/// flight act in its problem.
bool LocatedMotion::solve(const At& at, MotionPhase& phase) {
  const double half = 0.5 * (phase.end - phase.begin) * at.in.step;
  double *const dv = at.trial.dv_impulses.data(), *const free = at.trial.free.data();
  const double* const before = at.trial.end.v.data();
  const Index end = at.slot.v + at.slot.v_size;
  for (Index i = at.slot.v; i < end; ++i) {
    dv[i] = half * (at.loads.at(i, phase.begin, phase.hit) + at.loads.at(i, phase.end, phase.hit));
  }
  at.kind.apply_inverse_mass({at.slot.slot, at.slot.slot + 1}, dv + at.slot.v, free + at.slot.v);
  for (Index i = at.slot.v; i < end; ++i) {
    free[i] += before[i];
    dv[i] = 0.0;
  }
  MassResponse masses(at.in.assembly);
  phase.problem.build(phase.constraints, before);
  phase.problem.respond(masses);
  phase.problem.set_free_velocity(free);
  if (!phase.problem.solve(chain_).usable()) {
    failed_ = &phase.problem;
    return false;
  }
  phase.problem.map().add_velocities(dv);
  return true;
}

/// Where a flight is at a share of the step: impulses of its contacts act evenly.
void LocatedMotion::sweep(const At& at, const MotionPhase& flight, double share) const {
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

/// Brings its rotation to its coordinates.
void LocatedMotion::rotate(const At& at) {
  if (at.slot.rotation == none) return;
  at.kind.rotations({at.slot.slot, at.slot.slot + 1}, at.trial.end.q.data() + at.slot.q,
                    at.trial.at_end.rotation.data() + at.slot.rotation);
}

/// Contacts of the body where it is. \param to_end time passes up to the end of the step; else none
void LocatedMotion::observe(const At& at, double share, double margin, bool to_end) {
  StateView view = at.trial.end.view();
  view.time = share < 1.0 ? at.in.start.time + share * at.in.step : at.in.end_time;
  rotate(at);
  at.detector.place(view.time, places_);
  if (to_end) at.detector.place(at.in.end_time, places_at_end_);
  found_.clear();
  at.detector.find_of(body_, {view, at.trial.at_end, places_, to_end ? &places_at_end_ : nullptr, margin},
                      found_);
}

/// Those of the contacts that were observed which take part in what comes next.
void LocatedMotion::take_closed(std::vector<Constraint>& out) const {
  for (const Constraint& contact : found_) {
    if (std::find(closed_.begin(), closed_.end(), contact.key) != closed_.end()) out.push_back(contact);
  }
}

/// Finds what closes in a flight at whose end the body is, and adds the first to the contacts that take part.
bool LocatedMotion::find_closing(const At& at, const MotionPhase& flight) {
  constexpr double together = 1e-8;  // shares that differ by less are one instant
  observe(at, flight.end, 0.0, false);
  closing_.clear();
  for (const Constraint& contact : found_) {
    if (std::find(closed_.begin(), closed_.end(), contact.key) != closed_.end()) continue;
    const double rate = contact.normal_velocity(at.trial.end.v.data());
    if (contact.gap < 0.0 || rate < 0.0)
      closing_.push_back({contact.key, contact.gap, rate, flight.end, false});
  }
  if (closing_.empty()) return false;
  for (Closing& closing : closing_) locate(at, flight, closing);
  const auto earlier = [](const Closing& a, const Closing& b) {
    return a.share < b.share || (a.share == b.share && a.key < b.key);
  };
  std::sort(closing_.begin(), closing_.end(), earlier);
  const double last = closing_.front().share + together;
  std::erase_if(closing_, [&](const Closing& closing) { return closing.share > last; });
  for (const Closing& closing : closing_) closed_.push_back(closing.key);
  return true;
}

/// When a gap closes that is not open any more at the end of a flight: by Newton's method, kept between a
/// time at which the gap is open and one at which it is not.
void LocatedMotion::locate(const At& at, const MotionPhase& flight, Closing& closing) {
  constexpr int most_tries = 100;
  constexpr double close = 1e-15;  // of the step
  double open = flight.begin, closed = flight.end, share = flight.end;
  double gap = closing.gap, rate = closing.rate;
  for (int tries = 0; tries < most_tries && gap != 0.0; ++tries) {
    double next = share - gap / (rate * at.in.step);
    if (!(next > open && next < closed)) next = 0.5 * (open + closed);
    const bool done = std::abs(next - share) <= close || !(next > open && next < closed);
    if (done) break;
    share = next;
    sweep(at, flight, share);
    observe(at, share, std::numeric_limits<double>::infinity(), false);
    const auto is_it = [&](const Constraint& contact) { return contact.key == closing.key; };
    const auto contact = std::find_if(found_.begin(), found_.end(), is_it);
    if (contact == found_.end()) break;
    gap = contact->gap;
    rate = contact->normal_velocity(at.trial.end.v.data());
    (gap < 0.0 ? closed : open) = share;
  }
  closing.share = share;
  closing.fast = rate < -at.capture_speed;
}

/// The body is hit by all that is closed. What leaves takes no part in the flight that follows. Where nothing
/// closes fast, nothing rebounds: so bounces that accumulate come to an end.
bool LocatedMotion::strike(const At& at, double share, bool fast) {
  constexpr double rounding = 1e-12;  // of the velocities along a normal
  if (hit_ > 1.0) hit_ = share;
  MotionPhase& hit = add_phase(at, share, share);
  observe(at, share, std::numeric_limits<double>::infinity(), false);
  take_closed(hit.constraints);
  if (!fast) {
    for (Constraint& contact : hit.constraints) {
      contact.law.normal_restitution = contact.law.tangential_restitution = 0.0;
    }
  }
  if (!solve(at, hit)) return false;
  const Range v{at.slot.v, at.slot.v + at.slot.v_size};
  for (Index i = v.begin; i < v.end; ++i) {
    hit.v1[i - v.begin] = at.trial.end.v[i] + at.trial.dv_impulses[i];
    at.trial.rounding[i] = 0.0F;
  }
  const double* const now = at.trial.end.v.data();
  closed_.clear();
  for (const Constraint& contact : hit.constraints) {
    write(hit.v0, v.begin, v.size(), at.trial.end.v);
    const double before = contact.speed(0, now);
    write(hit.v1, v.begin, v.size(), at.trial.end.v);
    const double size = std::max(before, contact.speed(0, now));
    if (contact.velocity(0, now) <= rounding * size) closed_.push_back(contact.key);
  }
  write(hit.v1, v.begin, v.size(), at.trial.end.v);
  return true;
}

}  // namespace carom
