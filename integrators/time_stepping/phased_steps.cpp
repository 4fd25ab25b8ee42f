// Problem: a step in which nothing passes through anything, or bodies are hit when they meet.

#include <carom/core/run_error.h>
#include <carom/integrators/time_stepping/phased_steps.h>

#include <algorithm>
#include <utility>

namespace carom {

PhasedSteps::PhasedSteps(const Assembly& assembly, TimeStepper& stepper)
    : assembly_(&assembly),
      stepper_(&stepper),
      phases_(assembly, stepper),
      sets_(assembly, stepper.detector()),
      evaluation_(make_evaluation(assembly)),
      joined_(assembly) {}

void PhasedSteps::step(State& state, Companion& companion, double step, double end_time, StepReport& report) {
  const WholeStep whole{state.time, step, end_time};
  static_cast<void>(phases_.take_count());
  const std::span<const StepClosing> closings = phases_.try_whole(state, companion, whole);
  if (closings.empty()) {
    phases_.take_whole(state, companion, report);
  } else {
    closings_.assign(closings.begin(), closings.end());
    const std::size_t runs = make_sets(state, companion, whole);
    joined_.join(whole, std::span(runs_).first(runs), state, companion, report);
  }
  const auto bodies = static_cast<std::int64_t>(assembly_->layout()->bodies().size());
  report.steps_made = static_cast<int>((phases_.take_count() + bodies - 1) / bodies);
}

/// Makes the sets that have closings, and all others together, until none comes near another one. Returns the
/// number of runs.
std::size_t PhasedSteps::make_sets(const State& state, const Companion& companion, const WholeStep& whole) {
  boxes_.assign(stepper_->detector().outlines().of_bodies().list().size(), Box<2>::none());
  phases_.add_boxes_of_whole(boxes_);
  sets_.begin();
  sets_.join(stepper_->last().islands);
  static_cast<void>(sets_.join(boxes_));
  names_.clear();
  do {
    list_sets();
    for (std::size_t k = made_; k < names_.size() + rest(); ++k) make(runs_[k], state, companion, whole);
  } while (sets_.join(boxes_));
  return names_.size() + rest();
}

/// Lists the sets with closings: first those that were made and have not been joined to others since.
void PhasedSteps::list_sets() {
  const auto components = static_cast<Index>(assembly_->components().size());
  std::vector<Index>& sizes = numbers_.sizes;
  std::vector<Index>& run_of = numbers_.run_of;
  sizes.assign(components, 0);
  run_of.assign(components, none);
  for (Index component = 0; component < components; ++component) ++sizes[sets_.set_of(component)];
  std::size_t kept = 0;
  for (std::size_t k = 0; k < names_.size(); ++k) {
    const Index name = names_[k];
    if (sizes[name] != runs_[k].scope.components()) continue;  // it is part of a larger one now
    std::swap(runs_[kept], runs_[k]);
    run_of[name] = static_cast<Index>(kept);
    names_[kept++] = name;
  }
  names_.resize(kept);
  for (const StepClosing& closing : closings_) {
    const Index name = sets_.set_of_body(closing.body);
    if (run_of[name] != none) continue;
    run_of[name] = static_cast<Index>(names_.size());
    names_.push_back(name);
  }
  made_ = kept;
  const std::size_t all = names_.size() + 1;
  if (runs_.size() < all) runs_.resize(all);
  if (members_.size() < all) members_.resize(all);
  for (std::vector<Index>& members : members_) members.clear();
  for (Index component = 0; component < components; ++component) {
    const Index run = run_of[sets_.set_of(component)];
    members_[run == none ? all - 1 : run].push_back(component);
  }
  for (std::size_t k = kept; k < all; ++k)
    runs_[k].scope.assign(*assembly_, stepper_->batches(), members_[k]);
}

/// Brings a set to the start of the step, with a ledger and counts of its own.
void PhasedSteps::begin(SetRun& run, const State& state, const Companion& companion) {
  run.state = state;
  run.companion = companion;
  run.companion.statistics = {};
  run.companion.contact_statistics = {};
  StoredEnergies stored;
  run.scope.for_each([&](Index component) {
    evaluate_positions(*assembly_, component, state.view(), evaluation_);
    add_stored_energies(*assembly_, component, state.view(), evaluation_, stored);
  });
  run.companion.ledger.open(stored);
}

/// The first of the closings found on the way of a step in one phase that is of some set.
const StepClosing* PhasedSteps::first_of(const SetRun& run) {
  const StepClosing* first = nullptr;
  for (const StepClosing& closing : closings_) {
    if (run.scope.has(closing.body) && (first == nullptr || closing.time < first->time)) first = &closing;
  }
  return first;
}

void PhasedSteps::make(SetRun& run, const State& state, const Companion& companion, const WholeStep& whole) {
  const std::vector<BodyOutline>& outlines = stepper_->detector().outlines().of_bodies().list();
  const auto start_anew = [&] {
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
      if (run.scope.has(outlines[i].body)) boxes_[i] = Box<2>::none();
    }
    begin(run, state, companion);
  };
  start_anew();
  try {
    phases_.make(run, whole, first_of(run), SetPhases::Hits::end_phases, boxes_);
  } catch (const SolverError&) {
    const ImpactRules& rules = stepper_->options().impact_rules;
    if (rules.refuse_jams || rules.energy_gain == EnergyGain::refuse || phases_.had_too_many()) throw;
    start_anew();
    phases_.make(run, whole, nullptr, SetPhases::Hits::are_left_out, boxes_);
    if (run.report.energy_gain > run.report.lasting_gain) throw;  // an answer that is worse than none
  }
}

}  // namespace carom
