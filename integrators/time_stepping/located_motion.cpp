// Problem: a step of one body that is hit at instants within it.

#include <carom/contact/strike.h>
#include <carom/core/dynamics/body_response.h>
#include <carom/integrators/time_stepping/kept_names.h>
#include <carom/integrators/time_stepping/located_motion.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace carom {

namespace {

/// True if two lists are of the same contacts.
bool are_same(const ConstraintSet& a, const ConstraintSet& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const Constraint& one, const Constraint& other) { return one.key == other.key; });
}

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
  start_.assign(contacts);
  used_ = 0;
  hit_ = 2.0;
  failed_ = nullptr;
}

bool LocatedMotion::advance(const LocatedStep& step) {
  const BodySlot slot = step.in.assembly.layout()->bodies()[body_];
  LocatedBody at{step, body_, slot, *step.in.assembly.body_kinds()[slot.kind]};
  at.loads.at_impact = is_hit();  // in the iterate that the jumps are of
  used_ = 0;
  failed_ = nullptr;
  hit_ = 2.0;
  closed_.clear();
  parted_.clear();
  for (const Constraint& contact : start_) closed_.push_back(contact.key);
  const State& start = step.in.start;
  std::copy_n(start.q.begin() + slot.q, slot.q_size, step.trial.end.q.begin() + slot.q);
  std::copy_n(start.v.begin() + slot.v, slot.v_size, step.trial.end.v.begin() + slot.v);
  return move(at);
}

/// Flights and impacts in turn. A contact that rounding alone opens behind an answer without rebound closes
/// again at once: then it takes part in the flight. Such answers are bounded like impacts.
bool LocatedMotion::move(const LocatedBody& at) {
  int impacts = 0, captures = 0;
  double now = 0.0, captured = -1.0;
  bool given_up = false;  // contacts that would rebound act to the end of the step
  if (struck_) {
    if (!strike(at, now, true)) return false;
    ++impacts;
  }
  while (now < 1.0) {
    MotionPhase& flight = add_phase(at, now, 1.0);
    if (now == 0.0 && !struck_) {
      flight.constraints = start_;
    } else if (!closed_.empty()) {
      look_.find(at, now, closed_, true);
      look_.take(closed_, flight.constraints);
    }
    if (!fly(at, flight)) return false;
    const std::span<const FlightClosing> closing = closings_.find(at, flight, closed_, look_);
    if (closing.empty()) {
      flight.cut = given_up;
      FlightLook::rotate(at);
      return true;
    }
    write(flight.q, at.slot.q, at.slot.q_size, at.trial.end.q);
    write(flight.v0, at.slot.v, at.slot.v_size, at.trial.end.v);
    for (const FlightClosing& contact : closing) closed_.push_back(contact.key);
    const double hit = closing.front().share;
    parted_.clear();
    if (hit > now) {
      // It begins with contacts as they have turned on the longer way, which is nearly its own.
      for (ConstraintSet* const list : {&flight.constraints, &of_flight_.begin}) {
        for (Constraint& contact : *list) contact.shorten((hit - now) / (1.0 - now));
      }
      flight.end = hit;
      if (!fly_and_turn(at, flight)) return false;
      list_parted(flight);
    } else {
      --used_;
    }
    now = hit;
    const bool fast =
        std::any_of(closing.begin(), closing.end(), [](const FlightClosing& c) { return c.rebounds; });
    const bool rebounds = fast && impacts < at.rules.most_impacts;
    int& count = rebounds ? impacts : captures;
    if (count == at.rules.most_impacts || (!rebounds && now == captured)) {
      given_up = given_up || fast;
      continue;
    }
    if (!strike(at, now, rebounds)) return false;
    phases_[used_ - 1].cut = fast && !rebounds;
    ++count;
    if (!rebounds) captured = now;
  }
  FlightLook::rotate(at);
  return true;
}

