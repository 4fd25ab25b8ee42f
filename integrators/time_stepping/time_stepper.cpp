// Problem: one step t_j -> t_{j+1} (Johansson 1999, section 4). Stages are named functions of a range and
// hand values on; `in` never changes, whatever is thrown, and the trial of a step that fails is asked for the
// cause. From here: an island is advanced in island_steps.cpp, in one sweep in constant_steps.cpp; the
// iteration is island_iteration.cpp, the law of contact and impact contact/island_problem.cpp, its solvers
// contact/solvers/solver_chain.cpp and those that it calls.

#include <carom/integrators/time_stepping/far_turn.h>
#include <carom/integrators/time_stepping/gap_rounding.h>
#include <carom/integrators/time_stepping/time_stepper.h>

#include <utility>

namespace carom {

TimeStepper::TimeStepper(const Assembly& assembly, const TimeStepping& options, const StopRequest* stop)
    : constraints_(assembly, (check_options(options), options)),
      model_(assembly, options, constraints_.detector()),
      trial_(assembly, model_.needs),
      islands_(model_, constraints_, trial_, stop),
      impacts_(std::make_unique<StepImpacts>(model_)),
      prescribed_(assembly) {
  if (options.impacts == ImpactTimes::located)
    constraints_.allow_rounding(options.step, model_.ends_at_closings);
  if (!impacts_->on()) impacts_.reset();
  if (model_.ends_at_closings) {
    turning_ = std::make_unique<ContactTurning>(assembly, model_.detector, islands_.joints(),
                                                turning_rounding(options));
    islands_.books().use_turning(turning_.get());
  }
  if (impacts_ == nullptr && turning_ == nullptr && !options.project_gaps) {
    constraints_.allow_parts(SweepSchedule::piece_size);
    if (UncoupledStep::fits(model_))
      uncoupled_.emplace(model_, islands_.contacts(), trial_, constraints_.margin());
  }
}

/// Loads at the start, where the last step did not leave them: a function of the state.
void TimeStepper::evaluate_start(const StepInput& in, Companion& companion) {
  PresentLoads& loads = companion.loads;
  if (loads.valid) companion.history.known = 0;  // of the other rule
  const std::size_t size = trial_.end.v.size();
  LoadsAtEnd at;
  at.total.swap(loads.total);
  at.total.resize(size);
  at.dissipative.resize(trial_.needs.dissipative ? size : 0);
  at.external.resize(trial_.needs.external ? size : 0);
  for (const Range batch : batches_of(in)) {
    for (Index component = batch.begin; component < batch.end; ++component) {
      evaluate_positions(in.assembly, component, in.start.view(), trial_.at_end);
      evaluate_loads(in.assembly, component, in.start.view(), trial_.at_end, at.by_cause());
      at.finish(in.assembly.components()[component].v);
    }
  }
  loads = {true, model_.rule.is_mean(), std::move(at.total), std::move(at.dissipative),
           std::move(at.external)};
}

bool TimeStepper::step(State& state, Companion& companion, double step, double end_time, StepReport& report,
                       const StepPart& part) {
  const bool known = companion.loads.valid && companion.loads.mean == model_.rule.is_mean();
  const StepInput in{model_.assembly, state, companion, step, end_time, companion.history.step, part};
  if (!known) evaluate_start(in, companion);
  try {
    islands_.books().flights().clear();
    flown_ = uncoupled_ ? uncoupled_->fly(in, state, companion, report) : Flight::not_free;
    if (flown_ == Flight::made) return true;
    if (!in.part.repeats) struck_ = impacts_ != nullptr && strike(in);
  } catch (const RunError& error) {
    throw with_file(with_place(error, in), model_.options);
  }
  if (!struck_) return step_from(in, state, companion, report);
  companion.history.settle(companion.loads.total);  // the jump of the loads is none of the last step
  std::swap(companion.loads, loads_before_);
  companion.loads.valid = false;
  const StepInput behind{model_.assembly, impacts_->start(), companion, step, end_time, in.last_step, part};
  try {
    evaluate_start(behind, companion);
    if (!step_from(behind, state, companion, report)) {
      std::swap(companion.loads, loads_before_);
      return false;
    }
  } catch (...) {
    std::swap(companion.loads, loads_before_);
    throw;
  }
  companion.contact_statistics += impacts_->chain().statistics();
  return true;
}

/// Impacts at the start of the step. True if there were any.
bool TimeStepper::strike(const StepInput& in) {
  impacts_->chain().reset_statistics();
  prepare(in);
  constraints_.find(in, batches_of(in), trial_);
  return impacts_->resolve(in, constraints_.islands(), trial_);
}

/// False if StepPart::stops has ended the step. \param in the step, whose start is the state, or that after
/// impacts
bool TimeStepper::step_from(const StepInput& in, State& state, Companion& companion, StepReport& report) {
  if (in.part.scope != nullptr) trial_.stand_still(in.start);
  if (islands_.memory().guesses) {
    trial_.begin(in, companion.history);
  } else {
    trial_.begin(in);
  }
  try {
    if (!make_step(in)) {
      give_up(in, companion);
      return false;
    }
    StepBalance& balance = islands_.books().balance();
    StepResult& made = balance.finish(in);  // works of what acted, records
    const double gain = balance.unexplained_gain(in);
    if (gain > 0.0 && moves_far(in, trial_.end)) model_.errors(in, 0, trial_).fail_gain(gain);
    islands_.contacts().add_statistics(companion.contact_statistics);
    if (islands_.located().on()) islands_.located().add_statistics(companion.contact_statistics);
    commit(in, islands_.memory(), trial_, made, state, companion, report);
    islands_.books().write_capped_problem(report.capped_problem);
    return true;
  } catch (const RunError& error) {
    give_up(in, companion);
    throw with_file(with_place(error, in), model_.options);
  } catch (...) {
    give_up(in, companion);
    throw;
  }
}

/// Leaves nothing of a step that failed to the next.
void TimeStepper::give_up(const StepInput& in, Companion& companion) {
  if (islands_.memory().guesses) trial_.give_back(in, companion.history);
  islands_.contacts().forget_statistics();
  islands_.located().forget_statistics();
}

/// False if StepPart::stops has ended the step.
bool TimeStepper::make_step(const StepInput& in) {
  if (uncoupled_) {
    islands_.begin(in, nullptr);
    islands_.advance(*uncoupled_, flown_, in);
    return true;
  }
  prepare(in);
  constraints_.find(in, batches_of(in), trial_, model_.parting());  // gaps <= 0, joint limits, dry friction
  const std::span<const StepIsland> islands = constraints_.islands();
  if (impacts_ != nullptr) StepImpacts::remove_restitution(islands);
  islands_.projection().lower_rebounds(in, islands, trial_);
  if (turning_ != nullptr) {
    trial_.forget_impulses();  // those of earlier steps are none of the size of this one's
    const bool follows = islands_.located().on() && model_.options.iteration != Iteration::linearly_implicit;
    turning_->begin(islands, in.step, follows);
    turning_->predict(in, trial_, islands);
    islands_.contacts().begin_passes(in.part.repeats);
  }
  advance_all(in);
  passes_ = 1;
  const StepResult& made = islands_.books().balance().result();
  while (turning_ != nullptr &&
         turning_->turn(in, trial_, islands, model_.tolerance(in), made.tally.worst_residual)) {
    if (passes_ == 1 && in.part.stops && in.part.stops(trial_.end, made.contact_modes)) return false;
    ++passes_;
    islands_.contacts().begin_next_pass();
    try {
      advance_all(in);
    } catch (const RunError&) {
      turning_->give_up(islands);
      islands_.contacts().begin_passes(false);
      advance_all(in);
      break;
    }
  }
  return true;
}

/// Of all islands, from the start of the step.
void TimeStepper::advance_all(const StepInput& in) {
  islands_.begin(in, struck_ ? &impacts_->result() : nullptr);
  for (const StepIsland& island : constraints_.islands()) islands_.advance(island, in);
}

/// Motions that are given, and rotations at the start.
void TimeStepper::prepare(const StepInput& in) {
  prescribed_.demand_continuous(in.start.time, in.end_time);
  constraints_.place_surfaces(in);
  if (trial_.needs.start_rotations)
    evaluate_positions(in.assembly, in.bodies(), in.start.view(), trial_.at_start);
}

}  // namespace carom
