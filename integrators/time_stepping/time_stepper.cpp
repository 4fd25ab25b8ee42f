#include <carom/integrators/time_stepping/time_stepper.h>

#include <algorithm>
#include <utility>

namespace carom {

TimeStepper::TimeStepper(const Assembly& assembly, const TimeStepping& options, const StopRequest* stop)
    : assembly_(&assembly),
      options_(options),
      stop_(stop),
      workers_(std::max(options.threads, 1)),
      detector_(assembly),
      masses_(assembly),
      prescribed_(assembly),
      trial_(assembly.layout()),
      evaluation_(make_evaluation(assembly)) {
  check_options(options);
  const std::size_t size = assembly.layout()->v_size();
  start_.rotation.resize(assembly.layout()->rotation_size());
  for (const auto& kind : assembly.force_kinds()) {
    books_dissipative_ = books_dissipative_ || kind->books_dissipative();
    books_external_ = books_external_ || kind->books_external();
    loads_need_rotations_ = loads_need_rotations_ || kind->needs_rotations();
  }
  if (assembly.layout()->rotation_size() == 0) loads_need_rotations_ = false;  // none of particles
  contacts_need_rotations_ = detector_.needs_rotations();
  start_needs_rotations_ = contacts_need_rotations_ || loads_need_rotations_;
  if (books_dissipative_) dissipative_.resize(size);
  if (books_external_) external_.resize(size);
  rounding_.resize(size);
  ratings_.resize(assembly.components().size());
  rated_contraction_.assign(assembly.components().size(), -1.0);
  prepare_joints();
  classify_components();
  guesses_ = std::any_of(coupling_class_.begin(), coupling_class_.end(),
                         [](CouplingClass needed) { return needed != CouplingClass::constant_loads; });
  if (mean_rule() || assembly.layout()->z_size() > 0 || !joints_.empty()) {
    midpoint_ = State(assembly.layout());
    middle_evaluation_.rotation.resize(assembly.layout()->rotation_size());
  }
  recorded_.resize(assembly.blocks().size());
  sweeps_.resize(assembly.components().size());
  Index most_blocks = 1, most_runs = 1;
  for (const Component& component : assembly.components()) {
    most_blocks = std::max(most_blocks, component.blocks.size());
    most_runs = std::max(most_runs, component.runs.size());
  }
  chains_.resize(most_runs);
  block_clusters_.resize(most_blocks);
  settled_.resize(most_blocks);
  changes_.resize(most_blocks);
  earlier_changes_.resize(most_blocks);
  works_.resize(most_blocks);
  set_iteration(automatic() ? Iteration::fixed_point : options.iteration);
}

void TimeStepper::step(State& state, Companion& companion, double step, double end_time, StepReport& report) {
  trial_.time = end_time;
  flows_ = {};
  stored_ = {};
  coupling_work_ = {};
  energy_position_projection_ = 0.0;
  energy_velocity_projection_ = 0.0;
  report_.contacts.clear();
  report_.joint_impulses.clear();
  joint_friction_modes_.clear();
  report_.time = end_time;
  report_.step = step;
  report_.iteration = Iteration::fixed_point;
  report_.fallbacks = 0;
  report_.sweeps = 0;
  report_.local_sweeps = 0;
  report_.contraction = 0.0;
  report_.worst_coupling = {};
  report_.worst_coupling_rate = 0.0;
  report_.energy_gain = report_.lasting_gain = 0.0;
  report_.projected = 0.0;
  report_.control = {};
  if (detector_.has_moving_obstacles() || !prescribed_.empty()) place_obstacles(state, step, end_time);
  start_loads(state, companion);
  remember_contacts(companion, step);
  for (SolverChain& chain : chains_) {
    if (chain.statistics().problems > 0) chain.reset_statistics();  // of a step that failed
  }
  const auto components = static_cast<Index>(assembly_->components().size());
  iterations_.clear();
  open_history(companion);
  try {
    for (Index component = 0; component < components; ++component) {
      advance_component(component, state, companion, step);
    }
  } catch (...) {
    close_history(companion);
    throw;
  }
  commit(state, companion, end_time, report);
}

void TimeStepper::place_obstacles(const State& state, double step, double end_time) {
  try {
    prescribed_.demand_continuous(state.time, end_time);
    if (!detector_.has_moving_obstacles()) return;
    if (places_after_.time() == state.time) std::swap(places_, places_after_);
    detector_.place(state.time, places_);
    detector_.place(end_time, places_after_);
    detector_.demand_continuous(places_, places_after_);
  } catch (const SolverError& error) {
    fail_motion(error, state, step);
  }
}

void TimeStepper::advance_component(Index component, const State& state, const Companion& companion,
                                    double step) {
  if (start_needs_rotations_) evaluate_positions(*assembly_, component, state.view(), start_);
  FixedPointJudge judge(options_.tolerance, options_.max_sweeps);
  if (automatic()) iteration_ = Iteration::fixed_point;
  tentative_ = false;
  if (automatic() && coupling_class_[component] != CouplingClass::constant_loads) {
    iterate_somehow(component, state, companion, step, judge);
  } else {
    find_contacts(component, state);
    if (!iterate(component, state, companion, step, judge)) {
      fail_contraction(component, state, companion, step, judge);
    }
  }
  const bool with_joints = jointed(component);
  const double contraction = judge.contraction();

  book_couplings(component, state, step);
  if (with_joints) book_joints(component, state, step);
  book_contacts(component, state, step);
  if (options_.project_gaps) project(component, state, companion, step);
  rate(component, state, step, contraction);
  report_.iteration = std::max(report_.iteration, iteration_);
  report_.sweeps = std::max(report_.sweeps, judge.sweeps());
  report_.contraction = std::max(report_.contraction, contraction);
}

bool TimeStepper::iterate(Index component, const State& state, const Companion& companion, double step,
                          FixedPointJudge& judge) {
  using Verdict = FixedPointJudge::Verdict;
  if (coupling_class_[component] == CouplingClass::constant_loads) {
    advance_under_constant_loads(component, state, companion, step);
    sweeps_[component] = 1;
    return judge.judge(0.0, 0.0) == Verdict::converged;
  }
  const bool implicit = iteration_ == Iteration::linearly_implicit;
  const bool with_joints = jointed(component);
  start_iteration(component, state, step);
  if (is_streamable(component)) {
    presolve_around_contacts(component, state, companion, step);
  } else {
    guess_loads(component, companion, step);
  }
  if (implicit) start_implicit(component, state, companion, step);

  const std::vector<int>& before = history_->sweeps;
  const int expected = before.size() == sweeps_.size() ? before[component] : 1;
  for (;;) {
    if (stop_ != nullptr) stop_->check();
    SweepsMade made = sweep_on(component, state, companion, step, expected, judge);
    if (made == SweepsMade::failed) return false;
    // Newton's method has its own change: that of the loads is magnified where couplings are stiff.
    SweepChange change = implicit ? implicit_change(component, step) : largest(changes_, component);
    if (with_joints) {
      const SweepChange seen = joint_change(component, step);
      change.take(seen.change, seen.size);
      change.size *= joints_[component].roundoff_growth;
    }
    Verdict verdict = implicit || with_joints ? judge.judge(change.change, change.size)
                                              : judge.judge_ahead(change.change, change.size);
    // Its first is that from t_j: small or not, it says nothing of the guess.
    if (implicit && judge.sweeps() == 1 && verdict == Verdict::converged) verdict = Verdict::go_on;
    if (verdict == Verdict::failed) return false;
    if (verdict == Verdict::converged || made == SweepsMade::converged_one_early) {
      sweeps_[component] = judge.sweeps() - (made == SweepsMade::converged_one_early ? 1 : 0);
      if (with_joints && converge_joints(component, state, companion, step)) {
        follow_iterate(component, state, step);
        made = SweepsMade::total;
      }
      if (made == SweepsMade::total) {
        evaluate_iterate(component, state, companion, step, LoadsAsked::by_cause, false);
      }
      return true;
    }
    improve_guess(component, judge);
  }
}

/// Loads by cause, with potentials, cost more than their sum; they are wanted of the last iterate only, which
/// is expected after as many sweeps as in the last step.
TimeStepper::SweepsMade TimeStepper::sweep_on(Index component, const State& state, const Companion& companion,
                                              double step, int expected, FixedPointJudge& judge) {
  using Verdict = FixedPointJudge::Verdict;
  const bool guessing = judge.sweeps() == 0;
  const Index first_block = assembly_->components()[component].blocks.begin;
  const auto sweep_first = [&](const Block& block, Index part) {
    if (guessing && settled_[part] == 0) guess_block(first_block + part, companion, step);
    solve_contacts(component, block, part, state, companion, step);
    sweep(component, block, part, state, companion, step);
  };
  if (is_streamable(component) && iteration_ == Iteration::fixed_point &&
      assembly_->components()[component].blocks.size() > 1 && judge.sweeps() + 2 == expected) {
    sweep_fused(component, state, companion, step, sweep_first);
    demand_solved(component, state, companion, step, judge.sweeps() + 2);
    const SweepChange earlier = largest(earlier_changes_, component);
    switch (judge.judge_ahead(earlier.change, earlier.size)) {
      case Verdict::failed:
        return SweepsMade::failed;
      case Verdict::converged:
        return SweepsMade::converged_one_early;
      case Verdict::go_on:
        return SweepsMade::by_cause;
    }
  }
  BlockTask first;
  if (is_streamable(component)) {
    first = sweep_first;
  } else {
    sweep_all(component, state, companion, step);
    follow_iterate(component, state, step);
  }
  const bool by_cause = judge.sweeps() + 1 >= expected;
  const bool implicit = iteration_ == Iteration::linearly_implicit;
  evaluate_iterate(component, state, companion, step, by_cause ? LoadsAsked::by_cause : LoadsAsked::total,
                   !implicit, first);
  if (is_streamable(component)) demand_solved(component, state, companion, step, judge.sweeps() + 1);
  return by_cause ? SweepsMade::by_cause : SweepsMade::total;
}

void TimeStepper::start_iteration(Index component, const State& state, double step) {
  const Range v = assembly_->components()[component].v;
  const Range z = assembly_->components()[component].z;
  std::copy(state.z.begin() + z.begin, state.z.begin() + z.end, trial_.z.begin() + z.begin);
  swept_ = false;
  if (jointed(component)) start_joints(component, state, step);
  if (iteration_ == Iteration::anderson) anderson_.start(v.size());
}

void TimeStepper::classify_components() {
  const Assembly& assembly = *assembly_;
  coupling_class_.assign(assembly.components().size(), CouplingClass::iterated);
  if (options_.iteration == Iteration::linearly_implicit || mean_rule() || loads_need_rotations_) return;
  for (Index component = 0; component < assembly.components().size(); ++component) {
    if (jointed(component) || !assembly.components()[component].z.empty()) continue;
    coupling_class_[component] = CouplingClass::constant_loads;
    for (Index kind = 0; kind < assembly.force_kinds().size(); ++kind) {
      if (assembly.elements(component, kind).empty() || assembly.force_kinds()[kind]->is_constant()) continue;
      coupling_class_[component] = CouplingClass::streamable;
    }
  }
}

void TimeStepper::sweep_all(Index component, const State& state, const Companion& companion, double step) {
  const bool implicit = iteration_ == Iteration::linearly_implicit;
  if (jointed(component)) {
    if (implicit) guess_implicit(component, state, step);
    sweep_joints(component, state, companion, step);
    return;
  }
  if (implicit) {
    solve_implicit(component, state, step);
  } else {
    solve_contacts(component, state, companion, step);
  }
  sweep(component, state, companion, step);
}

/// What follows from the iterate before its loads: rotations, internal variables, the state halfway where
/// it is looked at.
void TimeStepper::follow_iterate(Index component, const State& state, double step) {
  const Assembly& assembly = *assembly_;
  if (loads_need_rotations_) evaluate_positions(assembly, component, trial_.view(), evaluation_);
  const Component& range = assembly.components()[component];
  if (!range.z.empty()) {
    const ElementId failed = with_step(component, state, step, [&](const StepContext& at) {
      return advance_internals(assembly, component, at, trial_.z.data());
    });
    if (failed.valid()) fail_internal(failed, state, step);
  }
  if (!(mean_rule() || !range.z.empty()) || !uses_middle(assembly, component)) return;
  place_middle(component, state, step);
  for (Index i = range.z.begin; i < range.z.end; ++i) midpoint_.z[i] = 0.5 * (state.z[i] + trial_.z[i]);
  if (loads_need_rotations_) evaluate_positions(assembly, component, midpoint_.view(), middle_evaluation_);
}

void TimeStepper::place_middle(Index component, const State& state, double step) {
  const Range v_range = assembly_->components()[component].v;
  midpoint_.time = state.time + 0.5 * step;
  for (Index i = v_range.begin; i < v_range.end; ++i) {
    midpoint_.v[i] = 0.5 * step * 0.5 * (state.v[i] + trial_.v[i]);
  }
  assembly_->for_bodies(component, [&](const BodyKind& kind, Range slots, Index q, Index v, Index) {
    kind.advance(slots, state.q.data() + q, midpoint_.v.data() + v, midpoint_.q.data() + q);
  });
  for (Index i = v_range.begin; i < v_range.end; ++i) midpoint_.v[i] = 0.5 * (state.v[i] + trial_.v[i]);
}

void TimeStepper::rate(Index component, const State& state, double step, double contraction) {
  // Rated once, and again when the iteration has come to contract twice as badly.
  constexpr double worsening = 2.0;
  if (rated_contraction_[component] < 0.0 || contraction > worsening * rated_contraction_[component]) {
    evaluate_positions(*assembly_, component, state.view(), evaluation_);
    ratings_[component] = rate_couplings(*assembly_, component, state.view(), evaluation_, step);
    rated_contraction_[component] = contraction;
  }
  if (ratings_[component].rate > report_.worst_coupling_rate) {
    report_.worst_coupling = ratings_[component].worst;
    report_.worst_coupling_rate = ratings_[component].rate;
  }
}

}  // namespace carom
