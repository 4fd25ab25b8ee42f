#pragma once

/// \file
/// Neumaier's compensated sum: the error does not grow with the number of terms.

#include <cmath>

namespace carom {

/// A running sum and its rounding error.
class CompensatedSum {
public:
  CompensatedSum() = default;
  /// A sum that starts at `value` with the compensation `correction`.
  explicit CompensatedSum(double value, double correction = 0.0) : sum_(value), correction_(correction) {}

  /// Adds a term.
  void add(double term) {
    const double total = sum_ + term;
    correction_ += std::abs(sum_) >= std::abs(term) ? (sum_ - total) + term : (term - total) + sum_;
    sum_ = total;
  }
  /// The sum.
  [[nodiscard]] double value() const { return sum_ + correction_; }
  /// The sum without its correction (for saving).
  [[nodiscard]] double raw() const { return sum_; }
  /// The rounding error so far (for saving).
  [[nodiscard]] double correction() const { return correction_; }

private:
  double sum_ = 0.0;
  double correction_ = 0.0;
};

}  // namespace carom
