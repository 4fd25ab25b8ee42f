// Problem: modes of the contacts of an island from its accelerations.

#include <carom/integrators/event_driven/mode_decision.h>

#include <algorithm>
#include <cmath>

namespace carom {

namespace {

// An acceleration this small against those without contact is zero, and a force against those around it.
constexpr double no_acceleration = 1e-11, no_force = 1e-11;

// Contacts that start slipping or open change the problem of the others; more rounds than this do not end it.
constexpr int most_rounds = 20;

}  // namespace

Decision ModeDecision::decide(SmoothMotion& motion, MotionSample& now, std::span<Candidate> candidates,
                              SolverChain& chain) {
  slides_.assign(candidates.size(), {});
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const Candidate& candidate = candidates[i];
    if (candidate.frictionless) {
      slides_[i].sign = 1.0;
    } else if (candidate.slip != 0.0) {
      slides_[i].sign = std::copysign(1.0, candidate.slip);
    } else if (candidate.starts_slipping) {
      slides_[i].sign = -std::copysign(1.0, candidate.exhausted_friction);
    }
    slides_[i].open = candidate.releases;
  }
  zero_.resize(now.acceleration.size());  // never written
  acceleration_.resize(now.acceleration.size());
  Decision decision = Decision::failed;
  for (int round = 0; round < most_rounds; ++round) {
    decision = solve(motion, now, candidates, chain);
    if (decision == Decision::impossible || decision == Decision::failed) return decision;
    if (!revise(candidates)) return decision;
  }
  return decision;
}

/// Accelerations without contact, of the group.
void ModeDecision::take_accelerations(const SmoothMotion& motion, const MotionSample& now) {
  motion.model().unknowns.for_velocities([&](Range v, std::size_t) {
    std::copy(now.acceleration.begin() + v.begin, now.acceleration.begin() + v.end,
              acceleration_.begin() + v.begin);
  });
}

Decision ModeDecision::solve(SmoothMotion& motion, MotionSample& now, std::span<Candidate> candidates,
                             SolverChain& chain) {
  contacts_.clear();
  taking_part_.clear();
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    candidates[i].mode = ContactMode::open;
    if (slides_[i].open) continue;
    Constraint& contact = contacts_.emplace_back(candidates[i].at);
    taking_part_.push_back(i);
    // In accelerations minus the drift stands for the velocity of the shape on ground.
    for (std::size_t row = 0; row < Constraint::max_rows; ++row) {
      contact.surface_velocity[row] = contact.surface_velocity_after[row] = -contact.drift[row];
    }
    contact.law.normal_restitution = contact.law.tangential_restitution = 0.0;
    contact.friction = slides_[i].sign == 0.0 ? contact.law.sticking_friction()
                                              : contact.law.sliding_friction(std::abs(candidates[i].slip));
  }
  if (contacts_.empty()) {
    take_accelerations(motion, now);
    return Decision::made;
  }
  JointReactions& joints = motion.joints();
  joints.build(problem_, contacts_, zero_.data());
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    const double sign = slides_[taking_part_[c]].sign;
    if (sign != 0.0 && contacts_[c].type != ConstraintType::limit)
      problem_.slide(c, -sign * contacts_[c].friction);
  }
  problem_.set_free_velocity(now.acceleration.data());
  const bool bounds_follow = !joints.friction_bounds().empty() &&
                             std::any_of(contacts_.begin(), contacts_.end(), [&](const Constraint& contact) {
                               return joints.depends_on_joint_force(contact);
                             });
  const bool solved = bounds_follow ? converge_friction_bounds(motion, now, candidates, chain)
                                    : problem_.solve(chain).usable();
  const ContactReport& report = problem_.report();
  if (!solved || report.outcome == Outcome::no_solution) {
    name_cause(candidates);
    return report.outcome == Outcome::no_solution ? Decision::impossible : Decision::failed;
  }
  Decision decision = Decision::made;
  if (!bounds_follow) read_modes(candidates, problem_.impulses());
  if (report.outcome == Outcome::several_solutions) {
    name_cause(candidates);
    take_present(candidates);
    decision = Decision::several;
  }
  take_accelerations(motion, now);
  problem_.map().add_velocities(acceleration_.data());
  return decision;
}

