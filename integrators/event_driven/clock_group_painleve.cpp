// Problem: contacts that no forces keep (Painleve): sliding that comes to that, and the impact without
// collision that it leads to.

#include <carom/integrators/event_driven/clock_group.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace carom {

namespace {

/// Restitution along a row of a contact.
double restitution(const Constraint& contact, int row) {
  return row == 0 ? contact.law.normal_restitution : contact.law.tangential_restitution;
}

/// Gives all contacts the least of their coefficients of tangential restitution. False if they had one.
bool share_restitution(std::vector<Constraint>& contacts) {
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

/// Contacts whose forces have grown without bound where the flow stands. True if there are any.
bool ClockGroup::find_unbounded_force() {
  unbounded_forces_.clear();
  motion_.evaluate(flow_->end(), flow_->state().data(), true);
  for (const ActiveContact& contact : motion_.active().list()) {
    if (std::abs(contact.normal) > without_bound * force_scale_) unbounded_forces_.push_back(contact.pair);
  }
  return !unbounded_forces_.empty();
}

bool ClockGroup::has_unbounded_force() const {
  const std::vector<Candidate>& candidates = work_->candidates;
  return std::any_of(candidates.begin(), candidates.end(), [&](const Candidate& candidate) {
    return std::find(unbounded_forces_.begin(), unbounded_forces_.end(), candidate.pair) !=
           unbounded_forces_.end();
  });
}

/// Modes of the candidates collected. What is in front of p = 0 cannot be told from what is behind where
/// time, or the contact problem, has no numbers in between. Then friction is taken for as much larger as it
/// takes to be behind. Where that decides nothing, and forces are neither found nor excluded, there are none
/// to keep what slides: closed contacts in line stand there within rounding of a singular position, on one
/// side of which there are none and on the other ones without bound.
Decision ClockGroup::decide_candidates(std::size_t first, std::size_t last) {
  std::vector<Candidate>& candidates = work_->candidates;
  const auto decide = [&] {
    return work_->decision.decide(*assembly_, motion_, candidates, work_->motion.acceleration.data(),
                                  work_->chain);
  };
  const bool jammed = has_unbounded_force();
  if (!jammed) {
    const Decision decision = decide();
    if (decision != Decision::failed) return decision;
  }
  constexpr double least_excess = 1e-12, growth = 4.0;
  for (double excess = least_excess; excess * without_bound <= 1.0; excess *= growth) {
    collect_candidates(first, last);
    for (Candidate& candidate : candidates) {
      if (candidate.slip == 0.0 || candidate.at.has_dry_friction()) continue;
      Surface& law = candidate.at.law;
      law.friction = (1.0 + excess) * law.sliding_friction(std::abs(candidate.slip));
      law.static_friction = candidate.at.friction = law.friction;
    }
    if (decide() != Decision::impossible) continue;
    unbounded_forces_.clear();
    return Decision::impossible;
  }
  collect_candidates(first, last);
  if (!jammed) {
    const bool slides = std::any_of(candidates.begin(), candidates.end(), [](const Candidate& candidate) {
      return candidate.slip != 0.0 && !candidate.at.has_dry_friction();
    });
    // Of more contacts not all modes have been looked at.
    const bool all_seen = candidates.size() <= static_cast<std::size_t>(enumeration_groups);
    const Decision decision = decide();
    return decision == Decision::failed && slides && all_seen ? Decision::impossible : decision;
  }
  std::vector<std::string> names;
  names.reserve(candidates.size());
  for (const Candidate& candidate : candidates) names.push_back(detector_->name(candidate.at.key));
  fail(unbounded_force_ + "; forces of contact grow without bound, a jam (Painleve)", std::move(names));
}

/// Of the answers listed those with impulses that change something count; the number of the one that takes
/// most energy, size() if there is none.
std::size_t ClockGroup::most_dissipative_solution() {
  IslandProblem& cluster = work_->cluster;
  std::size_t best = solutions_.size();
  double most = -std::numeric_limits<double>::infinity();
  for (std::size_t s = 0; s < solutions_.size(); ++s) {
    double change = 0.0, loss = 0.0;
    for (std::size_t c = 0; c < cluster.constraints().size(); ++c) {
      const Constraint& contact = cluster.constraints()[c];
      for (int row = 0; row < contact.rows; ++row) {
        const auto place = static_cast<std::size_t>(cluster.first_row(c) + row);
        const double before = cluster.before()[place];
        const double after = solutions_.velocity(s)[place] - restitution(contact, row) * before;
        change = std::max(change, std::abs(after - before));
        loss -= 0.5 * solutions_.impulse(s)[place] * (before + after);
      }
    }
    if (!(change > speed_noise()) || !(loss > most)) continue;
    most = loss;
    best = s;
  }
  return best;
}

/// The limit of an impact at vanishing speed: of its answers with impulses the one that takes most energy.
void ClockGroup::impact_without_collision(EventBalance& balance) {
  std::vector<Candidate>& candidates = work_->candidates;
  double* const velocity = work_->motion.trial.v.data();
  std::vector<Constraint>& touching = work_->touching;
  touching.clear();
  std::vector<std::string> names;
  std::vector<std::size_t> taking_part;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    // Friction in joints keeps nothing from jamming.
    if (candidates[i].at.has_dry_friction()) continue;
    taking_part.push_back(i);
    Constraint& contact = touching.emplace_back(candidates[i].at);
    // At no speed: what is left of it is rounding, which the certificate of P = 0 would take offence at.
    const double rounding = contact.normal_velocity(velocity);
    contact.surface_velocity[0] += rounding;
    contact.surface_velocity_after[0] += rounding;
    names.push_back(detector_->name(candidates[i].at.key));
  }
  IslandProblem& cluster = work_->cluster;
  bool solved = false;
  std::size_t best = 0;
  do {
    cluster.build(touching, velocity);
    motion_.respond(cluster);
    cluster.set_free_velocity(velocity);
    solved = cluster.solve(work_->chain).usable() &&
             solutions_.enumerate(cluster.problem()) != Outcome::not_solved;
    best = solved ? most_dissipative_solution() : solutions_.size();
    // With unequal restitution there may be none, with an equal one there is: e_n means nothing without
    // speed.
  } while ((!solved || best == solutions_.size()) && share_restitution(touching));
  if (!solved) {
    fail("no forces keep the contact and the impact without collision is not solved", std::move(names),
         &cluster);
  }
  if (best == solutions_.size()) {
    fail("no forces keep the contact, and no impact without collision does", std::move(names), &cluster);
  }
  cluster.set_impulses(solutions_.impulse(best));
  const double energy_before = motion_.kinetic_energy(touching.front().body());
  cluster.map().add_velocities(velocity);
  const Range v = assembly_->components()[motion_.component()].v;
  std::copy(velocity + v.begin, velocity + v.end,
            y_.begin() + static_cast<std::ptrdiff_t>(motion_.v_begin()));
  const std::size_t told = balance.events.size();
  book_impact(EventKind::impact_without_collision, energy_before, balance);
  for (std::size_t i = told; i < balance.events.size(); ++i) {
    const Candidate& candidate = candidates[taking_part[i - told]];
    balance.events[i].stiffness = candidate.stiffness;
    balance.events[i].free_acceleration = candidate.free_acceleration;
  }
  stopped_ = {};
  motion_.evaluate(time_, y_.data(), false);
  locate_contacts();
  resolve_impacts(balance);
}

}  // namespace carom
