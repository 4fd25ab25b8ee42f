// Problem: modes in which the flow moves as an answer does whose forces are not unique.

#include <carom/integrators/event_driven/mode_decision.h>
#include <carom/integrators/event_driven/modes_by_motion.h>
#include <carom/integrators/event_driven/rolling_modes.h>

#include <algorithm>
#include <cmath>

namespace carom {

/// Modes in which the flow moves as the answer does (modes_by_motion.h).
void ModeDecision::settle_modes(SmoothMotion& motion, MotionSample& now, std::span<Candidate> candidates) {
  const DecidedContacts decided{contacts_, taking_part_, acceleration_.data(),
                                SlipDirections::no_acceleration * size_};
  const auto take_forces = [&] { take_modes(by_forces_, candidates); };
  open_where_parting(decided, candidates);
  open_where_carried_off(decided, problem_, candidates);
  follow_contacts(slips_, candidates);
  by_forces_.clear();
  by_forces_.reserve(candidates.size());
  for (const Candidate& candidate : candidates) by_forces_.push_back(candidate.mode);
  stick_where_still(decided, candidates);
  complete_modes(motion, now, candidates);
  if (keeps_motion(motion, now, candidates)) return;
  take_forces();
  if (keeps_motion(motion, now, candidates)) return;
  fix_extreme_friction(decided, problem_, candidates);
  if (!keeps_motion(motion, now, candidates)) take_forces();
}

/// True if the forces that the flow has in the modes of the candidates move bodies as the answer does, as far
/// as its constraints can tell, and the law allows them: else an event ends these modes where they begin.
/// Forces that are not unique cancel each other where nothing slips.
bool ModeDecision::keeps_motion(SmoothMotion& motion, MotionSample& now,
                                std::span<const Candidate> candidates) {
  constexpr double same = 1e-8;  // of the accelerations without contact
  if (!forces_may_move(contacts_, taking_part_, candidates)) return true;
  list_closed(candidates);
  double change = 0.0;
  BoundIteration once;
  if (!motion.joints().update_friction_bounds(motion.active(), now, active_, margins_, once, change))
    return false;
  const bool is_unique = !motion.active().has_open_forces();
  const double apart = motion_apart(problem_, active_, motion.active(), comparison_);
  if (apart > (is_unique ? same : ActiveSet::left_by_dependent) * size_) return false;
  return is_unique || law_allows(active_, margins_);
}

/// True if a contact whose force has come to its end, and which the answer closes again, pulls in the modes
/// of the answer. There the contact has next to no lever (a box that stands against a wall turns about its
/// corner on the floor): the answer holds to rounding with any force on it, and none keeps it closed.
bool ModeDecision::pulls_again(SmoothMotion& motion, MotionSample& now,
                               std::span<const Candidate> candidates) {
  const auto returns = [](const Candidate& at) { return at.releases && at.mode != ContactMode::open; };
  if (std::none_of(candidates.begin(), candidates.end(), returns)) return false;
  list_closed(candidates);
  double change = 0.0, largest = 0.0;
  BoundIteration once;
  if (!motion.joints().update_friction_bounds(motion.active(), now, active_, margins_, once, change))
    return false;
  for (const ActiveContact& closed : active_) largest = std::max(largest, std::abs(closed.normal));
  return std::any_of(active_.begin(), active_.end(), [&](const ActiveContact& closed) {
    const auto same = [&](const Candidate& at) { return at.place == closed.place && at.releases; };
    return closed.normal < -clear_force * largest && std::any_of(candidates.begin(), candidates.end(), same);
  });
}

}  // namespace carom
