// Problem: modes where friction in joints is bound by their forces. Forces of redundant contacts are not
// unique, and bounds follow from them: the decision needs those that the flow will find, or the flow undoes
// it at once.

#include <carom/integrators/event_driven/mode_decision.h>

#include <algorithm>
#include <cmath>

namespace carom {

namespace {

// An acceleration this small against those without contact is zero, and a force against those around it.
constexpr double no_acceleration = 1e-11, no_force = 1e-11;

}  // namespace

/// The contacts that stay closed, in their modes.
void ModeDecision::list_closed(std::span<const Candidate> candidates) {
  active_.clear();
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    const Candidate& candidate = candidates[taking_part_[c]];
    if (candidate.mode == ContactMode::open) continue;
    ActiveContact& closed = active_.emplace_back();
    closed.pair = candidate.pair;
    closed.place = candidate.place;
    closed.mode = candidate.mode;
    closed.frictionless = candidate.frictionless;
    closed.at = contacts_[c];
    closed.friction = contacts_[c].friction;
  }
}

/// Modes that the answer does not tell. Contacts without force that do not part stay closed where they can
/// carry some: of redundant contacts solvers load any.
void ModeDecision::complete_modes(SmoothMotion& motion, std::span<Candidate> candidates) {
  double size = 0.0;
  for (const double b : cluster_.problem().vector()) size = std::max(size, std::abs(b));
  std::vector<std::size_t> added;  // candidates
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    const Constraint& contact = contacts_[c];
    const std::size_t i = taking_part_[c];
    if (contact.has_dry_friction() && candidates[i].slip == 0.0 && !candidates[i].breaks) {
      // Friction in a joint that contacts keep from turning, at its bound or not, does not slip; where the
      // bound is zero modes cannot be told from the force.
      const double along = contact.tangential_acceleration(acceleration_.data());
      if (std::abs(along) <= no_acceleration * size) {
        candidates[i].mode = ContactMode::stick;
      } else if (slides_[i].sign == 0.0) {
        candidates[i].mode = along > 0.0 ? ContactMode::slip_positive : ContactMode::slip_negative;
      }
    }
    if (contact.has_dry_friction() || candidates[i].mode != ContactMode::open) continue;
    const int normal = cluster_.first_row(c);
    if (cluster_.problem().w(normal, normal) == 0.0) continue;  // joints hold it fast, nothing acts
    if (contact.normal_acceleration(acceleration_.data()) > no_acceleration * size) continue;
    const double along = contact.rows > 1 ? contact.tangential_acceleration(acceleration_.data()) : 0.0;
    double sign = slides_[i].sign;
    if (sign == 0.0 && std::abs(along) > no_acceleration * size) sign = along;
    candidates[i].mode = sign == 0.0  ? ContactMode::stick
                         : sign > 0.0 ? ContactMode::slip_positive
                                      : ContactMode::slip_negative;
    added.push_back(i);
  }
  if (added.empty()) return;
  list_closed(candidates);
  double change = 0.0;
  BoundIteration once;
  const bool found = motion.update_bounds(active_, margins_, once, change);
  double largest = 0.0;
  for (const ActiveContact& closed : active_) {
    if (!closed.at.has_dry_friction()) largest = std::max(largest, std::abs(closed.normal));
  }
  auto closed = active_.begin();  // in the order of the candidates, as those added
  for (const std::size_t i : added) {
    while (closed->place != candidates[i].place) ++closed;
    if (!found || !(closed->normal > no_force * largest)) candidates[i].mode = ContactMode::open;
  }
}

/// Modes by the problem at given bounds, and bounds by the forces that the flow has in these modes, in turns.
bool ModeDecision::settle_bounds(SmoothMotion& motion, std::span<Candidate> candidates,
                                 const double* acceleration, SolverChain& chain) {
  BoundIteration iteration;
  for (int turn = 0; turn < BoundIteration::most_repetitions; ++turn) {
    if (!cluster_.solve(chain).usable()) return false;
    acceleration_.assign(acceleration, acceleration + zero_.size());
    cluster_.map().add_velocities(acceleration_.data());
    read_modes(candidates, cluster_.impulses());
    complete_modes(motion, candidates);
    list_closed(candidates);
    double change = 0.0;
    iteration.begin();
    if (!motion.update_bounds(active_, margins_, iteration, change)) return false;
    const bool settled = iteration.settled(change);
    const bool guesses = !settled && iteration.accelerates();
    std::size_t bound = 0, at = 0;
    for (std::size_t c = 0; c < contacts_.size(); ++c) {
      if (candidates[taking_part_[c]].mode == ContactMode::open) continue;
      const ActiveContact& closed = active_[at++];
      if (!motion.depends_on_joint_force(contacts_[c])) continue;
      contacts_[c].friction_bound = guesses ? iteration.guess(bound++) : closed.at.friction_bound;
      cluster_.update_bound(c);
    }
    if (settled) return true;
  }
  return false;
}

}  // namespace carom
