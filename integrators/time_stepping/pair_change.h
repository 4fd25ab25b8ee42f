#pragma once

/// \file
/// Change by a sweep, two numbers at a time.

#include <carom/core/numerics/pair.h>
#include <carom/integrators/time_stepping/step_rule.h>

namespace carom {

/// A SweepChange in the making.
class PairChange {
public:
  /// Takes two changes, and the numbers that they are changes of. A change that is no number is kept.
  void take(Pair difference, Pair number) {
    difference = magnitude(difference);
    change_ = larger(difference, change_);
    size_ = larger(magnitude(number), size_);
    // A maximum may drop what is no number, a sum keeps it.
    sum_ += difference;
  }
  /// Adds what was taken.
  void add_to(SweepChange& change) const {
    const double numbers = sum_[0] + sum_[1];
    for (int lane = 0; lane < 2; ++lane) {
      change.take(numbers != numbers ? numbers : change_[lane], numbers != numbers ? numbers : size_[lane]);
    }
  }

private:
  Pair change_{}, size_{}, sum_{};
};

}  // namespace carom
