// Problem: one impact by the rules, whoever strikes it.

#include <carom/contact/impact_restitution.h>
#include <carom/contact/strike.h>
#include <carom/core/part_check.h>

#include <algorithm>
#include <cstddef>

namespace carom {

namespace {

// Speeds that differ by less than this part are the same: rounding of symmetric scenes.
constexpr double same_speed = 1e-9;
// Factors tried from 1 downwards: the gain need not fall with the factor.
constexpr int factors = 64;
constexpr int halvings = 52;

}  // namespace

std::optional<ImpactLaw> law_of_impact(std::span<const Constraint> constraints) {
  std::optional<ImpactLaw> law;
  for (const Constraint& constraint : constraints) {
    if (constraint.rows < 2) continue;  // it follows the law of the contacts
    if (law && *law != constraint.law.impact_law) return std::nullopt;
    law = constraint.law.impact_law;
  }
  return law ? law : ImpactLaw::newton;
}

void keep_fastest(ConstraintSet& constraints, const double* velocities) {
  double fastest = 0.0;
  for (const Constraint& constraint : constraints) {
    fastest = std::max(fastest, -constraint.normal_velocity(velocities));
  }
  const double least = (1.0 - same_speed) * fastest;
  bool kept = true;
  constraints.remove_if([&](const Constraint& constraint) {
    if (!constraint.attached)
      kept = constraint.normals == 0 || !(-constraint.normal_velocity(velocities) < least);
    return !kept;
  });
}

ImpulseWork work_of_impact(const IslandProblem& problem) {
  const std::span<const double> impulses = problem.impulses(), before = problem.before();
  std::vector<double> xi(impulses.size());
  problem.problem().velocities(impulses, xi);
  const double factor = problem.restitution_factor();
  ImpulseWork work;
  std::size_t row = 0;
  for (const Constraint& constraint : problem.constraints()) {
    for (int i = 0; i < constraint.rows; ++i, ++row) {
      work.add(impulses[row], before[row], xi[row] - factor * constraint.restitution(i) * before[row]);
      if (constraint.has_given_bound()) work.allow_for_joint_friction(impulses[row], before[row]);
    }
  }
  return work;
}

double limit_gain(const IslandProblem& problem, std::span<Constraint> constraints,
                  FunctionRef<bool()> solve) {
  if (!work_of_impact(problem).is_gain()) return 1.0;
  std::vector<Surface> laws;
  for (const Constraint& constraint : constraints) laws.push_back(constraint.law);
  bool solved = true;
  const auto gains = [&](double factor) {
    for (std::size_t c = 0; c < laws.size(); ++c) {
      Surface& law = constraints[c].law;
      law.normal_restitution = factor * laws[c].normal_restitution;
      law.tangential_restitution = factor * laws[c].tangential_restitution;
    }
    solved = solved && solve();
    if (!solved) return false;
    // Well within rounding, for whoever adds up the works from other numbers.
    const ImpulseWork work = work_of_impact(problem);
    return work.gain > 0.1 * work.tolerance();
  };
  int grid = factors - 1;
  while (grid > 0 && gains(static_cast<double>(grid) / factors)) --grid;
  double least = static_cast<double>(grid) / factors, most = static_cast<double>(grid + 1) / factors;
  for (int i = 0; i < halvings && solved; ++i) {
    const double middle = 0.5 * (least + most);
    if (middle <= least || middle >= most) break;
    (gains(middle) ? most : least) = middle;
  }
  static_cast<void>(gains(least));
  return least;
}

bool takes_part(const Constraint& constraint, const ImpactsOfMode& of_mode, bool follows_joint_force) {
  return !constraint.has_given_bound() || (of_mode.with_joint_friction && follows_joint_force);
}

ImpactOnset onset_of(double fastest, double noise, double capture_speed, int struck,
                     const ImpactsOfMode& of_mode) {
  if (!(fastest > noise)) return ImpactOnset::nothing;
  if (fastest > capture_speed || struck > 0) return ImpactOnset::impact;
  return of_mode.closes_slow ? ImpactOnset::closing : ImpactOnset::nothing;
}

Struck strike(ConstraintSet& touching, const StrikeInput& in, FunctionRef<StrikeAnswer(ImpactLaw)> solve) {
  Struck out;
  if (in.rules.order == ImpactOrder::sequential && !in.plastic) {
    out.cut_sequence = in.struck >= in.rules.sequence_limit;
    if (!out.cut_sequence) keep_fastest(touching, in.velocity);
  }
  share_impact_restitution(touching, in.velocity, 0.0);
  const bool plastic = in.plastic || out.cut_sequence;
  for (Constraint& constraint : touching) {
    if (plastic) constraint.remove_restitution();
    const double sliding = constraint.sliding_speed(in.velocity);
    constraint.friction = constraint.law.friction_at(sliding > in.speed_noise ? sliding : 0.0);
  }
  const std::optional<ImpactLaw> law = plastic ? ImpactLaw::newton : law_of_impact(touching);
  if (!law) {
    out.outcome = Struck::Outcome::laws_differ;
    return out;
  }
  const StrikeAnswer answer = solve(*law);
  const IslandProblem& problem = answer.problem;
  bool solved = answer.is_solved;
  out.problem = &answer.problem;
  if (solved && in.rules.energy_gain == EnergyGain::limit && !plastic) {
    const auto again = [&] { return solve(*law).is_solved; };
    out.restitution_factor = limit_gain(problem, touching, again);
    solved = problem.report().usable();
  }
  if (!solved) out.outcome = Struck::Outcome::not_solved;
  out.restitution_factor *= problem.restitution_factor();
  return out;
}

std::string impacts_without_end() {
  return "impacts at one instant do not come to an end, more than " + std::to_string(most_impacts_at_once) +
         " (restitution of 1, or unequal ones, where contacts hand on the motion)";
}

std::string hint_at_jams(const ImpactRules& rules, std::size_t constraints) {
  if (!rules.refuse_jams || constraints < 2) return {};
  return " (impact_rules.refuse_jams is set; use one e for surfaces between which a body jams)";
}

std::string gain_is_refused(const std::string& who, double gain) {
  return who + " adds " + to_text(gain) +
         " J; allowed: no gain (impact_rules.energy_gain is refuse; use e_n = e_t)";
}

}  // namespace carom
