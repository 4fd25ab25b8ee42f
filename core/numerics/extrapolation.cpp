#include <carom/core/numerics/extrapolation.h>
#include <carom/core/numerics/pair.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace carom {

void record_change(Range range, const double* then, const double* now, float* change) {
  // Differences of changes and their sum stay within floats; what does not is guessed as it is now.
  constexpr double largest = std::numeric_limits<float>::max() / 8.0;
  Index i = range.begin;
  for (; i + 1 < range.end; i += 2) {
    const Pair exact = load_pair(now + i) - load_pair(then + i);
    store_pair(change + i, magnitude(exact) <= both(largest) ? exact : both(0.0));
  }
  for (; i < range.end; ++i) {
    const double exact = now[i] - then[i];
    change[i] = std::abs(exact) <= largest ? static_cast<float>(exact) : 0.0F;
  }
}

void extrapolate(Range range, const double* now, const LastChanges& changes, int order, double ratio,
                 double* guess) {
  const auto& [first, second, third] = changes;
  if (order == 3) {
    for (Index i = range.begin; i < range.end; ++i) {
      const float growth = first[i] - second[i];
      guess[i] = now[i] + static_cast<double>(first[i] + (growth + (growth - (second[i] - third[i]))));
    }
  } else if (order == 2) {
    for (Index i = range.begin; i < range.end; ++i) {
      guess[i] = now[i] + static_cast<double>(first[i] + (first[i] - second[i]));
    }
  } else if (order == 1) {
    for (Index i = range.begin; i < range.end; ++i) {
      guess[i] = now[i] + ratio * static_cast<double>(first[i]);
    }
  } else {
    std::copy(now + range.begin, now + range.end, guess + range.begin);
  }
}

}  // namespace carom
