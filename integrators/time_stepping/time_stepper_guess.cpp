// Problem: loads at the end of a step that lead the iteration to begin near its end; nothing to guess where
// they never change.

#include <carom/integrators/time_stepping/time_stepper.h>

#include <algorithm>
#include <cstdint>

namespace carom {

void TimeStepper::guess_loads(Index component, const Companion& companion, double step) {
  const Index first = assembly_->components()[component].blocks.begin;
  for_blocks(component, [&](const Block&, Index part) { guess_block(first + part, companion, step); });
}

void TimeStepper::guess_block(Index block, const Companion& companion, double step) {
  const double* const now = companion.loads.total.data();
  const Range v = assembly_->blocks()[block].v;
  record_change(block, companion);
  history_->guess(v, step, now, evaluation_.force.data());
}

/// Nothing has been written over the loads at the start of the last step before those of a block are guessed.
void TimeStepper::record_change(Index block, const Companion& companion) {
  if (!history_->pending || recorded_[block] != 0) return;
  history_->record_change(assembly_->blocks()[block].v, loads_end_.data(), companion.loads.total.data());
  recorded_[block] = 1;
}

void TimeStepper::open_history(Companion& companion) {
  history_ = &companion.history;
  if (history_->known == 0) history_->pending = false;
  if (!history_->before.empty()) loads_end_.swap(history_->before);
  loads_end_.resize(trial_.v.size());
  if (history_->pending) std::fill(recorded_.begin(), recorded_.end(), std::uint8_t{0});
}

/// After a step that failed: the same history, with nothing pending.
void TimeStepper::close_history(const Companion& companion) {
  for (Index block = 0; block < recorded_.size(); ++block) record_change(block, companion);
  history_->pending = false;
  history_->before.clear();
}

/// The loads at the start are kept as those to which the next step compares its own.
void TimeStepper::remember_loads(Companion& companion) {
  companion.loads.total.swap(loads_end_);
  history_->sweeps = sweeps_;
  if (!guesses_) {
    history_->step = report_.step;
    return;
  }
  history_->go_on(report_.step, loads_end_.size());
  history_->before.swap(loads_end_);
}

/// The step whose loads at its end are those at its start, of which none is dissipative or external.
void TimeStepper::advance_under_constant_loads(Index component, const State& state,
                                               const Companion& companion, double step) {
  const Range v = assembly_->components()[component].v;
  const double* const loads = companion.loads.total.data();
  std::copy(loads + v.begin, loads + v.end, evaluation_.force.data() + v.begin);
  std::copy(loads + v.begin, loads + v.end, loads_end_.data() + v.begin);
  solve_contacts(component, state, companion, step);
  sweep(component, state, companion, step);
  evaluated_energies_ = {};
  add_potentials(*assembly_, component, trial_.view(), evaluation_, evaluated_energies_);
  for_blocks(component, [&](const Block& block, Index part) {
    works_[part] = works(component, block, state, companion, step);
  });
}

}  // namespace carom
