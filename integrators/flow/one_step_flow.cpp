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
    : problem_(&problem), integrals_(problem.integrals()), relative_tolerance_(relative_tolerance) {
  check_flow_problem(problem, relative_tolerance);
  const std::size_t n = problem.size();
  for (std::vector<double>* array : {&start_, &end_, &trial_}) array->assign(n, 0.0);
  slopes_.assign(n * stages, 0.0);
  landing_.assign(n * stages, 0.0);
}

void OneStepFlow::rates(double time, const double* y, double* out) {
  ++counts_.evaluations;
  problem_->rates(time, y, out);
}

void OneStepFlow::bind(FlowProblem& problem) {
  check_flow_bind(problem, end_.size(), integrals_);
  check_flow_problem(problem, relative_tolerance_);
  problem_ = &problem;
  started_ = false;
}

bool OneStepFlow::leave(FlowStep& out) const {
  if (!started_) return false;
  const std::size_t n = end_.size();
  out.begin = begin_;
  out.end = time_;
  out.next = next_step_;
  out.restart = !known_;
  out.numbers.resize(4 * n);
  double* to = std::copy_n(start_.data(), n, out.numbers.data());
  to = std::copy_n(end_.data(), n, to);
  to = std::copy_n(slopes_.data(), n, to);
  std::copy_n(slopes_.data() + (stages - 1) * n, n, to);
  return true;
}

void OneStepFlow::resume(const FlowStep& step) {
  const std::size_t n = end_.size();
  check_flow_step(step, 4 * n);
  begin_ = step.begin;
  time_ = step.end;
  next_step_ = step.next;
  const double* const from = step.numbers.data();
  std::copy_n(from, n, start_.data());
  std::copy_n(from + n, n, end_.data());
  std::copy_n(from + 2 * n, n, slopes_.data());
  std::copy_n(from + 3 * n, n, slopes_.data() + (stages - 1) * n);
  known_ = !step.restart;
  started_ = true;
}

void OneStepFlow::start(double time, std::span<const double> y, double first_step) {
  check_flow_size(y.size(), end_.size(), "start");
  check_flow_start(time, first_step);
  ++counts_.restarts;
  started_ = true;
  begin_ = time_ = time;
  std::copy(y.begin(), y.end(), end_.begin());
  std::copy(y.begin(), y.end(), start_.begin());
  next_step_ = first_step;
  known_ = false;
}

void OneStepFlow::correct(std::span<const double> y) {
  check_flow_size(y.size(), end_.size(), "correct");
  std::copy(y.begin(), y.end(), end_.begin());
  std::copy(y.begin(), y.end(), start_.begin());
  begin_ = time_;
  known_ = false;
}

/// Stages from `from` over `length`, the first of which is known; y at the end goes to `to`.
void OneStepFlow::make_step(double time, double length, const std::vector<double>& from,
                            std::vector<double>& slopes, std::span<double> to) {
  const std::size_t n = from.size();
  for (std::size_t stage = 1; stage < stages; ++stage) {
    for (std::size_t i = 0; i < n; ++i) {
      double sum = 0.0;
      for (std::size_t k = 0; k < stage; ++k) sum += a[stage][k] * slopes[k * n + i];
      to[i] = from[i] + length * sum;
    }
    if (stage + 1 < stages) rates(time + c[stage] * length, to.data(), slopes.data() + stage * n);
  }
}

/// Largest estimated error of the trial against the tolerance.
double OneStepFlow::error(double length) const {
  const std::size_t n = end_.size();
  const auto tolerances = problem_->absolute_tolerances();
  double worst = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    double sum = 0.0;
    for (std::size_t k = 0; k < stages; ++k) sum += e[k] * slopes_[k * n + i];
    const double allowed =
        tolerances[i] + relative_tolerance_ * std::max(std::abs(end_[i]), std::abs(trial_[i]));
    const double part = std::abs(length * sum) / allowed;
    if (!(part <= worst)) worst = part;  // a NaN is kept
  }
  return worst;
}

/// So long that a change of first order is a hundredth of the unknowns, where nothing better is known.
double OneStepFlow::first_guess() const {
  const auto tolerances = problem_->absolute_tolerances();
  double size = 0.0, rate = 0.0;
  for (std::size_t i = 0; i < end_.size(); ++i) {
    const double weight = tolerances[i] + relative_tolerance_ * std::abs(end_[i]);
    size = std::max(size, std::abs(end_[i]) / weight);
    rate = std::max(rate, std::abs(slopes_[i]) / weight);
  }
  return rate > 0.0 && size > 0.0 ? 0.01 * size / rate : 1e-3;
}

void OneStepFlow::advance(double longest) {
  check_flow_advance(started_, longest);
  const std::size_t n = end_.size();
  started_ = false;  // unless the step succeeds
  begin_ = time_;
  if (known_) {
    std::copy_n(slopes_.end() - static_cast<std::ptrdiff_t>(n), n, slopes_.begin());
  } else {
    rates(time_, end_.data(), slopes_.data());
  }
  const bool defined = std::all_of(slopes_.begin(), slopes_.begin() + static_cast<std::ptrdiff_t>(n),
                                   [](double rate) { return std::isfinite(rate); });
  double length = std::min(next_step_ > 0.0 ? next_step_ : first_guess(), longest);
  if (!defined) fail_flow_not_finite(time_, time_, length);
  if (!(time_ + longest > time_)) {
    fail_flow("the length allowed for the step is below the rounding of time", time_, longest);
  }
  const double rounding = 8.0 * std::numeric_limits<double>::epsilon() * std::abs(time_);
  bool rejected = false, undefined = false;
  for (;;) {
    if (!(time_ + length > time_) || (length <= rounding && length < 0.5 * longest)) {
      if (undefined) fail_flow_not_finite(time_ + length, time_, length);
      fail_flow_too_short(time_, length);
    }
    make_step(time_, length, end_, slopes_, trial_);
    rates(time_ + length, trial_.data(), slopes_.data() + (stages - 1) * n);
    const double worst = error(length);
    const double wanted = worst > 0.0 ? safety * std::pow(worst, -0.2) : most_growth;
    if (worst <= 1.0) {
      // Who asks for a step to some time shall be there.
      const double last = begin_ + longest;
      start_.swap(end_);
      end_.swap(trial_);
      time_ = length == longest ? last : time_ + length;
      next_step_ = length * std::clamp(wanted, most_shrinking, rejected ? 1.0 : most_growth);
      known_ = started_ = true;
      ++counts_.steps;
      return;
    }
    rejected = true;
    undefined = !std::isfinite(worst);
    length *= undefined ? most_shrinking : std::clamp(wanted, most_shrinking, 1.0);
  }
}

void OneStepFlow::sample(double time, std::span<double> y) { land(time, y); }

void OneStepFlow::land(double time, std::span<double> y) {
  check_flow_size(y.size(), end_.size(), "land");
  check_flow_time(*this, time, "land");
  if (time == time_ || time == begin_) {
    const std::vector<double>& known = time == time_ ? end_ : start_;
    std::copy(known.begin(), known.end(), y.begin());
    return;
  }
  const std::size_t n = end_.size();
  std::copy_n(slopes_.begin(), n, landing_.begin());
  make_step(begin_, time - begin_, start_, landing_, y);
}

}  // namespace carom
