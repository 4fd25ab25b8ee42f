// Problem: which of the closed contacts that an impact shakes come to rest again at once?

#include <carom/integrators/event_driven/impact_settling.h>

#include <algorithm>
#include <cmath>

namespace carom {

bool ImpactSettling::settle(std::span<const Index> pairs, EventInstant& at, SolverChain& chain,
                            SettlingLimit& limit) {
  capture_ = capture_speed(pairs, at);
  if (!list_touching(pairs, at)) return false;
  const double pull = largest_acceleration(touching_, at);
  if (!(pull > 0.0)) return false;
  // A contact that parts at the capture speed has come back by then.
  const double time = 2.0 * capture_ / pull;
  if (!limit.allows(at.time, time)) return false;
  for (Constraint& contact : touching_) contact.of_joint.friction_bound *= time;  // of friction in a joint
  if (!solve_ahead(time, touching_, at, ahead_, problem_, chain) || !close(pairs, at)) return false;
  limit.count(at.time, time);
  // Sliding that is left is slower than constraints can tell: it counts as stopped.
  for (const ActiveContact& held : held_) {
    if (held.sticks()) at.stopped.push_back(held.place);
  }
  return true;
}

/// Closes what is held. Where to stop all that slides slowly is to stop a mechanism that moves on (a heap of
/// dominoes that another one pushes), a part of it, slower by far, is not what guides that: else each contact
/// would come to rest by an event of its own, and what lifts meanwhile would fall again, and so on.
bool ImpactSettling::close(std::span<const Index> pairs, EventInstant& at) {
  constexpr int most_levels = 5;  // each costs projections; down to 1/256 of the capture speed
  constexpr double slower = 0.25;
  slow_ = capture_;
  for (int level = 0; level < most_levels && list_held(at); ++level, slow_ *= slower) {
    if (closing_.close(held_, pairs, at)) return true;
  }
  return false;
}

/// Lists what touches and does not fly off. False if nothing is left to settle, or no bodies touch each
/// other: few contacts of one body are followed as they are, singular positions among them.
bool ImpactSettling::list_touching(std::span<const Index> pairs, const EventInstant& at) {
  const double noise = at.scales.speed_noise;
  touching_.clear();
  places_.clear();
  bool any = false, pile = false;
  for (const Index i : pairs) {
    if (!at.touches(i) || -at.approach(i) > capture_) continue;
    const Constraint& contact = at.contacts[i];
    if (contact.attached) continue;
    pile = pile || contact.bodies > 1;
    Constraint& listed = touching_.add(contact);
    places_.push_back(i);
    listed.remove_restitution();
    const double sliding = contact.sliding_speed(at.velocities());
    listed.friction =
        sliding <= capture_ ? contact.law.sticking_friction() : contact.law.friction_at(sliding);
    any = any || (at.before_at[i] != none && -at.approach(i) > noise);
    any = any || (sliding > noise && sliding <= capture_);
  }
  return any && pile;
}

/// True if sliding stops until then, or turns back: it passes through zero, from where the accelerations
/// decide.
bool ImpactSettling::comes_to_rest(std::size_t c, const EventInstant& at) const {
  const double slip = touching_[c].tangential_velocity(at.velocities());
  const ContactMode turned = slip > 0.0 ? ContactMode::slip_negative : ContactMode::slip_positive;
  const ContactMode mode = problem_.modes()[c];
  const bool rests = mode == ContactMode::stick || mode == turned;
  return rests || (touching_[c].normals == 0 && mode == ContactMode::open);
}

/// Lists the contacts that are pressed then. False if they need not be stopped.
bool ImpactSettling::list_held(const EventInstant& at) {
  const double noise = at.scales.speed_noise;
  held_.clear();
  bool any = false;
  for (std::size_t c = 0; c < touching_.size(); ++c) {
    const Constraint& contact = touching_[c];
    const Index place = places_[c];
    // A contact that was open before bounces as ever.
    const bool bounces = at.before_at[place] == none && -at.approach(place) > noise;
    const bool in_joint = contact.has_given_bound();
    if (!in_joint && bounces) continue;
    if (!in_joint && !(problem_.map().impulse(c, 0) > 0.0)) continue;
    const double sliding = contact.sliding_speed(at.velocities());
    // A contact at rest is not to start by what stops others: accelerations decide about that.
    const bool sticks =
        contact.tangents() > 0 && sliding <= slow_ && (sliding <= noise || comes_to_rest(c, at));
    if (in_joint && !sticks) continue;
    any = any || -at.approach(place) > noise || (sticks && sliding > noise);
    ActiveContact& held = held_.emplace_back();
    held.mode = sticks ? ContactMode::stick : ContactMode::slip_positive;
    held.at = at.contacts[place];
    held.place = place;
  }
  return any;
}

}  // namespace carom
