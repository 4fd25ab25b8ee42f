// Problem: modes of the contacts of a body from its accelerations.

#include <carom/integrators/event_driven/mode_decision.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace carom {

namespace {

// An acceleration this small against those without contact is zero.
constexpr double no_acceleration = 1e-11;

// Contacts that break loose or lift change the problem of the others; more rounds than this do not settle.
constexpr int most_rounds = 20;

}  // namespace

Decision ModeDecision::decide(const Assembly& assembly, SmoothMotion& motion, std::span<Candidate> candidates,
                              const double* acceleration, SolverChain& chain) {
  slides_.assign(candidates.size(), {});
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const Candidate& candidate = candidates[i];
    if (candidate.frictionless) {
      slides_[i].sign = 1.0;
    } else if (candidate.slip != 0.0) {
      slides_[i].sign = std::copysign(1.0, candidate.slip);
    } else if (candidate.breaks) {
      slides_[i].sign = -std::copysign(1.0, candidate.push);
    }
    slides_[i].out = candidate.releases;
  }
  zero_.assign(assembly.layout()->v_size(), 0.0);
  Decision decision = Decision::failed;
  for (int round = 0; round < most_rounds; ++round) {
    decision = solve(motion, candidates, acceleration, chain);
    if (decision == Decision::impossible || decision == Decision::failed) return decision;
    if (!revise(candidates)) return decision;
  }
  return decision;
}

Decision ModeDecision::solve(SmoothMotion& motion, std::span<Candidate> candidates,
                             const double* acceleration, SolverChain& chain) {
  contacts_.clear();
  taking_part_.clear();
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    candidates[i].mode = ContactMode::open;
    if (slides_[i].out) continue;
    Constraint& contact = contacts_.emplace_back(candidates[i].at);
    taking_part_.push_back(i);
    // In accelerations: what the velocity of the obstacle is to velocities, minus the drift is to these.
    for (std::size_t row = 0; row < Constraint::max_rows; ++row) {
      contact.surface_velocity[row] = contact.surface_velocity_after[row] = -contact.drift[row];
    }
    contact.law.normal_restitution = contact.law.tangential_restitution = 0.0;
    contact.friction = slides_[i].sign == 0.0 ? contact.law.sticking_friction()
                                              : contact.law.sliding_friction(std::abs(candidates[i].slip));
  }
  if (contacts_.empty()) {
    acceleration_.assign(acceleration, acceleration + zero_.size());
    return Decision::made;
  }
  cluster_.build(contacts_, zero_.data());
  motion.respond(cluster_);
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    const double sign = slides_[taking_part_[c]].sign;
    if (sign != 0.0 && contacts_[c].type != ConstraintType::limit)
      cluster_.slide(c, -sign * contacts_[c].friction);
  }
  cluster_.set_free_velocity(acceleration);
  const bool presses =
      motion.bears_any() && std::any_of(contacts_.begin(), contacts_.end(), [&](const Constraint& contact) {
        return motion.depends_on_joint_force(contact);
      });
  const bool solved =
      presses ? settle_bounds(motion, candidates, acceleration, chain) : cluster_.solve(chain).usable();
  const ContactReport& report = cluster_.report();
  if (!solved || report.outcome == Outcome::no_solution) {
    name_culprit(candidates);
    return report.outcome == Outcome::no_solution ? Decision::impossible : Decision::failed;
  }
  Decision decision = Decision::made;
  if (!presses) read_modes(candidates, cluster_.impulses());
  if (report.outcome == Outcome::several_solutions) {
    name_culprit(candidates);
    keep_present(candidates);
    decision = Decision::several;
  }
  acceleration_.assign(acceleration, acceleration + zero_.size());
  cluster_.map().add_velocities(acceleration_.data());
  return decision;
}

void ModeDecision::read_modes(std::span<Candidate> candidates, std::span<const double> force) {
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    const std::size_t i = taking_part_[c];
    const ContactMode found = cluster_.modes()[c];
    // Friction in a joint never opens.
    const bool has_dry_friction = contacts_[c].has_dry_friction();
    if (has_dry_friction && slides_[i].sign == 0.0) {
      candidates[i].mode = found == ContactMode::open ? ContactMode::stick : found;
      continue;
    }
    const double normal = has_dry_friction ? 1.0 : force[static_cast<std::size_t>(cluster_.first_row(c))];
    if (slides_[i].sign != 0.0) {
      candidates[i].mode = !(normal > 0.0)         ? ContactMode::open
                           : slides_[i].sign > 0.0 ? ContactMode::slip_positive
                                                   : ContactMode::slip_negative;
    } else {
      candidates[i].mode = found;
    }
  }
}

/// What the first answer leaves to change: contacts that break loose rub at their sliding coefficient; those
/// that were taken to lift or slip and do not, since another one that broke loose took them along, are put
/// back. True if the problem is to be solved anew.
bool ModeDecision::revise(std::span<Candidate> candidates) {
  bool changed = false;
  double size = 0.0, farthest = 0.0;
  for (const double b : cluster_.problem().vector()) size = std::max(size, std::abs(b));
  // Accelerations by friction that is exhausted to within its rounding only.
  double stiffest = 0.0, exhausted = 0.0;
  for (int row = 0; row < cluster_.problem().rows(); ++row) {
    stiffest = std::max(stiffest, cluster_.problem().w(row, row));
  }
  for (const Candidate& candidate : candidates) exhausted += candidate.noise * stiffest;
  Slide* astray = nullptr;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const Candidate& candidate = candidates[i];
    Slide& slide = slides_[i];
    const double lifts = candidate.at.normal_acceleration(acceleration_.data());
    const double slides = candidate.at.tangential_acceleration(acceleration_.data());
    if (slide.out) {
      if (lifts >= -no_acceleration * std::max(size, std::abs(lifts))) continue;
      slide.out = false;
      changed = true;
    } else if (slide.sign == 0.0 && (candidate.mode == ContactMode::slip_positive ||
                                     candidate.mode == ContactMode::slip_negative)) {
      slide.sign = candidate.mode == ContactMode::slip_positive ? 1.0 : -1.0;
      changed = true;
    } else if (candidate.slip == 0.0 && !candidate.frictionless && !slide.back &&
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
  astray->back = true;
  return true;
}

void ModeDecision::name_culprit(std::span<Candidate> candidates) {
  const ContactProblem& problem = cluster_.problem();
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    const std::size_t i = taking_part_[c];
    if (contacts_[c].has_dry_friction()) continue;
    const int row = cluster_.first_row(c);
    const double ratio = -slides_[i].sign * contacts_[c].friction;
    candidates[i].stiffness = problem.w(row, row);
    if (contacts_[c].rows > 1) candidates[i].stiffness += ratio * problem.w(row, row + 1);
    candidates[i].free_acceleration = problem.vector()[static_cast<std::size_t>(row)];
  }
}

/// Of several answers the one in the present modes; where there is none, the one with most contacts open.
bool ModeDecision::keep_present(std::span<Candidate> candidates) {
  if (solutions_.enumerate(cluster_.problem()) == Outcome::not_solved) return false;
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
  cluster_.set_impulses(solutions_.impulse(solution));
  read_modes(candidates, cluster_.impulses());
}

}  // namespace carom
