// Problem: an impact that is not due to speed but to the lack of forces.

#include <carom/integrators/event_driven/impact_without_collision.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace carom {

namespace {

/// Gives all contacts the least of their coefficients of tangential restitution. False if they had one.
bool share_restitution(ConstraintSet& contacts) {
  double least = std::numeric_limits<double>::infinity(), largest = 0.0;
  for (const Constraint& contact : contacts) {
    if (contact.rows < 2) continue;
    least = std::min(least, contact.law.tangential_restitution);
    largest = std::max(largest, contact.law.tangential_restitution);
  }
  if (!(least < largest)) return false;
  for (Constraint& contact : contacts) {
    contact.law.normal_restitution = contact.law.tangential_restitution = least;
  }
  return true;
}

}  // namespace

bool ImpactWithoutCollision::resolve(std::span<const Candidate> candidates, ImpactStage& impacts,
                                     SolverChain& chain, EventInstant& at) {
  const auto find = [&](NormalSpeed speed) {
    list_touching(candidates, speed, at);
    return find_listed(chain, at) || find_limit(candidates, chain, at);
  };
  forces_.clear();
  if (!find(NormalSpeed::removed) && !find(NormalSpeed::kept)) return false;
  const std::size_t first = at.balance.fresh.size();
  impacts.apply(EventKind::impact_without_collision, problem_, at);
  std::size_t event = first;
  for (const std::size_t i : taking_part_) {
    if (candidates[i].at.attached || event == at.balance.fresh.size())
      continue;  // in the record of its contact
    at.balance.fresh[event].stiffness = candidates[i].stiffness;
    at.balance.fresh[event++].free_acceleration = candidates[i].free_acceleration;
  }
  at.update();
  // It may throw the body against something else.
  if (impacts.resolve(at)) at.update();
  return true;
}

/// Of the answers that are listed the most dissipative one. With unequal restitution there may be none, with
/// an equal one there is: e_n means nothing without speed.
bool ImpactWithoutCollision::find_listed(SolverChain& chain, EventInstant& at) {
  const auto groups = std::count_if(touching_.begin(), touching_.end(),
                                    [](const Constraint& contact) { return !contact.attached; });
  if (groups > enumeration_groups) return false;
  bool solved = false;
  do {
    solved = solve(chain, at);
  } while ((!solved || best_ == solutions_.size()) && share_restitution(touching_));
  if (!solved || best_ == solutions_.size()) return false;
  problem_.set_impulses(solutions_.impulse(best_));
  return true;
}

void ImpactWithoutCollision::list_touching(std::span<const Candidate> candidates, NormalSpeed speed,
                                           const EventInstant& at) {
  touching_.clear();
  taking_part_.clear();
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    // Friction in joints bounds no contact force.
    if (candidates[i].at.has_given_bound()) continue;
    taking_part_.push_back(i);
    Constraint& contact = touching_.add(candidates[i].at);
    if (speed == NormalSpeed::kept) continue;
    const double rounding = contact.normal_velocity(at.velocities());
    contact.surface_velocity[0] += rounding;
    contact.surface_velocity_after[0] += rounding;
  }
}

bool ImpactWithoutCollision::solve(SolverChain& chain, EventInstant& at) {
  at.motion.joints().build(problem_, touching_, at.velocities());
  problem_.set_free_velocity(at.velocities());
  const bool solved =
      problem_.solve(chain).usable() && solutions_.enumerate(problem_.problem()) != Outcome::not_solved;
  best_ = solved ? most_dissipative_solution(at.scales.speed_noise) : solutions_.size();
  return solved;
}