void ModeDecision::read_modes(std::span<Candidate> candidates, std::span<const double> force) {
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    const std::size_t i = taking_part_[c];
    const ContactMode found = problem_.modes()[c];
    // Friction in a joint never opens.
    const bool has_dry_friction = contacts_[c].has_dry_friction();
    if (has_dry_friction && slides_[i].sign == 0.0) {
      candidates[i].mode = found == ContactMode::open ? ContactMode::stick : found;
      continue;
    }
    const double normal = has_dry_friction ? 1.0 : force[static_cast<std::size_t>(problem_.first_row(c))];
    if (slides_[i].sign != 0.0) {
      candidates[i].mode = !(normal > 0.0)         ? ContactMode::open
                           : slides_[i].sign > 0.0 ? ContactMode::slip_positive
                                                   : ContactMode::slip_negative;
    } else {
      candidates[i].mode = found;
    }
  }
}

/// Changes by the first answer: contacts that start slipping have their sliding friction; those that were
/// taken to open or slip and do not, since another one that slips took them along, are put back. True if the
/// problem is to be solved anew.
bool ModeDecision::revise(std::span<Candidate> candidates) {
  bool changed = false;
  double size = 0.0, farthest = 0.0;
  for (const double b : problem_.problem().vector()) size = std::max(size, std::abs(b));
  // Accelerations by friction that is exhausted to within its rounding only.
  double stiffest = 0.0, exhausted = 0.0;
  for (int row = 0; row < problem_.problem().rows(); ++row) {
    stiffest = std::max(stiffest, problem_.problem().w(row, row));
  }
  for (const Candidate& candidate : candidates) exhausted += candidate.noise * stiffest;
  Slide* astray = nullptr;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const Candidate& candidate = candidates[i];
    Slide& slide = slides_[i];
    const double opening = candidate.at.normal_acceleration(acceleration_.data());
    const double slides = candidate.at.tangential_acceleration(acceleration_.data());
    if (slide.open) {
      if (opening >= -no_acceleration * std::max(size, std::abs(opening))) continue;
      slide.open = false;
      changed = true;
    } else if (slide.sign == 0.0 && (candidate.mode == ContactMode::slip_positive ||
                                     candidate.mode == ContactMode::slip_negative)) {
      slide.sign = candidate.mode == ContactMode::slip_positive ? 1.0 : -1.0;
      changed = true;
    } else if (candidate.slip == 0.0 && !candidate.frictionless && !slide.reverted &&
               candidate.mode != ContactMode::open &&
               slide.sign * slides < -std::max(no_acceleration * size, exhausted)) {
      // One at a time: it may be what takes the others along.
      if (astray != nullptr && std::abs(slides) <= farthest) continue;
      astray = &slide;
      farthest = std::abs(slides);
    }
  }
  if (changed || astray == nullptr) return changed;
  astray->sign = 0.0;
  astray->reverted = true;
  return true;
}

void ModeDecision::name_cause(std::span<Candidate> candidates) {
  const ContactProblem& problem = problem_.problem();
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    const std::size_t i = taking_part_[c];
    if (contacts_[c].has_dry_friction()) continue;
    const int row = problem_.first_row(c);
    const double ratio = -slides_[i].sign * contacts_[c].friction;
    candidates[i].stiffness = problem.w(row, row);
    if (contacts_[c].rows > 1) candidates[i].stiffness += ratio * problem.w(row, row + 1);
    candidates[i].free_acceleration = problem.vector()[static_cast<std::size_t>(row)];
  }
}

