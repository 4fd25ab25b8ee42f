#pragma once

/// \file
/// Friction in joints whose bounds follow from the forces in the joints, which follow from the friction: a
/// fixed point, by repetition.

#include <carom/core/export.h>
#include <carom/core/numerics/anderson.h>

#include <cstddef>
#include <limits>
#include <vector>

namespace carom {

/// Judges the repetitions, and where they converge slowly (long chains, large coefficients) guesses better
/// bounds. Allocates only then.
class CAROM_API BoundIteration {
public:
  /// Repetitions after which it is given up.
  static constexpr int most_repetitions = 200;

  /// Begins a repetition.
  void begin();
  /// Takes a bound before and after a repetition. Every repetition gives the same bounds in the same order.
  void add(double before, double after);
  /// True if there is no need to go on. \param change the largest, relative
  [[nodiscard]] bool converged(double change);
  /// True if the next repetition is to start from guess().
  [[nodiscard]] bool accelerates();
  /// The bounds to start from, >= 0, in the order of add().
  [[nodiscard]] double guess(std::size_t bound) const { return before_[bound] > 0.0 ? before_[bound] : 0.0; }

private:
  int repetitions_ = 0;
  double last_change_ = std::numeric_limits<double>::infinity();
  std::vector<double> before_, after_, ones_;
  AndersonAcceleration acceleration_;
};

}  // namespace carom
