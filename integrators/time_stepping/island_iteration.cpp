// Problem: the implicit equations of a step over one island of components.

#include <carom/integrators/time_stepping/island_iteration.h>
#include <carom/integrators/time_stepping/motion_check.h>
#include <carom/integrators/time_stepping/returning_contacts.h>

#include <algorithm>

namespace carom {

IslandIteration::IslandIteration(const StepModel& model, const StepConstraints& constraints,
                                 SweepSchedule& schedule, ContactStage& contacts, LocatedImpacts& located,
                                 JointStages& joints, StepTrial& trial, const StopRequest* stop)
    : model_(&model),
      constraints_(&constraints),
      schedule_(&schedule),
      contacts_(&contacts),
      located_(&located),
      joint_stages_(&joints),
      trial_(&trial),
      stop_(stop),
      method_(model.assembly),
      joints_(model.assembly, model.detector.joints(), joints) {
  sweeps_.assign(model.assembly.components().size(), 1);
  method_.use(model.options.iteration);
}

LoadsKnown IslandIteration::solve(const StepIsland& island, const StepInput& in, FixedPointJudge& judge) {
  const LoadsKnown known = iterate(island, in, judge);
  if (!contacts_return(in)) return known;
  allow_return(in, island.constraints);
  judge = FixedPointJudge(model_->tolerance(in), model_->options.max_sweeps);
  return iterate(island, in, judge);
}

bool IslandIteration::contacts_return(const StepInput& in) const {
  return !located_->on() &&
         any_returns(in, contacts_->problems(), model_->rule, model_->options.capture_speed, *trial_);
}

/// Sweeps until the next would change no more than the tolerance. Returns what is known of the loads then.
LoadsKnown IslandIteration::iterate(const StepIsland& island, const StepInput& in, FixedPointJudge& judge) {
  using Verdict = FixedPointJudge::Verdict;
  begin(island, in);
  const Index front = island.components.front();
  const std::vector<int>& before = trial_->history.sweeps;
  const int expected = before.size() == sweeps_.size() ? before[front] : 1;
  for (;;) {
    if (stop_ != nullptr) stop_->check();
    SweepsMade made = is_streamed(island) ? sweep_streamed(sweep_of(in, front), expected, judge)
                                          : sweep_staged(island, in, expected, judge);
    if (const IslandProblem* const failed = located_->first_unsolved()) {
      model_->errors(in, front, *trial_).fail_contact(*failed);
    }
    const SweepChange change = made.change;
    const bool ahead = joints_.any() ? joints_.looks_ahead() : !method_.is_newton();
    Verdict verdict =
        ahead ? judge.judge_ahead(change.change, change.size) : judge.judge(change.change, change.size);
    // Newton's first is that from t_j: small or not, it says nothing of the guess.
    if (method_.is_newton() && judge.sweeps() == 1 && verdict == Verdict::converged) verdict = Verdict::go_on;
    if (verdict == Verdict::failed) fail_contraction(island, in, judge);
    const bool converged = verdict == Verdict::converged || made.converged_one_early;
    if (converged && (find_impacts(island, in) || loads_jump(island, in, false))) {
      verdict = Verdict::go_on;
      made.converged_one_early = false;
    }
    if (verdict == Verdict::converged || made.converged_one_early) {
      for (const Index component : island.components) {
        sweeps_[component] = judge.sweeps() - (made.converged_one_early ? 1 : 0);
      }
      if (joints_.any() && converge_joints(island, in)) made.known = LoadsKnown::total;
      for (const JointStage* const joints : joints_.jointed()) demand_motion(*joints, in, *model_, *trial_);
      // Joints have turned bodies on from the start, which rounds otherwise than loads at the end are to.
      for (const Index component : island.components) {
        if (joints_.any() && made.known == LoadsKnown::total) follow(in, component);
      }
      return made.known;
    }
    improve(island, in, judge);
  }
}

/// The next guess at the loads.
void IslandIteration::improve(const StepIsland& island, const StepInput& in, const FixedPointJudge& judge) {
  const bool sweeps = method_.current() == Iteration::fixed_point;
  if (!sweeps) return method_.improve(island.components, judge, *trial_);
  for (const Index component : island.components) schedule_->improve(sweep_of(in, component));
}

/// Bodies that are hit within the step, as far as the iterate says. True if there are more than were known.
bool IslandIteration::find_impacts(const StepIsland& island, const StepInput& in) {
  if (!located_->on() || method_.is_newton() || joints_.any()) return false;
  bool any = false;
  for (const Index component : island.components) {
    any = located_->take_up(in, {component, component + 1}, island.constraints, constraints_->places(true),
                            *trial_) ||
          any;
  }
  return any;
}

/// Jumps of loads at impacts, of loads that depend on velocities: true if they change the motion. \param
/// local looks only where the blocks concerned are few
bool IslandIteration::loads_jump(const StepIsland& island, const StepInput& in, bool local) {
  constexpr int most_updates = 20;
  StepTrial& trial = *trial_;
  if (!(trial.needs.dissipative || trial.needs.external)) return false;
  if (jump_updates_ == most_updates || !(located_->any_hit() || trial.jumps.on)) return false;
  ++jump_updates_;
  bool any = false;
  for (const Index component : island.components) {
    any = located_->update_jumps(in, model_->rule, component, local, model_->tolerance(in), trial) || any;
  }
  return any;
}

/// Contact problems, and a first guess at the loads.
void IslandIteration::begin(const StepIsland& island, const StepInput& in) {
  joints_.bind(island);
  const bool together = method_.is_newton() || joints_.any();
  contacts_->state_problems(in, island, together, *trial_);
  located_->clear();
  trial_->jumps.on = false;
  jump_updates_ = 0;
  trial_->account.swept = false;
  for (const Index component : island.components) {
    const Range z = model_->assembly.components()[component].z;
    std::copy(in.start.z.begin() + z.begin, in.start.z.begin() + z.end, trial_->end.z.begin() + z.begin);
  }
  method_.start(island.components);
  // Mechanisms, and what they touch, keep to the step: it ends where they are hit.
  if (located_->on() && !together) {
    for (const Index component : island.components) {
      located_->expect(in, component, island.constraints, constraints_->places(false), *trial_);
    }
  }
  if (is_streamed(island)) {
    presolve(island, in);
  } else {
    for (const Index component : island.components) schedule_->guess(sweep_of(in, component));
  }
  if (joints_.any()) joints_.start(in, model_->rule, method_.current(), contact_of(island), *trial_);
  if (!method_.is_newton()) return;
  demand(method_.newton().start(in, model_->rule, newton_island(island), *trial_), island, in);
}

/// Sweeps around contacts alone, and again where loads jump there, or contacts return: the whole of the
/// component need not be iterated twice for these.
void IslandIteration::presolve(const StepIsland& island, const StepInput& in) {
  const SweepStages stages = sweep_of(in, island.components.front());
  const double tolerance = model_->tolerance(in);
  int sweeps = 0;
  bool contract = false;
  const auto sweep = [&](bool again) {
    const auto local = schedule_->presolve(stages, method_.current(), tolerance, again);
    sweeps += local.made;
    contract = local.contract;
  };
  sweep(false);
  while (sweeps > 0 && loads_jump(island, in, true)) sweep(true);
  if (contract && contacts_return(in)) {
    allow_return(in, island.constraints);
    contacts_->state_problems(in, island, false, *trial_);
    sweep(true);
  }
  local_sweeps_ = std::max(local_sweeps_, sweeps);
}

/// A change below the tolerance may leave the constraints above their rounding. Sweeps under the same loads
/// bring the joints there however badly couplings contract. True if there were any.
bool IslandIteration::converge_joints(const StepIsland& island, const StepInput& in) {
  constexpr double improved = 0.8;
  constexpr double open = 1e5;  // roundings
  const Index front = island.components.front();
  double left = joints_.violation(in, *trial_);
  if (!joints_.is_near_singular() && !(left > 1.0)) return false;
  for (int sweeps = 0; sweeps < model_->options.max_sweeps && left > 1.0; ++sweeps) {
    sweep_joints(island, in);
    if (method_.is_newton() && method_.newton().follows_rows()) {  // it asks for the loads where bodies are
      follow(in, front);
      schedule_->evaluate(sweep_of(in, front), LoadsKnown::total, false);
    }
    const double now = joints_.violation(in, *trial_);
    if (!(now < improved * left)) break;
    left = now;
  }
  for (JointStage* const joints : joints_.jointed()) {
    if (left > open) demand_closed(*joints, in, *model_, *trial_);
    if (joints->rows().is_near_singular()) joints->settle_velocities(*trial_);
  }
  return true;
}

/// Nothing comes between the bodies of a block and their loads.
bool IslandIteration::is_streamed(const StepIsland& island) const {
  return island.components.size() == 1 && !method_.is_newton() && contacts_->by_block() &&
         model_->batches.coupling(island.components.front()) == CouplingClass::streamable;
}

/// Newton's method went on, or says why not.
void IslandIteration::demand(NewtonIteration::Outcome outcome, const StepIsland& island,
                             const StepInput& in) {
  if (outcome == NewtonIteration::Outcome::done) return;
  const StepErrors errors = model_->errors(in, island.components.front(), *trial_);
  if (outcome == NewtonIteration::Outcome::singular) errors.fail_linearisation(island.components);
  errors.fail_contact(contacts_->problems().front());
}

NewtonIsland IslandIteration::newton_island(const StepIsland& island) {
  return {island.components, *joint_stages_, contacts_->together(), contacts_->chain()};
}

void IslandIteration::fail_contraction(const StepIsland& island, const StepInput& in,
                                       const FixedPointJudge& judge) {
  model_->errors(in, island.components.front(), *trial_)
      .fail_contraction(judge, method_.current(), {island.components, *joint_stages_, contacts_->problems()});
}

IslandContact IslandIteration::contact_of(const StepIsland& island) {
  return {island.constraints, contacts_->together(), contacts_->chain(), method_.is_newton()};
}

}  // namespace carom