/// A phase from where the body is, without contacts.
MotionPhase& LocatedMotion::add_phase(const LocatedBody& at, double begin, double end) {
  if (used_ == phases_.size())
    phases_.emplace_back().problem = IslandProblem({.plastic_jams = !at.rules.impacts.refuse_jams});
  MotionPhase& phase = phases_[used_++];
  phase.begin = begin;
  phase.end = end;
  phase.hit = hit_;
  phase.turning_work = 0.0;
  phase.cut = false;
  read(at.trial.end.q, at.slot.q, at.slot.q_size, phase.q);
  read(at.trial.end.v, at.slot.v, at.slot.v_size, phase.v0);
  phase.constraints.clear();
  return phase;
}

/// The body, at the begin of the flight, comes to its end. Where contacts turn on the way their impulses act
/// along the directions halfway, and the law holds along those at both ends: as joints are held.
bool LocatedMotion::fly(const LocatedBody& at, MotionPhase& flight) {
  of_flight_.begin = flight.constraints;
  return fly_and_turn(at, flight);
}

/// The body, at the begin of the flight, comes to its end, with contacts that may have turned already. At the
/// begin of the flight they are as `of_flight_.begin` has them.
bool LocatedMotion::fly_and_turn(const LocatedBody& at, MotionPhase& flight) {
  constexpr int most_tries = 20;
  constexpr double rounding = 1e-15;
  flight.turning_work = 0.0;
  if (!fly_once(at, flight)) return fly_along_begin(at, flight);
  const double time = (flight.end - flight.begin) * at.in.step;
  if (std::none_of(of_flight_.begin.begin(), of_flight_.begin.end(),
                   [&](const Constraint& contact) { return contact.turns(time, at.rules.turning); })) {
    return true;
  }
  double last = std::numeric_limits<double>::infinity();
  bool any_turned = false;
  for (int tries = 0; tries < most_tries; ++tries) {
    const std::array<double, 6> before = flight.v1;
    const bool turned = turn(at, flight);
    write(flight.v0, at.slot.v, at.slot.v_size, at.trial.end.v);
    if (!fly_once(at, flight) || flight.problem.restitution_factor() == 0.0) {
      return fly_along_begin(at, flight);
    }
    if (!turned) break;
    any_turned = true;
    double change = 0.0, size = 0.0;
    for (Index i = 0; i < at.slot.v_size; ++i) {
      const double length = at.kind.length_scale(at.slot.slot, i);
      change = std::max(change, length * std::abs(flight.v1[i] - before[i]));
      size = std::max(size, length * std::abs(flight.v1[i]));
    }
    if (change <= rounding * size || !(change < last)) break;
    last = change;
  }
  if (any_turned && gains(at, flight)) return fly_along_begin(at, flight);
  if (any_turned) book_turning(flight);
  return true;
}

/// True if contacts with ground at rest give the body energy, by more than errors of a step that follows the
/// motion: it turns too far in this one for its directions halfway to say anything.
bool LocatedMotion::gains(const LocatedBody& at, const MotionPhase& flight) const {
  constexpr double too_much = 1e-2;  // of the energies
  for (const Constraint& contact : of_flight_.begin) {
    if (contact.surface_velocity != std::array<double, 3>{} ||
        contact.surface_velocity_after != std::array<double, 3>{})
      return false;
  }
  const Range own{at.slot.slot, at.slot.slot + 1};
  const double before = at.kind.kinetic_energy(own, flight.v0.data());
  const double after = at.kind.kinetic_energy(own, flight.v1.data());
  double work = 0.0;
  flight.add_work(at.loads, velocities(at.in), at.in.step, work);
  return after - before - work > too_much * (before + after + std::abs(work));
}

