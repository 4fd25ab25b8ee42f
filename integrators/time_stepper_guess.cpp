// Problem: what the loads at the end of a step will be, by those of the last steps; nothing to guess where
// they never change.

#include <carom/core/pair.h>
#include <carom/integrators/time_stepper.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace carom {

void TimeStepper::guess_loads(Index island, const Companion& companion, double step) {
  for_blocks(island, [&](const Block& block, Index) { guess_loads(block, companion, step); });
}

/// Loads at the end by the polynomial through those of the last steps.
void TimeStepper::guess_loads(const Block& block, const Companion& companion, double step) {
  // Extrapolating far from two near values would magnify their rounding.
  constexpr double farthest = 10.0;
  const double* const now = companion.loads.total.data();
  const LoadHistory& history = companion.history;
  double* const guess = evaluation_.force.data();
  const float* const first = history.changes[0].data();
  const float* const second = history.changes[1].data();
  const float* const third = history.changes[2].data();
  const bool linear = history.known > 0 && step <= farthest * history.step;
  const int order = step == history.step ? history.known : linear ? 1 : 0;
  const double ratio = order == 1 ? step / history.step : 1.0;
  const Range v = block.v;
  if (order == 3) {
    for (Index i = v.begin; i < v.end; ++i) {
      const float growth = first[i] - second[i];
      guess[i] = now[i] + static_cast<double>(first[i] + (growth + (growth - (second[i] - third[i]))));
    }
  } else if (order == 2) {
    for (Index i = v.begin; i < v.end; ++i) {
      guess[i] = now[i] + static_cast<double>(first[i] + (first[i] - second[i]));
    }
  } else if (order == 1) {
    for (Index i = v.begin; i < v.end; ++i) guess[i] = now[i] + ratio * static_cast<double>(first[i]);
  } else {
    std::copy(now + v.begin, now + v.end, guess + v.begin);
  }
}

/// The history of loads goes on by those at the end of the step.
void TimeStepper::remember_loads(Companion& companion) const {
  LoadHistory& history = companion.history;
  // Differences of changes and their sum stay within floats; what does not is guessed as it is now.
  constexpr double largest = std::numeric_limits<float>::max() / 8.0;
  history.known =
      history.known > 0 && history.step == report_.step ? std::min(history.known + 1, LoadHistory::most) : 1;
  history.step = report_.step;
  std::rotate(history.changes.begin(), history.changes.end() - 1, history.changes.end());
  if (history.changes[0].size() != evaluated_.size()) {
    for (auto& changes : history.changes) changes.resize(evaluated_.size());
  }
  const double* const now = companion.loads.total.data();
  const double* const then = evaluated_.data();
  float* const change = history.changes[0].data();
  for (Index island = 0; island < needed_sweeps_.size(); ++island) {
    if (needed_sweeps_[island] == Sweeps::unneeded) continue;  // it stays zero
    const Range v = assembly_->islands()[island].v;
    Index i = v.begin;
    for (; i + 1 < v.end; i += 2) {
      const Pair exact = load_pair(then + i) - load_pair(now + i);
      store_pair(change + i, magnitude(exact) <= both(largest) ? exact : both(0.0));
    }
    for (; i < v.end; ++i) {
      const double exact = then[i] - now[i];
      change[i] = std::abs(exact) <= largest ? static_cast<float>(exact) : 0.0F;
    }
  }
}

/// The step whose loads at its end are those at its start, of which none is dissipative or external.
void TimeStepper::advance_under_constant_loads(Index island, const State& state, const Companion& companion,
                                               double step) {
  const Range v = assembly_->islands()[island].v;
  const double* const loads = companion.loads.total.data();
  std::copy(loads + v.begin, loads + v.end, evaluation_.force.data() + v.begin);
  std::copy(loads + v.begin, loads + v.end, evaluated_.data() + v.begin);
  solve_contacts(island, state, companion, step);
  sweep(island, state, companion, step);
  evaluated_energies_ = {};
  add_potentials(*assembly_, island, trial_.view(), evaluation_, evaluated_energies_);
  for_blocks(island, [&](const Block& block, Index part) {
    works_[part] = works(island, block, state, companion, step);
  });
}

}  // namespace carom
