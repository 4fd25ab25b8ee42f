// Problem: one step t_j -> t_{j+1} (Johansson 1999, section 4). Stages are named functions of a range and
// hand values on; `in` never changes, whatever is thrown, and the trial of a step that fails is asked for the
// cause. From here: steps of one sweep are constant_steps.cpp, the iteration is island_iteration.cpp, the law
// of contact and impact contact/island_problem.cpp, its solvers contact/solvers/solver_chain.cpp and those
// that it calls.

#include <carom/integrators/time_stepping/far_turn.h>
#include <carom/integrators/time_stepping/gap_rounding.h>
#include <carom/integrators/time_stepping/time_stepper.h>

#include <algorithm>
#include <optional>

namespace carom {

namespace {

/// Loads at the start, where the last step did not leave them: a function of the state.
void evaluate_start(StepParts& parts, const State& state, Companion& companion,
                    std::span<const Range> batches) {
  PresentLoads& loads = companion.loads;
  if (loads.valid) companion.history.known = 0;  // of the other rule
  LoadsAtEnd at;
  at.total.swap(loads.total);
  at.total.resize(parts.trial.end.v.size());
  at.dissipative.resize(parts.trial.needs.dissipative ? parts.trial.end.v.size() : 0);
  at.external.resize(parts.trial.needs.external ? parts.trial.end.v.size() : 0);
  for (const Range batch : batches) {
    for (Index component = batch.begin; component < batch.end; ++component) {
      evaluate_positions(*parts.assembly, component, state.view(), parts.trial.at_end);
      evaluate_loads(*parts.assembly, component, state.view(), parts.trial.at_end, at.by_cause());
      at.finish(parts.assembly->components()[component].v);
    }
  }
  loads = {true, parts.rule.is_mean(), std::move(at.total), std::move(at.dissipative),
           std::move(at.external)};
}

}  // namespace

TimeStepper::TimeStepper(const Assembly& assembly, const TimeStepping& options, const StopRequest* stop)
    : parts_(assembly, (check_options(options), options)),
      impacts_(std::make_unique<StepImpacts>(parts_)),
      prescribed_(assembly),
      iteration_(parts_, stop),
      balance_(assembly, options),
      projection_(parts_),
      couplings_(assembly),
      capped_(options.failure_directory) {
  if (!impacts_->on()) impacts_.reset();
  if (parts_.ends_at_closings())
    turning_ =
        std::make_unique<ContactTurning>(assembly, detector(), parts_.joints, turning_rounding(options));
  if (impacts_ == nullptr && turning_ == nullptr && !options.project_gaps) {
    parts_.constraints.allow_parts(SweepSchedule::piece_size);
    if (UncoupledStep::fits(parts_)) uncoupled_.emplace(parts_);
  }
  memory_.joints = &parts_.joints;
  memory_.guesses = parts_.schedule.any_iterated();
  memory_.mean = parts_.rule.is_mean();
}

bool TimeStepper::step(State& state, Companion& companion, double step, double end_time, StepReport& report,
                       const StepPart& part) {
  const bool known = companion.loads.valid && companion.loads.mean == parts_.rule.is_mean();
  const StepInput in{*parts_.assembly, state, companion, step, end_time, companion.history.step, part};
  if (!known) evaluate_start(parts_, state, companion, parts_.batches(in));
  try {
    parts_.flights.clear();
    flown_ = uncoupled_ ? uncoupled_->fly(in, state, companion, report) : Flight::not_free;
    if (flown_ == Flight::made) return true;
    if (!in.part.repeats) struck_ = impacts_ != nullptr && strike(in);
  } catch (const RunError& error) {
    throw with_file(with_place(error, in), parts_.options);
  }
  if (!struck_) return step_from(in, state, companion, report);
  companion.history.settle(companion.loads.total);  // the jump of the loads is none of the last step
  std::swap(companion.loads, loads_before_);
  companion.loads.valid = false;
  try {
    evaluate_start(parts_, impacts_->start(), companion, parts_.batches(in));
    const StepInput behind{*parts_.assembly, impacts_->start(), companion, step,
                           end_time,         in.last_step,      part};
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
  parts_.constraints.find(in, parts_.batches(in), parts_.trial);
  return impacts_->resolve(in);
}

/// False if StepPart::stops has ended the step. \param in the step, whose start is the state, or that after
/// impacts
bool TimeStepper::step_from(const StepInput& in, State& state, Companion& companion, StepReport& report) {
  if (in.part.scope != nullptr) parts_.trial.stand_still(in.start);
  if (memory_.guesses) {
    parts_.trial.begin(in, companion.history);
  } else {
    parts_.trial.begin(in);
  }
  try {
    StepResult* const made = uncoupled_ ? &make_uncoupled_step(in) : make_step(in);
    if (made == nullptr) {
      give_up(in, companion);
      return false;
    }
    const double gain = balance_.unexplained_gain(in);
    if (gain > 0.0 && moves_far(in, parts_.trial.end)) parts_.errors(in, 0).fail_gain(gain);
    parts_.contacts.add_statistics(companion.contact_statistics);
    if (parts_.located.on()) parts_.located.add_statistics(companion.contact_statistics);
    memory_.sweeps = iteration_.sweeps();
    commit(in, memory_, parts_.trial, *made, state, companion, report);
    capped_.write(report.capped_problem);
    return true;
  } catch (const RunError& error) {
    give_up(in, companion);
    throw with_file(with_place(error, in), parts_.options);
  } catch (...) {
    give_up(in, companion);
    throw;
  }
}

/// Leaves nothing of a step that failed to the next.
void TimeStepper::give_up(const StepInput& in, Companion& companion) {
  if (memory_.guesses) parts_.trial.give_back(in, companion.history);
  parts_.contacts.forget_statistics();
  parts_.located.forget_statistics();
}

/// Null if StepPart::stops has ended the step.
StepResult* TimeStepper::make_step(const StepInput& in) {
  prepare(in);
  // gaps <= 0, joint limits, dry friction, at t_j
  parts_.constraints.find(in, parts_.batches(in), parts_.trial, parts_.parting());
  const std::span<const StepIsland> islands = parts_.constraints.islands();
  if (impacts_ != nullptr) StepImpacts::remove_restitution(islands);
  projection_.lower_rebounds(in, islands);
  if (turning_ != nullptr) {
    turning_->begin(islands, in.step, parts_.located.on());
    turning_->predict(in, parts_.trial, islands);
    parts_.contacts.begin_passes(in.part.repeats);
  }
  advance_all(in);
  passes_ = 1;
  while (turning_ != nullptr && turning_->turn(in, parts_.trial, islands, parts_.tolerance(in),
                                               balance_.result().tally.worst_residual)) {
    if (passes_ == 1 && in.part.stops && in.part.stops(parts_.trial.end, balance_.result().contact_modes))
      return nullptr;
    ++passes_;
    parts_.contacts.begin_next_pass();
    try {
      advance_all(in);
    } catch (const RunError&) {
      turning_->give_up(islands);
      parts_.contacts.begin_passes(false);
      advance_all(in);
      break;
    }
  }
  return &balance_.finish(in);  // works of what acted, records
}

/// Of all islands, from the start of the step.
void TimeStepper::advance_all(const StepInput& in) {
  balance_.begin(in);
  balance_.use_jumps(parts_.constraints.jumps_within(in.start.time, in.end_time));
  capped_.begin();
  parts_.flights.clear();  // of a step that is made again
  memory_.iterations.clear();
  projection_.begin();
  if (impacts_ != nullptr && struck_) balance_.add(impacts_->result());
  for (const StepIsland& island : parts_.constraints.islands()) advance(island, in);
}

/// Motions that are given, and rotations at the start.
void TimeStepper::prepare(const StepInput& in) {
  prescribed_.demand_continuous(in.start.time, in.end_time);
  parts_.constraints.place_surfaces(in);
  if (parts_.trial.needs.start_rotations)
    evaluate_positions(in.assembly, in.bodies(), in.start.view(), parts_.trial.at_start);
}

void TimeStepper::advance(const StepIsland& island, const StepInput& in) {
  const bool automatic = parts_.options.iteration == Iteration::automatic;
  StepReport& report = balance_.report();
  if (parts_.has_constant_loads(island)) {
    advance_under_constant_loads(island, in);
    report.sweeps = std::max(report.sweeps, 1);
    if (!automatic) report.iteration = std::max(report.iteration, parts_.options.iteration);
    return;
  }
  FixedPointJudge judge(parts_.tolerance(in), parts_.options.max_sweeps);
  if (automatic) {
    iterate_automatically(island, in, judge);
  } else {
    iteration_.use(parts_.options.iteration);
    book(island, in, iteration_.solve(island, in, judge));
  }
  for (const Index component : island.components) {
    couplings_.rate(in, component, judge.contraction(), parts_.trial, report);
  }
  report.iteration = std::max(report.iteration, iteration_.current());
  report.sweeps = std::max(report.sweeps, judge.sweeps());
  report.local_sweeps = std::max(report.local_sweeps, iteration_.take_local_sweeps());
  report.contraction = std::max(report.contraction, judge.contraction());
}

/// One iteration after the other over an island, each stronger than the one before; behind the last the first
/// is as good as another. The error of the fixed-point iteration says most.
void TimeStepper::iterate_automatically(const StepIsland& island, const StepInput& in,
                                        FixedPointJudge& judge) {
  const auto first = static_cast<std::size_t>(in.companion.iterations.first(island.components));
  ConstraintSet& kept = parts_.constraints.kept();
  kept.assign(island.constraints);  // iterations change them
  std::optional<RunError> failed;
  for (std::size_t tried = 0; tried < iteration_count; ++tried) {
    const auto iteration = static_cast<Iteration>((first + tried) % iteration_count);
    if (tried > 0 && leads_astray(iteration, in, island.components, parts_.trial)) continue;
    iteration_.use(iteration);
    for (std::size_t c = 0; tried > 0 && c < kept.size(); ++c) island.constraints[c].take(kept[c]);
    judge = FixedPointJudge(parts_.tolerance(in), parts_.options.max_sweeps);
    std::optional<LoadsKnown> known;
    try {
      known = iteration_.solve(island, in, judge);
    } catch (const RunError& error) {
      // Iterates that grow may meet a contact problem without an answer, or loads that are not finite.
      if (!failed || iteration == Iteration::fixed_point) failed = error;
    }
    if (known) {
      for (const Index component : island.components) {
        if (parts_.schedule.coupling(component) == CouplingClass::constant_loads) continue;
        memory_.iterations.record(in.companion.iterations, component, iteration);
      }
      balance_.report().fallbacks += static_cast<int>(tried);
      return book(island, in, *known);
    }
  }
  throw RunError(*failed);
}

/// Books the island, and moves its bodies out of ground shapes where that is asked for.
void TimeStepper::book(const StepIsland& island, const StepInput& in, LoadsKnown known) {
  for (const Index component : island.components) {
    const SweepStages at = parts_.stages(in, component);
    if (known == LoadsKnown::total) parts_.schedule.evaluate(at, LoadsKnown::by_cause, false);
    if (!parts_.located.empty()) {
      parts_.located.correct_works(in, parts_.rule, at.bodies(), parts_.trial);
    }
    if (!balance_.book_couplings(in, component, parts_.trial))
      parts_.errors(in, component).fail_account({component, component + 1});
    if (JointStage* const joints = parts_.joints.of(component)) {
      balance_.book_joints(in, component, *joints, parts_.problem(), parts_.trial);
    }
  }
  book_contacts(island, in);
  if (parts_.options.project_gaps) projection_.apply(island, in, balance_);
}

void TimeStepper::book_contacts(const StepIsland& island, const StepInput& in) {
  const double* const after = parts_.contacts.problems().empty()
                                  ? parts_.trial.end.v.data()
                                  : parts_.joints.velocities_of_contact(island.components, parts_.trial);
  const bool all = parts_.located.empty();
  for (const IslandProblem& problem : parts_.contacts.problems()) {
    const Index body = problem.constraints().front().body();
    if (!all && parts_.located.contains_any({body, body + 1})) continue;
    book_contact_problem(problem, after, in.end_time, in);
    if (turning_ != nullptr) balance_.book_turning(turning_->work(problem));
  }
  if (!all) book_located({0, none}, in);
}

/// Books impacts and contacts of those of some bodies that are hit within the step, in their order.
void TimeStepper::book_located(Range bodies, const StepInput& in) {
  const double* const after = parts_.trial.end.v.data();
  for (const LocatedMotion* motion : parts_.located.motions_of(bodies)) {
    parts_.flights.add(in, *motion);
    for (const MotionPhase& phase : motion->phases()) {
      motion->show_end(in, phase, parts_.trial);
      if (phase.constraints.empty()) continue;
      const double begin = in.start.time + phase.begin * in.step;
      const double time = phase.end < 1.0 ? in.start.time + phase.end * in.step : in.end_time;
      balance_.use_jumps(phase.is_impact() ? std::span<const GroundJump>()
                                           : parts_.constraints.jumps_within(begin, time));
      book_contact_problem(phase.problem, after, time, in);
      if (phase.cut) balance_.tell_cut(phase.constraints.size());
      balance_.book_turning(phase.turning_work);
    }
  }
  balance_.use_jumps(parts_.constraints.jumps_within(in.start.time, in.end_time));
}

/// \param after velocities after it, as contact sees them \param time when it ends [s]
void TimeStepper::book_contact_problem(const IslandProblem& problem, const double* after, double time,
                                       const StepInput& in) {
  const double gain = balance_.book_contacts(problem, after, time, in, parts_.trial);
  const bool refused = gain > 0.0 && parts_.options.impact_rules.energy_gain == EnergyGain::refuse;
  const bool kept = capped_.wants(problem);
  if (!refused && !kept) return;
  const StepErrors errors = parts_.errors(in, problem);
  if (refused) errors.refuse_gain(problem, gain);
  capped_.keep(errors.failure_of(problem));
}

}  // namespace carom
