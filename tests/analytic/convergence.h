#pragma once

// Orders of convergence, measured.

#include <carom/testing/refinement.h>

#include <cmath>
#include <cstddef>
#include <vector>

namespace analytic {

/// Slope of the least-squares line through (log size, log error).
inline double slope(const std::vector<double>& sizes, const std::vector<double>& errors) {
  return carom::energy_test::fitted_order(sizes, errors);
}

/// Order across impacts. An impact is noticed up to one step late, by a delay that depends on where the grid
/// of times happens to lie: single errors scatter between zero and their bound, only their mean is of order
/// one. So the step sizes come in bins, each spanning a factor of two; within a bin they are spread by the
/// golden ratio, so that the delays are spread evenly; the mean error of each bin stands against the mean
/// step of the bin, and a line is fitted to their logarithms. How far the scatter of the errors within the
/// bins leaves that slope open is its standard deviation: that of the mean of n errors is s/sqrt(n), with s
/// the standard deviation of error over step in the bin.
struct MeanOrder {
  double slope = 0.0;                 // of log(mean error) over log(mean step)
  double deviation = 0.0;             // standard deviation of the slope, from the scatter
  std::vector<double> steps, errors;  // of the bins
};

template <class F>
MeanOrder mean_order(double largest_step, int bins, int steps_per_bin, F&& error_at_step) {
  constexpr double golden = 0.6180339887498949;
  MeanOrder result;
  double upper = largest_step;
  std::vector<double> relative_deviation;  // of the mean error of each bin
  for (int bin = 0; bin < bins; ++bin, upper *= 0.5) {
    double sum_error = 0.0, sum_step = 0.0, sum_ratio = 0.0, sum_square = 0.0;
    for (int i = 0; i < steps_per_bin; ++i) {
      const double part = std::fmod(golden * (i + 1), 1.0);
      const double step = upper * std::exp2(-part);
      const double error = error_at_step(step);
      sum_step += step;
      sum_error += error;
      sum_ratio += error / step;
      sum_square += (error / step) * (error / step);
    }
    const double n = steps_per_bin;
    result.steps.push_back(sum_step / n);
    result.errors.push_back(sum_error / n);
    const double variance = (sum_square - sum_ratio * sum_ratio / n) / (n - 1.0);
    relative_deviation.push_back(std::sqrt(variance / n) / (sum_ratio / n));
  }
  result.slope = slope(result.steps, result.errors);
  // The slope is a weighted sum of the logarithms: weights (x - mean x)/sum (x - mean x)^2, a factor of two
  // apart.
  const double middle = 0.5 * (bins - 1);
  double xx = 0.0, sum = 0.0;
  for (int bin = 0; bin < bins; ++bin) xx += (bin - middle) * (bin - middle);
  for (int bin = 0; bin < bins; ++bin) {
    const double weight = (bin - middle) / (xx * std::log(2.0));
    const double part = weight * relative_deviation[static_cast<std::size_t>(bin)];
    sum += part * part;
  }
  result.deviation = std::sqrt(sum);
  return result;
}

}  // namespace analytic
