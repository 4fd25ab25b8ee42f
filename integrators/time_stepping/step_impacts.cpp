// Problem: impacts at the start of a step by the laws that the step itself does not know.

#include <carom/integrators/time_stepping/step_impacts.h>

#include <algorithm>
#include <cmath>

namespace carom {

namespace {

// Speeds below this part of the largest are rounding: answers of contact problems are certified to 1e-12.
constexpr double speed_rounding = 1e-12;

/// Large ones are left to sweeps, but for laws whose solver needs W in full.
IslandOptions options_of_impacts(const StepModel& model) {
  IslandOptions options{.plastic_jams = !model.options.impact_rules.refuse_jams};
  if (!has_other_impact_law(model.detector)) options.factored_from = factored_constraints;
  return options;
}

}  // namespace

StepImpacts::StepImpacts(const StepModel& model)
    : model_(&model),
      on_(model.options.impact_rules.order == ImpactOrder::sequential ||
          model.options.impact_rules.energy_gain == EnergyGain::limit ||
          model.options.overlaps.never_tunnel || model.ends_at_closings ||
          has_other_impact_law(model.detector)),
      capture_(CaptureRule::of(model.assembly, model.options)),
      balance_(model.assembly, model.options),
      problems_(options_of_impacts(model)),
      response_(model.assembly) {
  if (!on_) return;
  chain_.set_budget(budget_of(model.options));
  const Assembly& assembly = model.assembly;
  joints_.reserve(assembly.components().size());
  for (Index component = 0; component < assembly.components().size(); ++component) {
    if (append_constraints(assembly, component, joints_)) joints_.back().factors().reveal_rank(true);
  }
  list_ = addresses_of(joints_);
  response_.bind(list_);
}

bool StepImpacts::resolve(const StepInput& in, std::span<const StepIsland> islands, StepTrial& trial) {
  bool struck = false;
  const auto bodies = static_cast<Index>(in.assembly.layout()->bodies().size());
  for (const StepIsland& island : islands) {
    contacts_.clear();
    for (const Constraint& constraint : island.constraints) {
      if (!takes_part(constraint, impacts_of_steps, false)) continue;
      Constraint& contact = contacts_.add(constraint);
      contact.surface_velocity_after = contact.surface_velocity;
      contact.allowed_approach = 0.0;
    }
    const double* const v = struck ? start_.v.data() : in.start.v.data();
    const ClosingNotes& notes = in.companion.closings;
    const auto approaches = [&](const Constraint& contact) {
      return capture_.is_fast(contact.normal_velocity(v)) ||
             is_noted(notes.free, notes.all_free, contact, v) || is_noted(notes.cut, false, contact, v);
    };
    if (std::none_of(contacts_.begin(), contacts_.end(), approaches)) continue;
    if (!struck) {
      start_ = in.start;
      balance_.begin(in);
      place_joints(in, trial);
    }
    struck = true;
    const auto mechanism = [&](Index body) { return in.assembly.mechanism(body); };
    for (const Range part : partition_.arrange(std::span(contacts_), bodies, mechanism)) {
      resolve_island(in, std::span(contacts_).subspan(part.begin, part.size()), trial);
    }
  }
  return struck;
}

/// True of a contact that is to be solved as an impact although it may be slow. \param all whether all that
/// approach are
bool StepImpacts::is_noted(const std::vector<ConstraintKey>& keys, bool all, const Constraint& contact,
                           const double* v) const {
  if (!model_->ends_at_closings || (keys.empty() && !all)) return false;
  if (!(contact.normal_velocity(v) < -capture_.slowest)) return false;
  return all || std::find(keys.begin(), keys.end(), contact.key) != keys.end();
}

void StepImpacts::place_joints(const StepInput& in, StepTrial& trial) {
  if (joints_.empty()) return;
  evaluate_positions(in.assembly, in.start.view(), trial.at_start);
  for (JointConstraints& joints : joints_) {
    joints.update_and_factor({in.start.view(), trial.at_start.rotation.data()});
  }
}

double StepImpacts::fastest(std::span<const Constraint> contacts) const {
  double speed = 0.0;
  for (const Constraint& contact : contacts) {
    speed = std::max(speed, -contact.normal_velocity(start_.v.data()));
  }
  return speed;
}

/// Impacts of contacts that share bodies, until none closes faster than the capture speed; a sequence, until
/// none closes at all.
void StepImpacts::resolve_island(const StepInput& in, std::span<const Constraint> contacts,
                                 StepTrial& trial) {
  const TimeStepping& options = model_->options;
  const bool sequential = options.impact_rules.order == ImpactOrder::sequential;
  const ClosingNotes& notes = in.companion.closings;
  double noise = 0.0;
  bool any_free = false, any_cut = false;
  for (const Constraint& contact : contacts) {
    noise = std::max(noise, speed_rounding * contact.speed(0, start_.v.data()));
    any_free = any_free || is_noted(notes.free, notes.all_free, contact, start_.v.data());
    any_cut = any_cut || is_noted(notes.cut, false, contact, start_.v.data());
  }
  for (int round = 0; round < most_impacts_at_once; ++round) {
    const double slow = round == 0 && (any_free || any_cut) ? 0.0 : options.capture_speed;
    const int of_sequence = sequential ? round : 0;
    if (onset_of(fastest(contacts), noise, slow, of_sequence, impacts_of_steps) == ImpactOnset::nothing)
      return;
    touching_.assign(contacts);
    const StrikeInput impact{.rules = options.impact_rules,
                             .velocity = start_.v.data(),
                             .speed_noise = noise,
                             .struck = round,
                             .plastic = any_cut};
    const auto by = [this](ImpactLaw law) { return solve(law); };
    const Struck struck = strike(touching_, impact, by);
    if (struck.outcome == Struck::Outcome::laws_differ)
      errors(in, trial).fail_impacts(solve(ImpactLaw::newton).problem, laws_of_impact_differ);
    if (struck.outcome == Struck::Outcome::not_solved) errors(in, trial).fail_contact(*struck.problem);
    ImpactNote note;
    note.cut_sequence = any_cut || struck.cut_sequence;
    note.restitution_factor = struck.restitution_factor;
    apply(in, note, *struck.problem, trial);
    if (note.cut_sequence) return;
  }
  errors(in, trial).fail_impacts(problems_.by(ImpactLaw::newton), impacts_without_end());
}

/// Errors of the component of an impact.
StepErrors StepImpacts::errors(const StepInput& in, StepTrial& trial) const {
  return model_->errors(in, in.assembly.component_of(touching_[0].body()), trial);
}

/// States and solves the impact of the contacts listed.
StrikeAnswer StepImpacts::solve(ImpactLaw law) {
  IslandProblem& problem = problems_.by(law);
  problem.build(touching_, start_.v.data());
  problem.respond(response_);
  problem.set_free_velocity(start_.v.data());
  return {problem, problem.solve(chain_).usable()};
}

/// Books the impact. Joints whose rate is prescribed do work on it, which is the rest of the change.
/// Velocities of the rule of mean loads obey joints but for an error of the step, on which their answers do
/// work.
void StepImpacts::apply(const StepInput& in, const ImpactNote& note, const IslandProblem& problem,
                        StepTrial& trial) {
  const bool driven = std::any_of(joints_.begin(), joints_.end(),
                                  [](const JointConstraints& joints) { return joints.depends_on_time(); });
  const bool has_rest = driven || (model_->rule.is_mean() && !joints_.empty());
  const Range all{0, static_cast<Index>(in.assembly.layout()->bodies().size())};
  const double before = has_rest ? kinetic_energy(in.assembly, all, start_.v.data()) : 0.0;
  problem.map().add_velocities(start_.v.data());
  const EnergyFlows known = balance_.result().flows;
  const double gain = balance_.book_impact(problem, start_.v.data(), note, in, trial);
  EnergyFlows& flows = balance_.result().flows;
  if (has_rest) {
    double booked = 0.0;
    for (std::size_t i = 0; i < energy_flow_count; ++i) {
      const double change = flows.values[i] - known.values[i];
      booked += is_gain(static_cast<EnergyFlow>(i)) ? change : -change;
    }
    const double rest = kinetic_energy(in.assembly, all, start_.v.data()) - before - booked;
    if (driven) flows[EnergyFlow::external] += rest;
    if (!driven) flows[EnergyFlow::coupling_discretisation] -= rest;
  }
  if (note.cut_sequence) {
    for (const EnergyFlow line : {EnergyFlow::impact_normal, EnergyFlow::impact_tangential,
                                  EnergyFlow::contact_normal, EnergyFlow::sliding, EnergyFlow::rolling}) {
      flows[EnergyFlow::accumulation] += flows[line] - known[line];
      flows[line] = known[line];
    }
  }
  if (gain > 0.0 && model_->options.impact_rules.energy_gain == EnergyGain::refuse) {
    errors(in, trial).refuse_gain(problem, gain);
  }
}

void StepImpacts::remove_restitution(std::span<const StepIsland> islands) {
  for (const StepIsland& island : islands) {
    for (Constraint& constraint : island.constraints) constraint.remove_restitution();
  }
}

}  // namespace carom
