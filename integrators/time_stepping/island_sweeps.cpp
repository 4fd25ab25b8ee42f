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
  const bool fused = method_.current() == Iteration::fixed_point &&
                     parts_->schedule.may_fuse(stages, judge.sweeps(), expected);
  made.known = fused || judge.sweeps() + 1 >= expected ? LoadsKnown::by_cause : LoadsKnown::total;
  if (fused) {
    parts_->schedule.fuse(stages, guessing);
  } else {
    parts_->schedule.stream(stages, guessing, made.known);
  }
  if (const IslandProblem* const failed = parts_->contacts.first_unsolved()) {
    parts_->errors(stages.in, stages.component).fail_contact(*failed);
  }
  if (fused) {
    const SweepChange earlier = parts_->schedule.earlier_change(stages);
    const Verdict verdict = judge.judge_ahead(earlier.change, earlier.size);
    if (verdict == Verdict::failed) {
      parts_->errors(stages.in, stages.component)
          .fail_contraction(judge, method_.current(),
                            {{&stages.component, 1}, parts_->joints, parts_->contacts.problems()});
    }
    made.converged_one_early = verdict == Verdict::converged;
  }
  made.change = parts_->schedule.change(stages);
  parts_->trial.account.swept = true;
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
    demand(method_.newton().step(in, parts_->rule, newton_island(island), parts_->trial), island, in);
  }
  if (joints_.any()) {
    sweep_joints(island, in);
  } else {
    const IslandProblem* const failed =
        newton ? nullptr : parts_->contacts.solve(in, parts_->rule, parts_->trial);
    if (failed != nullptr) parts_->errors(in, front).fail_contact(*failed);
    for (const Index component : island.components) parts_->schedule.move(parts_->stages(in, component));
    parts_->trial.account.swept = true;
  }
  for (const Index component : island.components) {
    follow(in, component);
    parts_->schedule.evaluate(parts_->stages(in, component), made.known, !newton);
    made.change.take(newton ? method_.newton().change(in, component, parts_->trial)
                            : parts_->schedule.change(parts_->stages(in, component)));
  }
  joints_.take_change(in, parts_->trial, made.change);
  return made;
}

void IslandIteration::sweep_joints(const StepIsland& island, const StepInput& in) {
  if (method_.is_newton() && method_.newton().follows_rows()) {
    return demand(
        method_.newton().sweep_untouched(in, parts_->rule, joints_.alone()->iterate(), parts_->trial), island,
        in);
  }
  const IslandContact contact = contact_of(island);
  if (joints_.sweep(in, parts_->rule, contact, parts_->trial)) return;
  parts_->errors(in, island.components.front()).fail_contact(*contact.problem);
}

/// Quantities of the iterate that its loads need: rotations, internal variables, the state halfway where an
/// element is asked there.
void IslandIteration::follow(const StepInput& in, Index component) {
  const Assembly& assembly = *parts_->assembly;
  const bool rotations = parts_->trial.needs.load_rotations;
  if (rotations) evaluate_positions(assembly, component, parts_->trial.end.view(), parts_->trial.at_end);
  const Range z = assembly.components()[component].z;
  if (!z.empty()) {
    const ElementId failed = parts_->trial.with_step(in, component, [&](const StepContext& at) {
      return advance_internals(assembly, component, at, parts_->trial.end.z.data());
    });
    if (failed.valid()) parts_->errors(in, component).fail_internal(failed);
  }
  if (!(parts_->rule.is_mean() || !z.empty()) || !uses_middle(assembly, component)) return;
  parts_->trial.place_midpoint(in, component);
  parts_->located.add_mean(in, component, parts_->trial);
  for (Index i = z.begin; i < z.end; ++i)
    parts_->trial.midpoint.z[i] = 0.5 * (in.start.z[i] + parts_->trial.end.z[i]);
  if (rotations)
    evaluate_positions(assembly, component, parts_->trial.midpoint.view(), parts_->trial.at_midpoint);
}

}  // namespace carom
