// Problem: which of the closed contacts that an impact shakes come to rest again at once?

#include <carom/integrators/event_driven/impact_settling.h>

#include <algorithm>
#include <cmath>

namespace carom {

bool ImpactSettling::settle(std::span<const Index> pairs, EventInstant& at, SolverChain& chain) {
  capture_ = capture_speed(pairs, at);
  if (!list_touching(pairs, at)) return false;
  const double pull = largest_acceleration(touching_, at);
  if (!(pull > 0.0)) return false;
  // What parts at the capture speed has come back by then.
  const double time = 2.0 * capture_ / pull;
  return solve_ahead(time, touching_, at, ahead_, problem_, chain) && list_held(at) &&
         closing_.close(held_, pairs, at);
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
    if (contact.has_dry_friction() && !at.motion.joints().depends_on_joint_force(contact)) continue;
    pile = pile || contact.bodies > 1;
    Constraint& listed = touching_.emplace_back(contact);
    places_.push_back(i);
    listed.remove_restitution();
    listed.friction_bound = 0.0;
    const double sliding = contact.sliding_speed(at.velocities());
    listed.friction =
        sliding <= capture_ ? contact.law.sticking_friction() : contact.law.friction_at(sliding);
    any = any || (at.before_at[i] != none && -at.approach(i) > noise);
    any = any || (contact.rows > 1 && sliding > noise && sliding <= capture_);
  }
  return any && pile;
}

/// True if sliding stops until then, or turns back: it passes through zero, from where the accelerations
/// decide.
bool ImpactSettling::comes_to_rest(std::size_t c, const EventInstant& at) const {
  const double slip = touching_[c].tangential_velocity(at.velocities());
  const ContactMode turned = slip > 0.0 ? ContactMode::slip_negative : ContactMode::slip_positive;
  const ContactMode mode = problem_.modes()[c];
  return mode == ContactMode::stick || mode == turned;
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
    if (contact.has_dry_friction() || bounces) continue;
    if (!(problem_.map().impulse(c, 0) > 0.0)) continue;
    const double sliding = contact.rows > 1 ? contact.sliding_speed(at.velocities()) : 0.0;
    // A contact at rest is not to start by what stops others: accelerations decide about that.
    const bool sticks = contact.rows > 1 && sliding <= capture_ && (sliding <= noise || comes_to_rest(c, at));
    any = any || -at.approach(place) > noise || (sticks && sliding > noise);
    ActiveContact& held = held_.emplace_back();
    held.mode = sticks ? ContactMode::stick : ContactMode::slip_positive;
    held.at = at.contacts[place];
    held.place = place;
  }
  return any;
}

}  // namespace carom
