#pragma once

/// \file
/// Order of convergence of runs with decreasing steps to a reference.

#include <carom/core/energy_trace.h>
#include <carom/testing/verdict.h>

#include <functional>
#include <span>
#include <string>
#include <vector>

namespace carom::energy_test {

/// A trace that was made with a certain step.
struct RefinedTrace {
  double step = 0.0;  ///< [s]
  EnergyTrace trace{};
};

/// Runs `run` with each of the steps [s].
[[nodiscard]] std::vector<RefinedTrace> refine(const std::vector<double>& steps,
                                               const std::function<EnergyTrace(double step)>& run);

/// Slope of the least-squares line through (log size, log difference): the order. At least two, all > 0.
[[nodiscard]] double fitted_order(std::span<const double> sizes, std::span<const double> differences);

/// Largest difference of two traces over all rows and the named terms, each in parts of its scale in
/// `reference`. Throws ModelError as carom::compare(), and for a name that is no term, or is time or
/// a scale.
[[nodiscard]] double largest_difference(const EnergyTrace& trace, const EnergyTrace& reference,
                                        const std::vector<std::string>& terms);

/// Default terms for the comparison of two modes or two steps: those of the state. How losses are divided
/// among terms may depend on the mode.
[[nodiscard]] std::vector<std::string> compared_terms();

/// The differences of `traces` from `reference` shrink with at least the given order of the step, fitted by
/// least squares. Fails, too, where the order cannot be seen because all but one difference is within
/// rounding (1e3 eps of the scale). An impact is detected up to one step late, so that single differences
/// across impacts scatter: compare at times away from them, with several steps. Throws ModelError for fewer
/// than two traces, steps that are not finite, > 0 and decreasing, and as largest_difference().
[[nodiscard]] Verdict check_order_at_least(const std::vector<RefinedTrace>& traces, double order,
                                           const EnergyTrace& reference,
                                           const std::vector<std::string>& terms = compared_terms());

}  // namespace carom::energy_test
