// Problem: forces where solvers find none, as the limit of impulses in a vanishing time.

#include <carom/integrators/event_driven/mode_decision.h>
#include <carom/integrators/event_driven/rolling_modes.h>

#include <algorithm>
#include <cmath>

namespace carom {

/// The limit of impacts of vanishing time eps, b = gamma + eps a and e = 0, divided by eps: its matrix is
/// copositive, so that it has an answer where the problem of accelerations has none that solvers find. What
/// slips has a velocity gamma/eps without bound; if impulses stop it, there are no forces.
Decision ModeDecision::solve_as_limit(SmoothMotion& motion, MotionSample& now,
                                      std::span<Candidate> candidates, SolverChain& chain) {
  constexpr double unbounded = 1e6;  // against the accelerations without contact
  list_contacts(candidates);
  if (contacts_.empty() || bounds_follow(motion)) return Decision::failed;
  size_ = 0.0;
  for (const Constraint& contact : contacts_) {
    for (int row = 0; row < contact.rows; ++row)
      size_ = std::max(size_, std::abs(contact.acceleration(row, now.acceleration.data())));
  }
  const double fast = unbounded * size_;
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    const TangentDirection& slip = slips_[taking_part_[c]].direction;
    if (contacts_[c].friction == 0.0) continue;
    for_tangents(contacts_[c], [&](std::size_t k, int row) {
      contacts_[c].surface_velocity_after[static_cast<std::size_t>(row)] -= slip[k] * fast;
    });
  }
  motion.joints().build(problem_, contacts_, zero_.data());
  problem_.set_free_velocity(now.acceleration.data());
  const bool solved = problem_.solve(chain).usable();
  name_cause(problem_, taking_part_, slips_, candidates);
  if (!solved) return Decision::failed;
  take_accelerations(motion, now);
  problem_.map().add_velocities(acceleration_.data());
  bool stops = false, reverts = false;
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    SlipDirection& slide = slips_[taking_part_[c]];
    const Candidate& candidate = candidates[taking_part_[c]];
    if (slide.direction.is_zero() || contacts_[c].friction == 0.0) continue;
    if (acceleration_along(candidate.at, slide.direction, acceleration_.data()) > -0.5 * fast) continue;
    (candidate.slip != 0.0 ? stops : reverts) = true;
    if (candidate.slip == 0.0) slide = {.reverted = true};  // it has no velocity that impulses could stop
  }
  if (reverts) return solve_as_limit(motion, now, candidates, chain);
  if (stops) return Decision::impossible;
  read_modes(candidates, problem_.impulses());
  settle_modes(motion, now, candidates);
  return Decision::made;
}

/// The answer may be one of several: it is checked, not looked for. In the forces of a limit nothing has
/// begun to slip that has no velocity yet.
Decision ModeDecision::decide_by(std::span<const ForceOnCandidate> forces, SmoothMotion& motion,
                                 MotionSample& now, std::span<Candidate> candidates) {
  constexpr int most_improvements = 3;
  slips_.start(candidates);
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (candidates[i].slip == 0.0 && !candidates[i].frictionless) slips_[i] = {.reverted = true};
    slips_[i].open = false;
  }
  list_contacts(candidates);
  if (contacts_.empty() || bounds_follow(motion)) return Decision::failed;
  build(motion, now);
  given_.assign(static_cast<std::size_t>(problem_.problem().rows()), 0.0);
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    const ForceOnCandidate& force = forces[taking_part_[c]];
    std::copy_n(force.begin(), contacts_[c].rows, given_.begin() + problem_.first_row(c));
  }
  if (!(polish_.improve(problem_.problem(), given_, most_improvements).value <= tolerated_residual))
    return Decision::failed;
  problem_.set_impulses(given_);
  size_ = std::max(size_, size_by_rounding(problem_));
  read_modes(candidates, problem_.impulses());
  take_accelerations(motion, now);
  problem_.map().add_velocities(acceleration_.data());
  settle_modes(motion, now, candidates);
  return Decision::made;
}

}  // namespace carom
