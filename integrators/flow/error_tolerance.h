#pragma once

/// \file
/// Error that a step of a flow may make in each unknown.

#include <carom/integrators/flow/flow.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

namespace carom {

/// Error of a place that is rounding of its coordinate, as part of it: a few operations.
inline constexpr double coordinate_rounding = 8.0 * std::numeric_limits<double>::epsilon();

/// Errors that a step of one problem may make: of a place y_i with the origin o_i (FlowProblem::origins())
///
///     relative |y_i - o_i| + absolute_i + coordinate_rounding |y_i|,
///
/// so that they are the same wherever the zero of coordinates is, and no smaller than rounding; of all other
/// unknowns  relative |y_i| + absolute_i.
class ErrorTolerance {
public:
  /// \param problem must not change its origins meanwhile \param relative tolerance, > 0
  ErrorTolerance(const FlowProblem& problem, double relative)
      : relative_(relative), absolute_(problem.absolute_tolerances()), origins_(problem.origins()) {}

  /// Error allowed of unknown i at a value.
  [[nodiscard]] double at(std::size_t i, double y) const {
    if (i >= origins_.size()) return relative_ * std::abs(y) + absolute_[i];
    return relative_ * std::abs(y - origins_[i]) + absolute_[i] + coordinate_rounding * std::abs(y);
  }
  /// Size of all unknowns against what is allowed of each, the largest. Places have no zero: if there are
  /// any, the size is that of an unknown much larger than its absolute tolerance.
  [[nodiscard]] double size(std::span<const double> y) const {
    double largest = origins_.empty() ? 0.0 : 1.0 / relative_;
    for (std::size_t i = origins_.size(); i < y.size(); ++i) {
      largest = std::max(largest, std::abs(y[i]) / at(i, y[i]));
    }
    return largest;
  }
  /// Largest of some changes of the unknowns at y, each against what is allowed.
  [[nodiscard]] double size(std::span<const double> changes, std::span<const double> y) const {
    double largest = 0.0;
    for (std::size_t i = 0; i < y.size(); ++i) {
      largest = std::max(largest, std::abs(changes[i]) / at(i, y[i]));
    }
    return largest;
  }

private:
  double relative_;
  std::span<const double> absolute_, origins_;
};

}  // namespace carom
