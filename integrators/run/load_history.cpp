// Problem: what the loads at the end of a step will be, by those of the last steps.

#include <carom/integrators/run/load_history.h>

#include <carom/core/numerics/pair.h>

#include <algorithm>
#include <cmath>
#include <limits>

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
  // Differences of changes and their sum stay within floats; what does not is guessed as it is now.
  constexpr double largest = std::numeric_limits<float>::max() / 8.0;
  float* const change = changes[0].data();
  Index i = v.begin;
  for (; i + 1 < v.end; i += 2) {
    const Pair exact = load_pair(now + i) - load_pair(then + i);
    store_pair(change + i, magnitude(exact) <= both(largest) ? exact : both(0.0));
  }
  for (; i < v.end; ++i) {
    const double exact = now[i] - then[i];
    change[i] = std::abs(exact) <= largest ? static_cast<float>(exact) : 0.0F;
  }
}

void LoadHistory::settle(const std::vector<double>& now) {
  if (pending && known > 0) record_change({0, static_cast<Index>(now.size())}, before.data(), now.data());
  pending = false;
  before.clear();
}

void LoadHistory::guess(Range v, double next_step, const double* now, double* guess) const {
  // Extrapolating far from two near values would magnify their rounding.
  constexpr double farthest = 10.0;
  const float* const first = changes[0].data();
  const float* const second = changes[1].data();
  const float* const third = changes[2].data();
  const bool linear = known > 0 && next_step <= farthest * step;
  const int order = next_step == step ? known : linear ? 1 : 0;
  const double ratio = order == 1 ? next_step / step : 1.0;
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

}  // namespace carom
