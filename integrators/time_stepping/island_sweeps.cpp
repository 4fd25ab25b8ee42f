// Problem: one sweep over an island, from a guess at the loads to those that it leads to.

#include <carom/integrators/time_stepping/island_iteration.h>

namespace carom {

/// Bodies and loads block by block: the loads by cause, with potentials, cost more than their sum; they are
/// wanted of the last iterate only, which is expected after as many sweeps as in the last step.
IslandIteration::SweepsMade IslandIteration::sweep_streamed(const SweepStages& stages, int expected,
                                                            FixedPointJudge& judge) {
  using Verdict = FixedPointJudge::Verdict;
  SweepsMade made;
  const bool guessing = judge.sweeps() == 0;
  const bool fused =
      method_.current() == Iteration::fixed_point && schedule_->may_fuse(stages, judge.sweeps(), expected);
  made.known = fused || judge.sweeps() + 1 >= expected ? LoadsKnown::by_cause : LoadsKnown::total;
  if (fused) {
    schedule_->fuse(stages, guessing);
  } else {
    schedule_->stream(stages, guessing, made.known);
  }
  if (const IslandProblem* const failed = contacts_->first_unsolved()) {
    model_->errors(stages.in, stages.component, *trial_).fail_contact(*failed);
  }
  if (fused) {
    const SweepChange earlier = schedule_->earlier_change(stages);
    const Verdict verdict = judge.judge_ahead(earlier.change, earlier.size);
    if (verdict == Verdict::failed) {
      model_->errors(stages.in, stages.component, *trial_)
          .fail_contraction(judge, method_.current(),
                            {{&stages.component, 1}, *joint_stages_, contacts_->problems()});
    }
    made.converged_one_early = verdict == Verdict::converged;
  }
  made.change = schedule_->change(stages);
  trial_->account.swept = true;
  return made;
}

/// Stage by stage over all components of the island: impulses, bodies, and the loads that they lead to.
IslandIteration::SweepsMade IslandIteration::sweep_staged(const StepIsland& island, const StepInput& in,
                                                          int expected, const FixedPointJudge& judge) {
  const Index front = island.components.front();
  const bool newton = method_.is_newton(), alone = island.components.size() == 1;
  SweepsMade made;
  made.known = alone && judge.sweeps() + 1 >= expected ? LoadsKnown::by_cause : LoadsKnown::total;
  if (newton && !method_.newton().follows_rows()) {
    demand(method_.newton().step(in, model_->rule, newton_island(island), *trial_), island, in);
  }
  if (joints_.any()) {
    sweep_joints(island, in);
  } else {
    const IslandProblem* const failed = newton ? nullptr : contacts_->solve(in, model_->rule, *trial_);
    if (failed != nullptr) model_->errors(in, front, *trial_).fail_contact(*failed);
    for (const Index component : island.components) schedule_->move(sweep_of(in, component));
    trial_->account.swept = true;
  }
  for (const Index component : island.components) {
    follow(in, component);
    schedule_->evaluate(sweep_of(in, component), made.known, !newton);
    made.change.take(newton ? method_.newton().change(in, component, *trial_)
                            : schedule_->change(sweep_of(in, component)));
  }
  joints_.take_change(in, *trial_, made.change);
  return made;
}

void IslandIteration::sweep_joints(const StepIsland& island, const StepInput& in) {
  if (method_.is_newton() && method_.newton().follows_rows()) {
    return demand(method_.newton().sweep_untouched(in, model_->rule, joints_.alone()->iterate(), *trial_),
                  island, in);
  }
  const IslandContact contact = contact_of(island);
  if (joints_.sweep(in, model_->rule, contact, *trial_)) return;
  model_->errors(in, island.components.front(), *trial_).fail_contact(*contact.problem);
}

/// Quantities of the iterate that its loads need: rotations, internal variables, the state halfway where an
/// element is asked there.
void IslandIteration::follow(const StepInput& in, Index component) {
  const Assembly& assembly = model_->assembly;
  const bool rotations = trial_->needs.load_rotations;
  if (rotations) evaluate_positions(assembly, component, trial_->end.view(), trial_->at_end);
  const Range z = assembly.components()[component].z;
  if (!z.empty()) {
    const ElementId failed = trial_->with_step(in, component, [&](const StepContext& at) {
      return advance_internals(assembly, component, at, trial_->end.z.data());
    });
    if (failed.valid()) model_->errors(in, component, *trial_).fail_internal(failed);
  }
  if (!(model_->rule.is_mean() || !z.empty()) || !uses_middle(assembly, component)) return;
  trial_->place_midpoint(in, component);
  located_->add_mean(in, component, *trial_);
  for (Index i = z.begin; i < z.end; ++i) trial_->midpoint.z[i] = 0.5 * (in.start.z[i] + trial_->end.z[i]);
  if (rotations) evaluate_positions(assembly, component, trial_->midpoint.view(), trial_->at_midpoint);
}

}  // namespace carom
