// Problem: what the loads at the end of a step will be, by those of the last steps; nothing to guess where
// they never change.

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
  const float* const first = history.first.data();
  const float* const second = history.second.data();
  const float* const third = history.third.data();
  const bool linear = history.known > 0 && step <= farthest * history.step;
  const int order = step == history.step ? history.known : linear ? 1 : 0;
  const double ratio = order == 1 ? step / history.step : 1.0;
  const Range v = block.v;
  if (order == 3) {
    for (Index i = v.begin; i < v.end; ++i) {
      guess[i] = now[i] + static_cast<double>(first[i] + (second[i] + third[i]));
    }
  } else if (order == 2) {
    for (Index i = v.begin; i < v.end; ++i) guess[i] = now[i] + static_cast<double>(first[i] + second[i]);
  } else if (order == 1) {
    for (Index i = v.begin; i < v.end; ++i) guess[i] = now[i] + ratio * static_cast<double>(first[i]);
  } else {
    std::copy(now + v.begin, now + v.end, guess + v.begin);
  }
}

/// The history of loads goes on by those at the end of the step.
void TimeStepper::remember_loads(Companion& companion) const {
  LoadHistory& history = companion.history;
  constexpr int most = 3;
  // Differences of differences and their sum stay within floats; what does not is guessed as it is now.
  constexpr double largest = std::numeric_limits<float>::max() / 8.0;
  history.known = history.known > 0 && history.step == report_.step ? std::min(history.known + 1, most) : 1;
  history.step = report_.step;
  if (history.first.size() != evaluated_.size()) {
    for (auto* const differences : {&history.first, &history.second, &history.third}) {
      differences->resize(evaluated_.size());
    }
  }
  const double* const now = companion.loads.total.data();
  const double* const then = evaluated_.data();
  float* const first = history.first.data();
  float* const second = history.second.data();
  float* const third = history.third.data();
  for (Index island = 0; island < needed_sweeps_.size(); ++island) {
    if (needed_sweeps_[island] == Sweeps::unneeded) continue;  // differences stay zero
    const Range v = assembly_->islands()[island].v;
    for (Index i = v.begin; i < v.end; ++i) {
      const double exact = then[i] - now[i];
      const auto change = std::abs(exact) <= largest ? static_cast<float>(exact) : 0.0F;
      const float change_of_first = change - first[i];
      third[i] = change_of_first - second[i];
      second[i] = change_of_first;
      first[i] = change;
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
