// Problem: dy/dt = f(t, y) for a handful of unknowns, where restarts are many and the cost is overhead: the
// pair of orders 5 and 4 by Dormand and Prince (1980), the last stage being the first of the next step.

#include <carom/integrators/flow/dormand_prince.h>
#include <carom/integrators/flow/flow_checks.h>
#include <carom/integrators/flow/one_step_flow.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace carom {

namespace {

using dormand_prince::a;
using dormand_prince::c;
using dormand_prince::stages;

// Of the difference between the two orders.
constexpr std::array<double, stages> e{71.0 / 57600,      0.0,        -71.0 / 16695, 71.0 / 1920,
                                       -17253.0 / 339200, 22.0 / 525, -1.0 / 40};

// The next step aims at this part of the tolerance, and is never longer or shorter by more than these
// factors.
constexpr double safety = 0.9, most_growth = 10.0, most_shrinking = 0.2;

}  // namespace

OneStepFlow::OneStepFlow(FlowProblem& problem, double relative_tolerance)
    : PlainFlow(problem, relative_tolerance, stages),
      trial_(problem.size(), 0.0),
      landing_(problem.size() * stages, 0.0) {}

void OneStepFlow::carry_rates() { std::copy_n(stage(stages - 1), state_.size(), stage(0)); }

/// Stages from `from` over `length`, the first of which is known; y at the end goes to `to`.
void OneStepFlow::make_step(double time, double length, const std::vector<double>& from, double* slopes,
                            std::span<double> to) {
  const std::size_t n = from.size();
  for (std::size_t row = 1; row < stages; ++row) {
    for (std::size_t i = 0; i < n; ++i) {
      double sum = 0.0;
      for (std::size_t k = 0; k < row; ++k) sum += a[row][k] * slopes[k * n + i];
      to[i] = from[i] + length * sum;
    }
    if (row + 1 < stages) evaluate(time + c[row] * length, to.data(), slopes + row * n);
  }
}

/// Largest estimated error of the trial against the tolerance.
double OneStepFlow::error(double length) const {
  const std::size_t n = state_.size();
  const auto tolerances = problem_->absolute_tolerances();
  const double* const slopes = stage(0);
  double worst = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    double sum = 0.0;
    for (std::size_t k = 0; k < stages; ++k) sum += e[k] * slopes[k * n + i];
    const double allowed =
        tolerances[i] + relative_tolerance_ * std::max(std::abs(state_[i]), std::abs(trial_[i]));
    const double part = std::abs(length * sum) / allowed;
    if (!(part <= worst)) worst = part;  // a NaN is kept
  }
  return worst;
}

/// So long that a change of first order is a hundredth of the unknowns, where nothing better is known.
double OneStepFlow::first_guess() const {
  const auto tolerances = problem_->absolute_tolerances();
  const double* const slopes = stage(0);
  double size = 0.0, rate = 0.0;
  for (std::size_t i = 0; i < state_.size(); ++i) {
    const double weight = tolerances[i] + relative_tolerance_ * std::abs(state_[i]);
    size = std::max(size, std::abs(state_[i]) / weight);
    rate = std::max(rate, std::abs(slopes[i]) / weight);
  }
  return rate > 0.0 && size > 0.0 ? 0.01 * size / rate : 1e-3;
}

void OneStepFlow::advance(double longest) {
  begin_step(longest);
  double length = std::min(next_step_ > 0.0 ? next_step_ : first_guess(), longest);
  const double rounding = 8.0 * std::numeric_limits<double>::epsilon() * std::abs(begin_);
  bool rejected = false, undefined = false;
  for (;;) {
    if (!(begin_ + length > begin_) || (length <= rounding && length < 0.5 * longest)) {
      if (undefined) fail_flow_not_finite(begin_ + length, begin_, length);
      fail_flow_too_short(begin_, length);
    }
    make_step(begin_, length, state_, stage(0), trial_);
    evaluate(begin_ + length, trial_.data(), stage(stages - 1));
    const double worst = error(length);
    const double wanted = worst > 0.0 ? safety * std::pow(worst, -0.2) : most_growth;
    if (worst <= 1.0) {
      start_.swap(state_);
      state_.swap(trial_);
      accept(begin_ + length, length * std::clamp(wanted, most_shrinking, rejected ? 1.0 : most_growth));
      return;
    }
    rejected = true;
    undefined = !std::isfinite(worst);
    length *= undefined ? most_shrinking : std::clamp(wanted, most_shrinking, 1.0);
  }
}

void OneStepFlow::reach(double time, std::span<double> y) {
  std::copy_n(stage(0), state_.size(), landing_.begin());
  make_step(begin_, time - begin_, start_, landing_.data(), y);
}

}  // namespace carom