/// Of several answers the one in the present modes; where there is none, the one with most contacts open.
bool ModeDecision::take_present(std::span<Candidate> candidates) {
  if (solutions_.enumerate(problem_.problem()) == Outcome::not_solved) return false;
  std::size_t best = solutions_.size();
  std::ptrdiff_t most = -1;
  for (std::size_t s = 0; s < solutions_.size(); ++s) {
    take(candidates, s);
    const bool same = std::all_of(candidates.begin(), candidates.end(),
                                  [](const Candidate& at) { return at.mode == at.present; });
    if (same) return true;
    const std::ptrdiff_t open = std::count_if(candidates.begin(), candidates.end(), [](const Candidate& at) {
      return at.mode == ContactMode::open;
    });
    if (open <= most) continue;
    most = open;
    best = s;
  }
  if (best < solutions_.size()) take(candidates, best);
  return false;
}

/// Answers by one of the solutions.
void ModeDecision::take(std::span<Candidate> candidates, std::size_t solution) {
  problem_.set_impulses(solutions_.impulse(solution));
  read_modes(candidates, problem_.impulses());
}

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

/// Modes that do not follow from the answer. Contacts without force that do not part stay closed where they
/// can carry some: of redundant contacts solvers load any.
void ModeDecision::complete_modes(SmoothMotion& motion, MotionSample& now, std::span<Candidate> candidates) {
  double size = 0.0;
  for (const double b : problem_.problem().vector()) size = std::max(size, std::abs(b));
  std::vector<std::size_t> added;  // candidates
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    const Constraint& contact = contacts_[c];
    const std::size_t i = taking_part_[c];
    if (contact.has_dry_friction() && candidates[i].slip == 0.0 && !candidates[i].starts_slipping) {
      // Friction in a joint that contacts keep from turning, at its bound or not, does not slip; where the
      // bound is zero the force does not determine the mode.
      const double along = contact.tangential_acceleration(acceleration_.data());
      if (std::abs(along) <= no_acceleration * size) {
        candidates[i].mode = ContactMode::stick;
      } else if (slides_[i].sign == 0.0) {
        candidates[i].mode = along > 0.0 ? ContactMode::slip_positive : ContactMode::slip_negative;
      }
    }
    if (contact.has_dry_friction() || candidates[i].mode != ContactMode::open) continue;
    const int normal = problem_.first_row(c);
    if (problem_.problem().w(normal, normal) == 0.0) continue;  // joints hold it fast, nothing acts
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
  const bool found =
      motion.joints().update_friction_bounds(motion.active(), now, active_, margins_, once, change);
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

/// Forces of redundant contacts are not unique, and bounds of friction in joints follow from them: the
/// decision needs those that the flow will find, or the flow undoes it at once. Modes by the problem at given
/// bounds, and bounds by the forces that the flow has in these modes, in turns.
bool ModeDecision::converge_friction_bounds(SmoothMotion& motion, MotionSample& now,
                                            std::span<Candidate> candidates, SolverChain& chain) {
  BoundIteration iteration;
  for (int turn = 0; turn < BoundIteration::most_repetitions; ++turn) {
    if (!problem_.solve(chain).usable()) return false;
    take_accelerations(motion, now);
    problem_.map().add_velocities(acceleration_.data());
    read_modes(candidates, problem_.impulses());
    complete_modes(motion, now, candidates);
    list_closed(candidates);
    double change = 0.0;
    iteration.begin();
    if (!motion.joints().update_friction_bounds(motion.active(), now, active_, margins_, iteration, change))
      return false;
    const bool converged = iteration.converged(change);
    const bool guesses = !converged && iteration.accelerates();
    std::size_t bound = 0, at = 0;
    for (std::size_t c = 0; c < contacts_.size(); ++c) {
      if (candidates[taking_part_[c]].mode == ContactMode::open) continue;
      const ActiveContact& closed = active_[at++];
      if (!motion.joints().depends_on_joint_force(contacts_[c])) continue;
      contacts_[c].friction_bound = guesses ? iteration.guess(bound++) : closed.at.friction_bound;
      problem_.update_bound(c);
    }
    if (converged) return true;
  }
  return false;
}

}  // namespace carom
