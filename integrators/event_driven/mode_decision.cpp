// Problem: modes of the contacts of an island from its accelerations.

#include <carom/integrators/event_driven/mode_decision.h>
#include <carom/integrators/event_driven/modes_by_motion.h>
#include <carom/integrators/event_driven/rolling_modes.h>

#include <algorithm>
#include <cmath>

namespace carom {

namespace {

constexpr double no_force = 1e-11;  // against those around it
// Contacts that start slipping or open change the problem of the others; more rounds than this do not end it.
constexpr int most_rounds = 20;

}  // namespace

Decision ModeDecision::decide(SmoothMotion& motion, MotionSample& now, std::span<Candidate> candidates,
                              SolverChain& chain) {
  slips_.start(candidates);
  zero_.resize(now.acceleration.size());  // never written
  acceleration_.resize(now.acceleration.size());
  const bool enumerated = groups_of(candidates) <= static_cast<std::size_t>(enumeration_groups);
  for (bool assumes_ends = true;; assumes_ends = false) {
    const Decision decision = repeat(&ModeDecision::solve, motion, now, candidates, chain);
    // Few contacts are enumerated: what is neither solved nor refuted there is for the caller to decide.
    if (decision != Decision::failed || enumerated) return decision;
    const Decision limit = repeat(&ModeDecision::solve_as_limit, motion, now, candidates, chain);
    if (limit != Decision::failed || !assumes_ends || !slips_.forget_ends(candidates)) return limit;
  }
}

/// Solves until the answer changes nothing any more.
Decision ModeDecision::repeat(Solve once, SmoothMotion& motion, MotionSample& now,
                              std::span<Candidate> candidates, SolverChain& chain) {
  Decision decision = Decision::failed;
  for (int round = 0; round < most_rounds; ++round) {
    decision = (this->*once)(motion, now, candidates, chain);
    if (decision == Decision::impossible || decision == Decision::failed) return decision;
    if (!slips_.revise(candidates, problem_.problem(), size_, acceleration_.data())) return decision;
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

/// Lists the contacts that take part, stated for accelerations.
void ModeDecision::list_contacts(std::span<Candidate> candidates) {
  contacts_.clear();
  taking_part_.clear();
  taking_part_.reserve(candidates.size());
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    candidates[i].mode = ContactMode::open;
    const bool attached = candidates[i].at.attached != 0;
    if (attached ? taking_part_.empty() || taking_part_.back() + 1 != i : slips_[i].open) continue;
    Constraint& contact = contacts_.add(candidates[i].at);
    taking_part_.push_back(i);
    // In accelerations minus the drift stands for the velocity of the shape on ground.
    for (std::size_t row = 0; row < Constraint::max_rows; ++row) {
      contact.surface_velocity[row] = contact.surface_velocity_after[row] = -contact.drift[row];
    }
    contact.remove_restitution();
    contact.friction = slips_[i].direction.is_zero()
                           ? contact.law.sticking_friction()
                           : contact.law.sliding_friction(std::abs(candidates[i].slip));
  }
}

bool ModeDecision::bounds_follow(SmoothMotion& motion) const {
  const JointReactions& joints = motion.joints();
  return !joints.friction_bounds().empty() &&
         std::any_of(contacts_.begin(), contacts_.end(),
                     [&](const Constraint& contact) { return joints.depends_on_joint_force(contact); });
}

/// Builds the problem of accelerations; what slips has its friction.
void ModeDecision::build(SmoothMotion& motion, const MotionSample& now) {
  motion.joints().build(problem_, contacts_, zero_.data());
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    const TangentDirection& slip = slips_[taking_part_[c]].direction;
    if (!slip.is_zero()) problem_.slide(c, slip);
  }
  problem_.set_free_velocity(now.acceleration.data());
  size_ = size_without_contact(problem_);
}

Decision ModeDecision::solve(SmoothMotion& motion, MotionSample& now, std::span<Candidate> candidates,
                             SolverChain& chain) {
  list_contacts(candidates);
  if (contacts_.empty()) {
    take_accelerations(motion, now);
    return Decision::made;
  }
  build(motion, now);
  const bool follow = bounds_follow(motion);
  const bool solved =
      follow ? converge_friction_bounds(motion, now, candidates, chain) : problem_.solve(chain).usable();
  const ContactReport& report = problem_.report();
  if (!solved || report.outcome == Outcome::no_solution) {
    name_cause(problem_, taking_part_, slips_, candidates);
    return report.outcome == Outcome::no_solution ? Decision::impossible : Decision::failed;
  }
  const double by_rounding = size_by_rounding(problem_);
  // Contacts that jam may be given forces of any size: those whose rounding alone is larger than the
  // accelerations without contact satisfy the certificate, and say nothing.
  if (size_ > 0.0 && SlipDirections::no_acceleration * by_rounding > size_) {
    name_cause(problem_, taking_part_, slips_, candidates);
    return Decision::failed;
  }
  size_ = std::max(size_, by_rounding);
  Decision decision = Decision::made;
  if (!follow) read_modes(candidates, problem_.impulses());
  if (report.outcome == Outcome::several_solutions || finds_several(candidates)) {
    name_cause(problem_, taking_part_, slips_, candidates);
    take_present(candidates);
    decision = Decision::several;
  }
  take_accelerations(motion, now);
  problem_.map().add_velocities(acceleration_.data());
  if (follow || decision != Decision::made) return decision;
  settle_modes(motion, now, candidates);
  if (!pulls_again(motion, now, candidates)) return decision;
  name_cause(problem_, taking_part_, slips_, candidates);
  return Decision::impossible;
}

/// True if a problem with rolling resistance has several answers, which its solvers do not count (Painleve).
bool ModeDecision::finds_several(std::span<Candidate> candidates) {
  if (groups_of(candidates) == contacts_.size()) return false;
  name_cause(problem_, taking_part_, slips_, candidates);
  const auto closes_more = [](const Candidate& at) { return at.stiffness < 0.0; };
  return std::any_of(candidates.begin(), candidates.end(), closes_more) &&
         solutions_.enumerate(problem_.problem()) == Outcome::several_solutions;
}

void ModeDecision::read_modes(std::span<Candidate> candidates, std::span<const double> force) {
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    const std::size_t i = taking_part_[c];
    if (contacts_[c].attached) {
      candidates[i].mode = mode_of_rolling(problem_, c, candidates[i - 1].mode, slips_[i].direction, force);
      continue;
    }
    const ContactMode found = problem_.modes()[c];
    // Friction in a joint never opens.
    const bool has_given_bound = contacts_[c].has_given_bound();
    if (has_given_bound && slips_[i].direction.is_zero()) {
      candidates[i].mode = found == ContactMode::open ? ContactMode::stick : found;
      continue;
    }
    const double normal = has_given_bound ? 1.0 : force[static_cast<std::size_t>(problem_.first_row(c))];
    if (!slips_[i].direction.is_zero()) {
      candidates[i].mode =
          normal > 0.0 ? slips_[i].direction.mode(contacts_[c].tangents()) : ContactMode::open;
    } else {
      candidates[i].mode = found;
    }
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
    closed.friction = candidate.frictionless ? 0.0 : contacts_[c].friction;
  }
}

