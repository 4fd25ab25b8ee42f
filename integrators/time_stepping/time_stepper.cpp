// Problem: one step t_j -> t_{j+1} (Johansson 1999, section 4). Stages are named functions of a range and
// hand values on; `in` never changes, whatever is thrown, and the trial of a step that fails is asked for the
// cause.

#include <carom/integrators/time_stepping/time_stepper.h>

#include <algorithm>
#include <optional>

namespace carom {

TimeStepper::TimeStepper(const Assembly& assembly, const TimeStepping& options, const StopRequest* stop)
    : assembly_(&assembly),
      options_((check_options(options), options)),
      stop_(stop),
      rule_(options.force_rule),
      contacts_(assembly, options),
      prescribed_(assembly),
      trial_(assembly, step_needs(assembly, contacts_.detector(), rule_.is_mean())),
      schedule_(assembly, options, trial_.needs),
      joints_(assembly),
      iteration_(assembly),
      balance_(assembly, options),
      couplings_(assembly) {
  memory_.sweeps.resize(assembly.components().size());
  memory_.guesses = schedule_.any_iterated();
  memory_.mean = rule_.is_mean();
  iteration_.use(options.iteration);
}

void TimeStepper::step(State& state, Companion& companion, double step, double end_time, StepReport& report) {
  evaluate_start(state, companion);
  const StepInput in{*assembly_, state, companion, step, end_time};
  trial_.begin(in, companion.history);
  try {
    StepResult& result = make_step(in);
    contacts_.add_statistics(companion.contact_statistics);
    commit(in, memory_, trial_, result, state, companion, report);
  } catch (const SolverError& error) {
    trial_.give_back(in, companion.history);
    throw with_file(error, options_);
  } catch (...) {
    trial_.give_back(in, companion.history);
    throw;
  }
}

StepResult& TimeStepper::make_step(const StepInput& in) {
  prepare(in);
  contacts_.find(in, trial_);  // gaps <= 0, joint limits, dry friction, at t_j
  for (const StepIsland& island : contacts_.islands()) advance(island, in);
  return balance_.finish(in);  // works of what acted, records
}

/// Motions that are given, and rotations at the start.
void TimeStepper::prepare(const StepInput& in) {
  balance_.begin(in);
  memory_.iterations.clear();
  contacts_.forget_statistics();  // of a step that failed
  try {
    prescribed_.demand_continuous(in.start.time, in.end_time);
    contacts_.place_surfaces(in);
  } catch (const SolverError& error) {
    fail_motion(error, in);
  }
  for (Index component = 0; trial_.needs.start_rotations && component < assembly_->components().size();
       ++component) {
    evaluate_positions(*assembly_, component, in.start.view(), trial_.at_start);
  }
}

void TimeStepper::advance(const StepIsland& island, const StepInput& in) {
  FixedPointJudge judge(options_.tolerance, options_.max_sweeps);
  const bool automatic = options_.iteration == Iteration::automatic;
  if (has_constant_loads(island)) {
    if (automatic) iteration_.use(Iteration::fixed_point);
    advance_under_constant_loads(island, in);
    static_cast<void>(judge.judge(0.0, 0.0));
  } else if (automatic) {
    iterate_automatically(island, in, judge);
  } else {
    book(island, in, iterate(island, in, judge));
  }
  StepReport& report = balance_.report();
  for (const Index component : island.components) {
    couplings_.rate(in, component, judge.contraction(), trial_, report);
  }
  report.iteration = std::max(report.iteration, iteration_.current());
  report.sweeps = std::max(report.sweeps, judge.sweeps());
  report.contraction = std::max(report.contraction, judge.contraction());
}

/// One iteration after the other, each stronger than the one before; behind the last the first is as good as
/// another. The error of the fixed-point iteration says most.
void TimeStepper::iterate_automatically(const StepIsland& island, const StepInput& in,
                                        FixedPointJudge& judge) {
  const Index first_component = island.components.front();
  const auto first = static_cast<std::size_t>(in.companion.iterations.first(first_component));
  std::optional<SolverError> failed;
  // Islands of several components are swept.
  const std::size_t count = island.components.size() == 1 ? iteration_count : 1;
  for (std::size_t tried = 0; tried < count; ++tried) {
    const auto iteration = static_cast<Iteration>((first + tried) % count);
    iteration_.use(iteration);
    if (tried > 0) contacts_.restore(in, island, trial_);
    judge = FixedPointJudge(options_.tolerance, options_.max_sweeps);
    std::optional<LoadsKnown> known;
    try {
      known = iterate(island, in, judge);
    } catch (const SolverError& error) {
      // Iterates that grow may meet a contact problem without an answer, or loads that are not finite.
      if (!failed || iteration == Iteration::fixed_point) failed = error;
    }
    if (known) {
      for (const Index component : island.components) {
        memory_.iterations.record(in.companion.iterations, component, iteration);
      }
      balance_.report().fallbacks += static_cast<int>(tried);
      return book(island, in, *known);
    }
  }
  throw SolverError(*failed);
}

/// Sweeps until the next would change no more than the tolerance. Returns what is known of the loads then.
LoadsKnown TimeStepper::iterate(const StepIsland& island, const StepInput& in, FixedPointJudge& judge) {
  using Verdict = FixedPointJudge::Verdict;
  begin(island, in);
  const Index front = island.components.front();
  JointStage* const joints = joints_.of(front);
  const std::vector<int>& before = trial_.history.sweeps;
  const int expected = before.size() == memory_.sweeps.size() ? before[front] : 1;
  for (;;) {
    if (stop_ != nullptr) stop_->check();
    const SweepsMade made = is_streamed(island) ? sweep_streamed(stages(in, front), expected, judge)
                                                : sweep_staged(island, in, expected, judge);
    const SweepChange change = made.change;
    const bool ahead = joints == nullptr && !iteration_.is_newton();
    Verdict verdict =
        ahead ? judge.judge_ahead(change.change, change.size) : judge.judge(change.change, change.size);
    // Newton's first is that from t_j: small or not, it says nothing of the guess.
    if (iteration_.is_newton() && judge.sweeps() == 1 && verdict == Verdict::converged)
      verdict = Verdict::go_on;
    if (verdict == Verdict::failed) fail_contraction(island, in, judge);
    if (verdict == Verdict::converged || made.converged_one_early) {
      for (const Index component : island.components) {
        memory_.sweeps[component] = judge.sweeps() - (made.converged_one_early ? 1 : 0);
      }
      const bool moved = joints != nullptr && converge_joints(island, in);
      return moved ? LoadsKnown::total : made.known;
    }
    for (const Index component : island.components) {
      iteration_.improve(stages(in, component), schedule_, judge);
    }
  }
}

/// Contact problems, and a first guess at the loads.
void TimeStepper::begin(const StepIsland& island, const StepInput& in) {
  const Index front = island.components.front();
  JointStage* const joints = joints_.of(front);
  contacts_.state_problems(in, island, iteration_.is_newton() || joints != nullptr, trial_);
  trial_.swept = false;
  for (const Index component : island.components) {
    const Range z = assembly_->components()[component].z;
    std::copy(in.start.z.begin() + z.begin, in.start.z.begin() + z.end, trial_.end.z.begin() + z.begin);
  }
  JointContacts contacts = contacts_of(island);
  if (joints != nullptr) joints->start(in, contacts, trial_);
  iteration_.start(front);
  if (is_streamed(island)) {
    const int sweeps = schedule_.presolve(stages(in, front), iteration_.current(), options_.tolerance);
    balance_.report().local_sweeps = std::max(balance_.report().local_sweeps, sweeps);
  } else {
    for (const Index component : island.components) schedule_.guess(stages(in, component));
  }
  if (!iteration_.is_newton()) return;
  demand(iteration_.newton().start(in, rule_, front, joints, contacts.problem, trial_), front, in);
}

/// Bodies and loads block by block: the loads by cause, with potentials, cost more than their sum; they are
/// wanted of the last iterate only, which is expected after as many sweeps as in the last step.
TimeStepper::SweepsMade TimeStepper::sweep_streamed(const SweepStages& stages, int expected,
                                                    FixedPointJudge& judge) {
  using Verdict = FixedPointJudge::Verdict;
  SweepsMade made;
  const bool guessing = judge.sweeps() == 0;
  const bool fused =
      iteration_.current() == Iteration::fixed_point && schedule_.may_fuse(stages, judge.sweeps(), expected);
  made.known = fused || judge.sweeps() + 1 >= expected ? LoadsKnown::by_cause : LoadsKnown::total;
  if (fused) {
    schedule_.fuse(stages, guessing);
  } else {
    schedule_.stream(stages, guessing, made.known);
  }
  if (const IslandProblem* const failed = contacts_.first_unsolved()) {
    errors(stages.in, stages.component).fail_contact(*failed);
  }
  if (fused) {
    const SweepChange earlier = schedule_.earlier_change(stages);
    const Verdict verdict = judge.judge_ahead(earlier.change, earlier.size);
    if (verdict == Verdict::failed) {
      errors(stages.in, stages.component)
          .fail_contraction(judge, iteration_.current(), nullptr, contacts_.problems());
    }
    made.converged_one_early = verdict == Verdict::converged;
  }
  made.change = schedule_.change(stages);
  return made;
}

/// Stage by stage over all components of the island: impulses, bodies, and the loads that they lead to.
TimeStepper::SweepsMade TimeStepper::sweep_staged(const StepIsland& island, const StepInput& in, int expected,
                                                  const FixedPointJudge& judge) {
  const Index front = island.components.front();
  const bool newton = iteration_.is_newton(), alone = island.components.size() == 1;
  JointStage* const joints = joints_.of(front);
  SweepsMade made;
  made.known = alone && judge.sweeps() + 1 >= expected ? LoadsKnown::by_cause : LoadsKnown::total;
  JointContacts contacts = contacts_of(island);
  if (joints != nullptr) {
    if (newton) {
      demand(iteration_.newton().step_with_joints(in, rule_, front, *joints, contacts.problem, contacts.chain,
                                                  trial_),
             front, in);
    }
    sweep_joints(in, front, *joints, contacts);
  } else {
    if (newton) {
      demand(iteration_.newton().step(in, rule_, front, contacts.problem, contacts.chain, trial_), front, in);
    } else if (const IslandProblem* const failed = contacts_.solve(in, rule_, trial_)) {
      errors(in, front).fail_contact(*failed);
    }
    for (const Index component : island.components) schedule_.move(stages(in, component));
    trial_.swept = true;
  }
  for (const Index component : island.components) {
    follow(in, component);
    schedule_.evaluate(stages(in, component), made.known, !newton);
    made.change.take(newton ? iteration_.newton().change(in, component, trial_)
                            : schedule_.change(stages(in, component)));
  }
  if (joints == nullptr) return made;
  made.change.take(joints->change(in, trial_));
  made.change.size *= joints->rows().roundoff_growth();
  return made;
}

void TimeStepper::sweep_joints(const StepInput& in, Index component, JointStage& joints,
                               JointContacts& contacts) {
  if (joints.sweep(in, rule_, contacts, trial_)) return;
  errors(in, component).fail_contact(*contacts.problem);
}

/// What follows from the iterate before its loads: rotations, internal variables, the state halfway where
/// it is looked at.
void TimeStepper::follow(const StepInput& in, Index component) {
  const Assembly& assembly = *assembly_;
  const bool rotations = trial_.needs.load_rotations;
  if (rotations) evaluate_positions(assembly, component, trial_.end.view(), trial_.at_end);
  const Range z = assembly.components()[component].z;
  if (!z.empty()) {
    const ElementId failed = trial_.with_step(in, component, [&](const StepContext& at) {
      return advance_internals(assembly, component, at, trial_.end.z.data());
    });
    if (failed.valid()) errors(in, component).fail_internal(failed);
  }
  if (!(rule_.is_mean() || !z.empty()) || !uses_middle(assembly, component)) return;
  trial_.place_midpoint(in, component);
  for (Index i = z.begin; i < z.end; ++i) trial_.midpoint.z[i] = 0.5 * (in.start.z[i] + trial_.end.z[i]);
  if (rotations) evaluate_positions(assembly, component, trial_.midpoint.view(), trial_.at_midpoint);
}

/// A change below the tolerance may leave the constraints above their rounding. Sweeps under the same loads
/// bring the joints there however badly couplings contract. True if there were any.
bool TimeStepper::converge_joints(const StepIsland& island, const StepInput& in) {
  constexpr double improved = 0.8;
  const Index component = island.components.front();
  JointStage& joints = *joints_.of(component);
  JointContacts contacts = contacts_of(island);
  double left = joints.violation(in, trial_);
  if (!joints.rows().is_near_singular() && !(left > 1.0)) return false;
  for (int sweeps = 0; sweeps < options_.max_sweeps && left > 1.0; ++sweeps) {
    sweep_joints(in, component, joints, contacts);
    const double now = joints.violation(in, trial_);
    if (!(now < improved * left)) break;
    left = now;
  }
  if (joints.rows().is_near_singular()) joints.settle_velocities(in, trial_);
  follow(in, component);
  return true;
}

/// The step whose loads at its end are those at its start, of which none is dissipative or external.
void TimeStepper::advance_under_constant_loads(const StepIsland& island, const StepInput& in) {
  contacts_.state_problems(in, island, false, trial_);
  const std::vector<double>& loads = in.companion.loads.total;
  for (const Index component : island.components) {
    const Range v = assembly_->components()[component].v;
    std::copy(loads.begin() + v.begin, loads.begin() + v.end, trial_.loads_guess.begin() + v.begin);
    std::copy(loads.begin() + v.begin, loads.begin() + v.end, trial_.loads_end.total.begin() + v.begin);
    memory_.sweeps[component] = 1;
  }
  if (const IslandProblem* const failed = contacts_.solve(in, rule_, trial_)) {
    errors(in, island.components.front()).fail_contact(*failed);
  }
  for (const Index component : island.components) schedule_.move(stages(in, component));
  trial_.swept = true;
  book(island, in, LoadsKnown::total);
}

/// Books the island, and moves its bodies out of ground shapes where that is asked for.
void TimeStepper::book(const StepIsland& island, const StepInput& in, LoadsKnown known) {
  for (const Index component : island.components) {
    const SweepStages at = stages(in, component);
    if (has_constant_loads(island)) {
      trial_.energies = {};
      add_potentials(*assembly_, component, trial_.end.view(), trial_.at_end, trial_.energies);
      schedule_.finish_constant(at);
    } else if (known == LoadsKnown::total) {
      schedule_.evaluate(at, LoadsKnown::by_cause, false);
    }
    if (!balance_.book_couplings(in, component, trial_)) errors(in, component).fail_account();
    if (JointStage* const joints = joints_.of(component)) {
      balance_.book_joints(in, component, *joints, contacts_of(island).problem, trial_);
    }
  }
  book_contacts(island, in);
  if (options_.project_gaps && !island.constraints.empty()) project_positions(island, in);
}

void TimeStepper::book_contacts(const StepIsland& island, const StepInput& in) {
  if (contacts_.problems().empty()) return;
  JointStage* const joints = joints_.of(island.components.front());
  const double* const after = joints != nullptr ? joints->velocities_of_contact(trial_) : trial_.end.v.data();
  for (const IslandProblem& problem : contacts_.problems()) {
    const double gain = balance_.book_contacts(problem, after, trial_);
    if (gain > 0.0 && options_.refuse_energy_gain) {
      errors(in, island.components.front()).refuse_gain(problem, gain);
    }
  }
}

/// Bodies of contacts that took part are moved by the smallest displacement, along their joints.
void TimeStepper::project_positions(const StepIsland& island, const StepInput& in) {
  const Assembly& assembly = *assembly_;
  for (const Index component : island.components) {
    evaluate_positions(assembly, component, trial_.end.view(), trial_.at_end);
    JointStage* const stage = joints_.of(component);
    JointConstraints none_there;
    JointConstraints& joints = stage != nullptr ? stage->rows().at_end() : none_there;
    const GapProjection::Result result =
        projection_.project(assembly, component, contacts_.detector(), contacts_.places_at_end(),
                            {island.constraints}, contacts_.chain(), trial_.end, trial_.at_end, joints);
    if (result.left != nullptr) errors(in, component).fail_projection(*result.left);
    if (!result.moved) continue;
    if (stage != nullptr) balance_.book_velocity_projection(stage->project_velocities(trial_));
    const StoredEnergies before = trial_.energies;
    if (rule_.is_mean()) {
      // The mean loads are those that acted.
      trial_.energies = {};
      add_potentials(assembly, component, trial_.end.view(), trial_.at_end, trial_.energies);
    } else {
      schedule_.evaluate(stages(in, component), LoadsKnown::by_cause, false);
    }
    balance_.book_projection(result, before, trial_);
  }
}

/// Loads at the start, where the last step did not leave them: a function of the state.
void TimeStepper::evaluate_start(const State& state, Companion& companion) {
  PresentLoads& loads = companion.loads;
  if (loads.valid && loads.mean == rule_.is_mean()) return;
  if (loads.valid) companion.history.known = 0;  // of the other rule
  LoadsAtEnd at;
  at.total.swap(loads.total);
  at.total.resize(trial_.end.v.size());
  at.dissipative.resize(trial_.needs.dissipative ? trial_.end.v.size() : 0);
  at.external.resize(trial_.needs.external ? trial_.end.v.size() : 0);
  for (Index component = 0; component < assembly_->components().size(); ++component) {
    evaluate_positions(*assembly_, component, state.view(), trial_.at_end);
    evaluate_loads(*assembly_, component, state.view(), trial_.at_end, at.by_cause());
    at.finish(assembly_->components()[component].v);
  }
  loads = {true, rule_.is_mean(), std::move(at.total), std::move(at.dissipative), std::move(at.external)};
}

SweepStages TimeStepper::stages(const StepInput& in, Index component) {
  return {in, rule_, component, contacts_, trial_, joints_.of(component) != nullptr};
}

JointContacts TimeStepper::contacts_of(const StepIsland& island) {
  IslandProblem* const problem = contacts_.problems().empty() ? nullptr : &contacts_.problems().front();
  return {contacts_.detector(), island.constraints, problem, contacts_.chain(), iteration_.is_newton()};
}

/// Nothing comes between the bodies of a block and their loads.
bool TimeStepper::is_streamed(const StepIsland& island) const {
  return island.components.size() == 1 && !iteration_.is_newton() && contacts_.by_block() &&
         schedule_.coupling(island.components.front()) == CouplingClass::streamable;
}

bool TimeStepper::has_constant_loads(const StepIsland& island) const {
  return std::all_of(island.components.begin(), island.components.end(), [this](Index component) {
    return schedule_.coupling(component) == CouplingClass::constant_loads;
  });
}

StepErrors TimeStepper::errors(const StepInput& in, Index component) {
  return {in, component, contacts_.detector(), options_, trial_};
}

/// Newton's method went on, or says why not.
void TimeStepper::demand(NewtonIteration::Outcome outcome, Index component, const StepInput& in) {
  if (outcome == NewtonIteration::Outcome::singular) errors(in, component).fail_linearisation();
  if (outcome == NewtonIteration::Outcome::unsolved) {
    errors(in, component).fail_contact(contacts_.problems().front());
  }
}

void TimeStepper::fail_contraction(const StepIsland& island, const StepInput& in,
                                   const FixedPointJudge& judge) {
  const Index component = island.components.front();
  errors(in, component)
      .fail_contraction(judge, iteration_.current(), joints_.of(component), contacts_.problems());
}

}  // namespace carom
