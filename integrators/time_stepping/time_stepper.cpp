#include <carom/integrators/time_stepping/time_stepper.h>

#include <algorithm>
#include <utility>

namespace carom {

TimeStepper::TimeStepper(const Assembly& assembly, const TimeStepping& options, const StopRequest* stop)
    : assembly_(&assembly),
      options_(options),
      stop_(stop),
      workers_(std::max(options.threads, 1)),
      finder_(assembly),
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
  contacts_need_rotations_ = finder_.needs_rotations();
  start_needs_rotations_ = contacts_need_rotations_ || loads_need_rotations_;
  if (books_dissipative_) dissipative_.resize(size);
  if (books_external_) external_.resize(size);
  rounding_.resize(size);
  ratings_.resize(assembly.islands().size());
  rated_contraction_.assign(assembly.islands().size(), -1.0);
  prepare_joints();
  sort_islands();
  guesses_ = std::any_of(needed_sweeps_.begin(), needed_sweeps_.end(),
                         [](Sweeps needed) { return needed != Sweeps::unneeded; });
  if (mean_rule() || assembly.layout()->z_size() > 0 || !joints_.empty()) {
    middle_ = State(assembly.layout());
    middle_evaluation_.rotation.resize(assembly.layout()->rotation_size());
  }
  taken_down_.resize(assembly.blocks().size());
  sweeps_.resize(assembly.islands().size());
  Index most_blocks = 1, most_runs = 1;
  for (const Island& island : assembly.islands()) {
    most_blocks = std::max(most_blocks, island.blocks.size());
    most_runs = std::max(most_runs, island.runs.size());
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
  projected_ = 0.0;
  held_ = 0.0;
  report_.contacts.clear();
  report_.joint_impulses.clear();
  rubbing_modes_.clear();
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
  if (finder_.has_moving_obstacles() || !prescribed_.empty()) place_obstacles(state, step, end_time);
  start_loads(state, companion);
  remember_contacts(companion, step);
  for (SolverChain& chain : chains_) {
    if (chain.statistics().problems > 0) chain.reset_statistics();  // of a step that failed
  }
  const auto islands = static_cast<Index>(assembly_->islands().size());
  iterations_.clear();
  open_history(companion);
  try {
    for (Index island = 0; island < islands; ++island) {
      advance_island(island, state, companion, step);
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
    if (!finder_.has_moving_obstacles()) return;
    if (places_after_.time() == state.time) std::swap(places_, places_after_);
    finder_.place(state.time, places_);
    finder_.place(end_time, places_after_);
    finder_.demand_continuous(places_, places_after_);
  } catch (const SolverError& error) {
    fail_motion(error, state, step);
  }
}

void TimeStepper::advance_island(Index island, const State& state, const Companion& companion, double step) {
  if (start_needs_rotations_) evaluate_positions(*assembly_, island, state.view(), start_);
  FixedPointJudge judge(options_.tolerance, options_.max_sweeps);
  if (automatic()) iteration_ = Iteration::fixed_point;
  tentative_ = false;
  if (automatic() && needed_sweeps_[island] != Sweeps::unneeded) {
    iterate_somehow(island, state, companion, step, judge);
  } else {
    find_contacts(island, state);
    if (!iterate(island, state, companion, step, judge)) {
      fail_contraction(island, state, companion, step, judge);
    }
  }
  const bool with_joints = jointed(island);
  const double contraction = judge.contraction();

  book_couplings(island, state, step);
  if (with_joints) book_joints(island, state, step);
  book_contacts(island, state, step);
  if (options_.project_gaps) project(island, state, companion, step);
  rate(island, state, step, contraction);
  report_.iteration = std::max(report_.iteration, iteration_);
  report_.sweeps = std::max(report_.sweeps, judge.sweeps());
  report_.contraction = std::max(report_.contraction, contraction);
}

bool TimeStepper::iterate(Index island, const State& state, const Companion& companion, double step,
                          FixedPointJudge& judge) {
  using Verdict = FixedPointJudge::Verdict;
  if (needed_sweeps_[island] == Sweeps::unneeded) {
    advance_under_constant_loads(island, state, companion, step);
    sweeps_[island] = 1;
    return judge.judge(0.0, 0.0) == Verdict::converged;
  }
  const bool implicit = iteration_ == Iteration::linearly_implicit;
  const bool with_joints = jointed(island);
  start_iteration(island, state, step);
  if (in_one_pass(island)) {
    settle_contacts(island, state, companion, step);
  } else {
    guess_loads(island, companion, step);
  }
  if (implicit) start_implicit(island, state, companion, step);

  const std::vector<int>& before = history_->sweeps;
  const int expected = before.size() == sweeps_.size() ? before[island] : 1;
  for (;;) {
    if (stop_ != nullptr) stop_->check();
    SweepsMade made = sweep_on(island, state, companion, step, expected, judge);
    if (made == SweepsMade::failed) return false;
    // Newton's method has its own change: that of the loads is magnified where couplings are stiff.
    SweepChange change = implicit ? implicit_change(island, step) : largest(changes_, island);
    if (with_joints) {
      const SweepChange seen = joint_change(island, step);
      change.take(seen.change, seen.size);
      change.size *= joints_[island].magnified;
    }
    Verdict verdict = implicit || with_joints ? judge.judge(change.change, change.size)
                                              : judge.judge_ahead(change.change, change.size);
    // Its first is that from t_j: small or not, it says nothing of the guess.
    if (implicit && judge.sweeps() == 1 && verdict == Verdict::converged) verdict = Verdict::go_on;
    if (verdict == Verdict::failed) return false;
    if (verdict == Verdict::converged || made == SweepsMade::one_too_many) {
      sweeps_[island] = judge.sweeps() - (made == SweepsMade::one_too_many ? 1 : 0);
      if (with_joints && settle_joints(island, state, companion, step)) {
        follow_iterate(island, state, step);
        made = SweepsMade::total;
      }
      if (made == SweepsMade::total) {
        evaluate_iterate(island, state, companion, step, LoadsAsked::by_cause, false);
      }
      return true;
    }
    improve_guess(island, judge);
  }
}

/// Loads by cause, with potentials, cost more than their sum; they are wanted of the last iterate only, which
/// is expected after as many sweeps as in the last step.
TimeStepper::SweepsMade TimeStepper::sweep_on(Index island, const State& state, const Companion& companion,
                                              double step, int expected, FixedPointJudge& judge) {
  using Verdict = FixedPointJudge::Verdict;
  const bool guessing = judge.sweeps() == 0;
  const Index first_block = assembly_->islands()[island].blocks.begin;
  const auto sweep_first = [&](const Block& block, Index part) {
    if (guessing && settled_[part] == 0) guess_block(first_block + part, companion, step);
    solve_contacts(island, block, part, state, companion, step);
    sweep(island, block, part, state, companion, step);
  };
  if (in_one_pass(island) && iteration_ == Iteration::fixed_point &&
      assembly_->islands()[island].blocks.size() > 1 && judge.sweeps() + 2 == expected) {
    sweep_twice(island, state, companion, step, sweep_first);
    demand_solved(island, state, companion, step, judge.sweeps() + 2);
    const SweepChange earlier = largest(earlier_changes_, island);
    switch (judge.judge_ahead(earlier.change, earlier.size)) {
      case Verdict::failed:
        return SweepsMade::failed;
      case Verdict::converged:
        return SweepsMade::one_too_many;
      case Verdict::go_on:
        return SweepsMade::by_cause;
    }
  }
  BlockTask first;
  if (in_one_pass(island)) {
    first = sweep_first;
  } else {
    sweep_all(island, state, companion, step);
    follow_iterate(island, state, step);
  }
  const bool by_cause = judge.sweeps() + 1 >= expected;
  const bool implicit = iteration_ == Iteration::linearly_implicit;
  evaluate_iterate(island, state, companion, step, by_cause ? LoadsAsked::by_cause : LoadsAsked::total,
                   !implicit, first);
  if (in_one_pass(island)) demand_solved(island, state, companion, step, judge.sweeps() + 1);
  return by_cause ? SweepsMade::by_cause : SweepsMade::total;
}

void TimeStepper::start_iteration(Index island, const State& state, double step) {
  const Range v = assembly_->islands()[island].v;
  const Range z = assembly_->islands()[island].z;
  std::copy(state.z.begin() + z.begin, state.z.begin() + z.end, trial_.z.begin() + z.begin);
  swept_ = false;
  if (jointed(island)) start_joints(island, state, step);
  if (iteration_ == Iteration::anderson) anderson_.start(v.size());
}

void TimeStepper::sort_islands() {
  const Assembly& assembly = *assembly_;
  needed_sweeps_.assign(assembly.islands().size(), Sweeps::several);
  if (options_.iteration == Iteration::linearly_implicit || mean_rule() || loads_need_rotations_) return;
  for (Index island = 0; island < assembly.islands().size(); ++island) {
    if (jointed(island) || !assembly.islands()[island].z.empty()) continue;
    needed_sweeps_[island] = Sweeps::unneeded;
    for (Index kind = 0; kind < assembly.force_kinds().size(); ++kind) {
      if (assembly.elements(island, kind).empty() || assembly.force_kinds()[kind]->is_constant()) continue;
      needed_sweeps_[island] = Sweeps::in_one_pass;
    }
  }
}

void TimeStepper::sweep_all(Index island, const State& state, const Companion& companion, double step) {
  const bool implicit = iteration_ == Iteration::linearly_implicit;
  if (jointed(island)) {
    if (implicit) guess_implicit(island, state, step);
    sweep_joints(island, state, companion, step);
    return;
  }
  if (implicit) {
    solve_implicit(island, state, step);
  } else {
    solve_contacts(island, state, companion, step);
  }
  sweep(island, state, companion, step);
}

/// What follows from the iterate before its loads: rotations, internal variables, the state halfway where
/// it is looked at.
void TimeStepper::follow_iterate(Index island, const State& state, double step) {
  const Assembly& assembly = *assembly_;
  if (loads_need_rotations_) evaluate_positions(assembly, island, trial_.view(), evaluation_);
  const Island& range = assembly.islands()[island];
  if (!range.z.empty()) {
    const ElementId failed = with_step(island, state, step, [&](const StepContext& at) {
      return advance_internals(assembly, island, at, trial_.z.data());
    });
    if (failed.valid()) fail_internal(failed, state, step);
  }
  if (!(mean_rule() || !range.z.empty()) || !uses_middle(assembly, island)) return;
  place_middle(island, state, step);
  for (Index i = range.z.begin; i < range.z.end; ++i) middle_.z[i] = 0.5 * (state.z[i] + trial_.z[i]);
  if (loads_need_rotations_) evaluate_positions(assembly, island, middle_.view(), middle_evaluation_);
}

void TimeStepper::place_middle(Index island, const State& state, double step) {
  const Range v_range = assembly_->islands()[island].v;
  middle_.time = state.time + 0.5 * step;
  for (Index i = v_range.begin; i < v_range.end; ++i) {
    middle_.v[i] = 0.5 * step * 0.5 * (state.v[i] + trial_.v[i]);
  }
  assembly_->for_bodies(island, [&](const BodyKind& kind, Range slots, Index q, Index v, Index) {
    kind.advance(slots, state.q.data() + q, middle_.v.data() + v, middle_.q.data() + q);
  });
  for (Index i = v_range.begin; i < v_range.end; ++i) middle_.v[i] = 0.5 * (state.v[i] + trial_.v[i]);
}

void TimeStepper::rate(Index island, const State& state, double step, double contraction) {
  // Rated once, and again when the iteration has come to contract twice as badly.
  constexpr double worsening = 2.0;
  if (rated_contraction_[island] < 0.0 || contraction > worsening * rated_contraction_[island]) {
    evaluate_positions(*assembly_, island, state.view(), evaluation_);
    ratings_[island] = rate_couplings(*assembly_, island, state.view(), evaluation_, step);
    rated_contraction_[island] = contraction;
  }
  if (ratings_[island].rate > report_.worst_coupling_rate) {
    report_.worst_coupling = ratings_[island].worst;
    report_.worst_coupling_rate = ratings_[island].rate;
  }
}

}  // namespace carom