/// Modes that do not follow from the answer. Contacts without force that do not part stay closed where they
/// can carry some: of redundant contacts solvers load any.
void ModeDecision::complete_modes(SmoothMotion& motion, MotionSample& now, std::span<Candidate> candidates) {
  std::vector<std::size_t> added;  // candidates
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    const Constraint& contact = contacts_[c];
    const std::size_t i = taking_part_[c];
    const bool rests = candidates[i - contact.attached].mode == ContactMode::open;
    if (contact.normals == 0 && !rests && candidates[i].slip == 0.0 && !candidates[i].starts_slipping) {
      // Friction in a joint that contacts keep from turning, at its bound or not, does not slip; where the
      // bound is zero the force does not determine the mode.
      const double along = contact.tangential_acceleration(acceleration_.data());
      if (std::abs(along) <= SlipDirections::no_acceleration * size_) {
        candidates[i].mode = ContactMode::stick;
      } else if (slips_[i].direction.is_zero()) {
        candidates[i].mode = mode_by_sign(along);
      }
    }
    if (contact.normals == 0 || candidates[i].mode != ContactMode::open) continue;
    const int normal = problem_.first_row(c);
    if (problem_.problem().w(normal, normal) == 0.0) continue;  // joints hold it fast, nothing acts
    if (contact.normal_acceleration(acceleration_.data()) > SlipDirections::no_acceleration * size_) continue;
    const TangentDirection::Numbers along = tangential_accelerations(contact, acceleration_.data());
    TangentDirection slip = slips_[i].direction;
    if (slip.is_zero() && std::hypot(along[0], along[1]) > SlipDirections::no_acceleration * size_)
      slip = TangentDirection::of(along);
    // Where forces are not unique its friction would change the motion that was decided.
    if (!slip.is_zero() && contact.friction != 0.0 && !bounds_follow(motion)) continue;
    candidates[i].mode = slip.mode(contact.tangents());
    added.push_back(i);
  }
  follow_contacts(slips_, candidates);
  if (added.empty()) return;
  list_closed(candidates);
  double change = 0.0;
  BoundIteration once;
  const bool found =
      motion.joints().update_friction_bounds(motion.active(), now, active_, margins_, once, change);
  double largest = 0.0;
  for (const ActiveContact& closed : active_) {
    if (closed.at.normals > 0) largest = std::max(largest, std::abs(closed.normal));
  }
  auto closed = active_.begin();  // in the order of the candidates, as those added
  for (const std::size_t i : added) {
    while (closed->place != candidates[i].place) ++closed;
    if (!found || !(closed->normal > no_force * largest)) candidates[i].mode = ContactMode::open;
  }
  follow_contacts(slips_, candidates);
}

/// Bounds of friction in joints follow from forces that may not be unique: the decision needs those that the
/// flow will find. Modes by the problem at given bounds, and bounds by the flow's forces in these, in turns.
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
      contacts_[c].of_joint.friction_bound =
          guesses ? iteration.guess(bound++) : closed.at.of_joint.friction_bound;
      problem_.update_bound(c);
    }
    if (converged) return true;
  }
  return false;
}

}  // namespace carom
