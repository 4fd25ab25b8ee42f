// Problem: what the loads at the end of a step will be, by those of the last steps.

#include <carom/core/numerics/extrapolation.h>
#include <carom/integrators/run/load_history.h>

#include <algorithm>

namespace carom {

void LoadHistory::go_on(double next_step, std::size_t size) {
  known = known > 0 && step == next_step ? std::min(known + 1, most) : 1;
  step = next_step;
  std::rotate(changes.begin(), changes.end() - 1, changes.end());
  if (changes[0].size() != size) {
    for (auto& numbers : changes) numbers.resize(size);
  }
  pending = true;
}

void LoadHistory::record_change(Range v, const double* then, const double* now) {
  carom::record_change(v, then, now, changes[0].data());
}

void LoadHistory::guess(Range v, double next_step, const double* now, double* guess) const {
  // Extrapolating far from two near values would magnify their rounding.
  constexpr double farthest = 10.0;
  const bool linear = known > 0 && next_step <= farthest * step;
  const int order = next_step == step ? known : linear ? 1 : 0;
  extrapolate(v, now, {changes[0].data(), changes[1].data(), changes[2].data()}, order,
              order == 1 ? next_step / step : 1.0, guess);
}

}  // namespace carom