/// Shorter and shorter steps, down to changes of velocity that are rounding: a jam of what slides slowly
/// leaves impulses small against those of a longer step, and forces that are not unique stay linear in the
/// step only where they are smaller than these.
bool ImpactWithoutCollision::find_limit(std::span<const Candidate> candidates, SolverChain& chain,
                                        EventInstant& at) {
  constexpr double longest = 1e-3, shorter = 1e-2;
  double fastest = 0.0;
  for (std::size_t c = 0; c < touching_.size(); ++c) {
    Constraint& contact = touching_[c];
    contact.remove_restitution();
    if (contact.attached) continue;  // spins
    fastest = std::max(fastest, std::abs(candidates[taking_part_[c]].slip));
  }
  const double pull = largest_acceleration(touching_, at);
  if (!(pull > 0.0) || fastest == 0.0) return false;
  // Contacts that slide hardly faster than rounding are asked once, too.
  double change = longest * fastest;
  do {
    const double step = change / pull;
    change *= shorter;
    if (!take_limit(chain, step, at)) continue;
    if (changes(at.scales.speed_noise)) return true;
    if (forces_.empty()) take_forces(candidates, 0.5 * step);
  } while (change >= shorter * at.scales.speed_noise);
  return false;
}

/// Takes the impulses of the last step for forces, unless they stop or turn what slides.
void ImpactWithoutCollision::take_forces(std::span<const Candidate> candidates, double step) {
  for (std::size_t c = 0; c < touching_.size(); ++c) {
    const double slip = candidates[taking_part_[c]].slip;
    const ContactMode mode = step_modes_[c];
    if (slip != 0.0 && mode != ContactMode::open && mode != mode_by_sign(slip)) return;
  }
  forces_.assign(candidates.size(), {});
  for (std::size_t c = 0; c < touching_.size(); ++c) {
    const auto first = static_cast<std::size_t>(problem_.first_row(c));
    for (std::size_t row = 0; row < static_cast<std::size_t>(touching_[c].rows); ++row)
      forces_[taking_part_[c]][row] = step_impulses_[first + row] / step;
  }
}

/// The limit of the impulses: they are linear in the step as long as no mode changes.
bool ImpactWithoutCollision::take_limit(SolverChain& chain, double step, EventInstant& at) {
  constexpr int most_improvements = 3;
  if (!solve_ahead(step, touching_, at, ahead_, problem_, chain)) return false;
  limit_.assign(problem_.impulses().begin(), problem_.impulses().end());
  if (!solve_ahead(0.5 * step, touching_, at, ahead_, problem_, chain)) return false;
  step_impulses_.assign(problem_.impulses().begin(), problem_.impulses().end());
  step_modes_.assign(problem_.modes().begin(), problem_.modes().end());
  for (std::size_t row = 0; row < limit_.size(); ++row) limit_[row] = 2.0 * step_impulses_[row] - limit_[row];
  for (Constraint& contact : touching_) contact.surface_velocity_after = contact.surface_velocity;
  problem_.set_free_velocity(at.velocities());
  if (!(polish_.improve(problem_.problem(), limit_, most_improvements).value <= tolerated_residual))
    return false;
  problem_.set_impulses(limit_);
  return true;
}

/// True if the impulses at hand change a velocity.
bool ImpactWithoutCollision::changes(double speed_noise) {
  xi_.resize(limit_.size());
  problem_.problem().velocities(problem_.impulses(), xi_);
  double change = 0.0;
  for (std::size_t row = 0; row < xi_.size(); ++row) {
    change = std::max(change, std::abs(xi_[row] - problem_.before()[row]));
  }
  return change > speed_noise;
}

/// Of the solutions listed those with impulses that change something count; the number of the one that takes
/// most energy, size() if there is none.
std::size_t ImpactWithoutCollision::most_dissipative_solution(double speed_noise) const {
  std::size_t best = solutions_.size();
  double most = -std::numeric_limits<double>::infinity();
  for (std::size_t s = 0; s < solutions_.size(); ++s) {
    double change = 0.0, loss = 0.0;
    for (std::size_t c = 0; c < problem_.constraints().size(); ++c) {
      const Constraint& contact = problem_.constraints()[c];
      for (int row = 0; row < contact.rows; ++row) {
        const auto place = static_cast<std::size_t>(problem_.first_row(c) + row);
        const double before = problem_.before()[place];
        const double after = solutions_.velocity(s)[place] - contact.restitution(row) * before;
        change = std::max(change, std::abs(after - before));
        loss -= impulse_work(solutions_.impulse(s)[place], before, after);
      }
    }
    if (!(change > speed_noise) || !(loss > most)) continue;
    most = loss;
    best = s;
  }
  return best;
}

}  // namespace carom
