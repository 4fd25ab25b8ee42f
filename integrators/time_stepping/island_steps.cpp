// Problem: advance an island by the iteration that leads to an answer, and book what it did.

#include <carom/integrators/time_stepping/island_steps.h>

#include <algorithm>
#include <optional>

namespace carom {

IslandSteps::IslandSteps(const StepModel& model, StepConstraints& constraints, StepTrial& trial,
                         const StopRequest* stop)
    : model_(&model),
      constraints_(&constraints),
      trial_(&trial),
      schedule_(model.assembly, model.options, model.batches.any_iterated()),
      contacts_(model.assembly, model.options),
      located_(model),
      joints_(model.assembly),
      iteration_(model, constraints, schedule_, contacts_, located_, joints_, trial, stop),
      books_(model, constraints, contacts_, located_, joints_, trial),
      projection_(model, joints_),
      couplings_(model.assembly) {
  memory_.joints = &joints_;
  memory_.guesses = model.batches.any_iterated();
  memory_.mean = model.rule.is_mean();
}

StepMemory& IslandSteps::memory() {
  memory_.sweeps = iteration_.sweeps();
  return memory_;
}

void IslandSteps::begin(const StepInput& in, const StepResult* impacts) {
  books_.begin(in, impacts);
  memory_.iterations.clear();
  projection_.begin();
}

void IslandSteps::advance(const StepIsland& island, const StepInput& in) {
  const bool automatic = model_->options.iteration == Iteration::automatic;
  StepReport& report = books_.balance().report();
  if (model_->batches.has_constant_loads(island)) {
    advance_under_constant_loads(island, in);
    report.sweeps = std::max(report.sweeps, 1);
    if (!automatic) report.iteration = std::max(report.iteration, model_->options.iteration);
    return;
  }
  FixedPointJudge judge(model_->tolerance(in), model_->options.max_sweeps);
  if (automatic) {
    iterate_automatically(island, in, judge);
  } else {
    iteration_.use(model_->options.iteration);
    book(island, in, iteration_.solve(island, in, judge));
  }
  for (const Index component : island.components)
    couplings_.rate(in, component, judge.contraction(), *trial_, report);
  report.iteration = std::max(report.iteration, iteration_.current());
  report.sweeps = std::max(report.sweeps, judge.sweeps());
  report.local_sweeps = std::max(report.local_sweeps, iteration_.take_local_sweeps());
  report.contraction = std::max(report.contraction, judge.contraction());
}

/// One iteration after the other over an island, each stronger than the one before; behind the last the first
/// is as good as another. The error of the fixed-point iteration says most.
void IslandSteps::iterate_automatically(const StepIsland& island, const StepInput& in,
                                        FixedPointJudge& judge) {
  const auto first = static_cast<std::size_t>(in.companion.iterations.first(island.components));
  ConstraintSet& kept = constraints_->kept();
  kept.assign(island.constraints);  // iterations change them
  std::optional<RunError> failed;
  for (std::size_t tried = 0; tried < iteration_count; ++tried) {
    const auto iteration = static_cast<Iteration>((first + tried) % iteration_count);
    if (tried > 0 && leads_astray(iteration, in, island.components, *trial_)) continue;
    iteration_.use(iteration);
    for (std::size_t c = 0; tried > 0 && c < kept.size(); ++c) island.constraints[c].take(kept[c]);
    judge = FixedPointJudge(model_->tolerance(in), model_->options.max_sweeps);
    std::optional<LoadsKnown> known;
    try {
      known = iteration_.solve(island, in, judge);
    } catch (const RunError& error) {
      // Iterates that grow may meet a contact problem without an answer, or loads that are not finite.
      if (!failed || iteration == Iteration::fixed_point) failed = error;
    }
    if (known) {
      for (const Index component : island.components) {
        if (model_->batches.coupling(component) == CouplingClass::constant_loads) continue;
        memory_.iterations.record(in.companion.iterations, component, iteration);
      }
      books_.balance().report().fallbacks += static_cast<int>(tried);
      return book(island, in, *known);
    }
  }
  throw RunError(*failed);
}

/// Books the island, and moves its bodies out of ground shapes where that is asked for.
void IslandSteps::book(const StepIsland& island, const StepInput& in, LoadsKnown known) {
  for (const Index component : island.components) {
    if (known == LoadsKnown::total)
      schedule_.evaluate(iteration_.sweep_of(in, component), LoadsKnown::by_cause, false);
    books_.book_component(in, component);
  }
  books_.book_contacts(island, in);
  move_apart(island, in);
}

void IslandSteps::move_apart(const StepIsland& island, const StepInput& in) {
  if (!model_->options.project_gaps) return;
  const std::span<const Index> moved =
      projection_.apply(island, in, constraints_->places(true), contacts_.chain(), *trial_, books_.balance());
  if (model_->rule.is_mean()) return;  // mean loads are those that acted
  for (const Index component : moved)
    schedule_.evaluate(iteration_.sweep_of(in, component), LoadsKnown::by_cause, false);
}

}  // namespace carom