/// Contacts of a flight that have not pushed: they are open at its end, or were never pressed.
void LocatedMotion::list_parted(const MotionPhase& flight) {
  for (std::size_t c = 0; c < flight.constraints.size(); ++c) {
    if (flight.problem.modes()[c] == ContactMode::open) parted_.push_back(flight.constraints[c].key);
  }
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

/// Contacts between which a body jams may press it, as they turn, by what is an error of the step: then no
/// impulses hold along the directions halfway. Along those at the begin some always do, on ground at rest.
bool LocatedMotion::fly_along_begin(const LocatedBody& at, MotionPhase& flight) {
  failed_ = nullptr;
  flight.constraints = of_flight_.begin;
  write(flight.v0, at.slot.v, at.slot.v_size, at.trial.end.v);
  return fly_once(at, flight);
}

bool LocatedMotion::fly_once(const LocatedBody& at, MotionPhase& flight) {
  if (!flight.constraints.empty() && !solve(at, flight)) return false;
  FlightLook::go(at, flight, flight.end);
  read(at.trial.end.v, at.slot.v, at.slot.v_size, flight.v1);
  return true;
}

/// Lists what the contacts of a flight have become on its way, as far as they are found.
void LocatedMotion::take_turned(std::span<const Constraint> found, double same_place,
                                ConstraintSet& out) const {
  out.clear();
  for (const Constraint& begin : of_flight_.begin) {
    const auto named = std::find_if(found.begin(), found.end(),
                                    [&](const Constraint& contact) { return contact.key == begin.key; });
    if (named == found.end()) continue;
    const Constraint* const now = become_of(begin, *named, found, same_place);
    if (now == nullptr) continue;
    out.add(*now).key = begin.key;
  }
}

/// Brings the contacts of a flight to the directions halfway. What these make of the velocities at both ends,
/// beyond what the directions there make of them, is taken for a motion of the ground. False, and nothing is
/// changed, if the body leaves the face of one on the way.
bool LocatedMotion::turn(const LocatedBody& at, MotionPhase& flight) {
  const double* const v = at.trial.end.v.data();
  turned_.clear();
  for (const Constraint& contact : flight.constraints) turned_.push_back(contact.key);
  const auto find = [&](double share, ConstraintSet& out) {
    FlightLook::go(at, flight, share);
    take_turned(look_.find(at, share, turned_, false), at.detector.outlines().on_ground().lengths().corner,
                out);
  };
  find(0.5 * (flight.begin + flight.end), of_flight_.next_middle);
  find(flight.end, of_flight_.next_end);
  if (!are_same(flight.constraints, of_flight_.next_middle) ||
      !are_same(flight.constraints, of_flight_.next_end)) {
    return false;
  }
  std::swap(of_flight_.middle, of_flight_.next_middle);
  std::swap(of_flight_.end, of_flight_.next_end);
  const std::size_t count = flight.constraints.size();
  for (std::size_t c = 0; c < count; ++c) {
    flight.constraints[c].take_rows(of_flight_.middle[c]);
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
  return true;
}

/// Impulses of the contacts of a phase, as changes of velocity in StepTrial::dv_impulses. The loads of a
/// flight act in its problem.
bool LocatedMotion::solve(const LocatedBody& at, MotionPhase& phase) {
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

/// The body is hit by all that is closed. What leaves takes no part in the flight that follows. Where nothing
/// closes fast, nothing rebounds: so bounces that accumulate come to an end.
bool LocatedMotion::strike(const LocatedBody& at, double share, bool fast) {
  constexpr double rounding = 1e-12;  // of the velocities along a normal
  if (hit_ > 1.0) hit_ = share;
  MotionPhase& hit = add_phase(at, share, share);
  look_.find(at, share, closed_, false);
  look_.take(closed_, hit.constraints);
  hit.constraints.remove_if([&](const Constraint& contact) {
    return contact.gap > at.rules.gap &&
           std::find(parted_.begin(), parted_.end(), contact.key) != parted_.end();
  });
  const StrikeInput impact{.rules = at.rules.impacts, .velocity = at.trial.end.v.data(), .plastic = !fast};
  const auto by = [&](ImpactLaw) { return StrikeAnswer{hit.problem, solve(at, hit)}; };
  if (carom::strike(hit.constraints, impact, by).outcome != Struck::Outcome::solved) return false;
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
