// Problem: dy/dt = f(t, y) step by step without a library between: begin, hand over, go on from another
// place, look into the last step. What a step does is left to the method.

#include <carom/integrators/flow/flow_checks.h>
#include <carom/integrators/flow/plain_flow.h>

#include <algorithm>
#include <cmath>

namespace carom {

PlainFlow::PlainFlow(FlowProblem& problem, double relative_tolerance, std::size_t stages)
    : problem_(&problem), integrals_(problem.integrals()), relative_tolerance_(relative_tolerance) {
  check_flow_problem(problem, relative_tolerance);
  for (std::vector<double>* array : {&start_, &state_}) array->assign(problem.size(), 0.0);
  rates_.assign(problem.size() * stages, 0.0);
}

void PlainFlow::evaluate(double time, const double* y, double* rates) {
  ++counts_.evaluations;
  problem_->rates(time, y, rates);
}

void PlainFlow::bind(FlowProblem& problem) {
  check_flow_bind(problem, state_.size(), integrals_);
  check_flow_problem(problem, relative_tolerance_);
  problem_ = &problem;
  started_ = false;
}

bool PlainFlow::leave(FlowStep& out) const {
  if (!started_) return false;
  out.begin = begin_;
  out.end = end_;
  out.next = next_step_;
  out.restart = !known_;
  const std::size_t n = state_.size();
  out.numbers.resize(numbers_kept());
  double* to = std::copy_n(start_.data(), n, out.numbers.data());
  to = std::copy_n(state_.data(), n, to);
  to = std::copy_n(rates_.data(), n, to);
  if (rates_.size() > n) std::copy_n(rates_.end() - static_cast<std::ptrdiff_t>(n), n, to);
  return true;
}

void PlainFlow::resume(const FlowStep& step) {
  check_flow_step(step, numbers_kept());
  begin_ = step.begin;
  end_ = step.end;
  next_step_ = step.next;
  known_ = !step.restart;
  const std::size_t n = state_.size();
  const double* const from = step.numbers.data();
  std::copy_n(from, n, start_.data());
  std::copy_n(from + n, n, state_.data());
  std::copy_n(from + 2 * n, n, rates_.data());
  if (rates_.size() > n) std::copy_n(from + 3 * n, n, rates_.end() - static_cast<std::ptrdiff_t>(n));
  started_ = true;
}

/// y at both ends, rates of the first and of the last stage, which may be one.
std::size_t PlainFlow::numbers_kept() const {
  const std::size_t n = state_.size();
  return 2 * n + std::min(rates_.size(), 2 * n);
}

void PlainFlow::start(double time, std::span<const double> y, double first_step) {
  check_flow_size(y.size(), state_.size(), "start");
  check_flow_start(time, first_step);
  ++counts_.restarts;
  end_ = time;
  next_step_ = first_step;
  go_on_from(y);
  started_ = true;
}

void PlainFlow::correct(std::span<const double> y) {
  check_flow_size(y.size(), state_.size(), "correct");
  go_on_from(y);
}

/// The last step becomes empty, at y.
void PlainFlow::go_on_from(std::span<const double> y) {
  std::copy(y.begin(), y.end(), state_.begin());
  std::copy(y.begin(), y.end(), start_.begin());
  begin_ = end_;
  known_ = false;
}

void PlainFlow::begin_step(double longest) {
  check_flow_advance(started_, longest);
  started_ = false;  // unless the step succeeds
  if (!(end_ + longest > end_)) {
    fail_flow("the length allowed for the step is below the rounding of time", end_, longest);
  }
  begin_ = end_;
  if (known_) {
    carry_rates();
  } else {
    evaluate(end_, state_.data(), rates_.data());
  }
  const auto first_end = rates_.begin() + static_cast<std::ptrdiff_t>(state_.size());
  if (!std::all_of(rates_.begin(), first_end, [](double rate) { return std::isfinite(rate); })) {
    fail_flow_not_finite(end_, end_, longest);
  }
}

void PlainFlow::accept(double end, double next_step) {
  end_ = end;
  next_step_ = next_step;
  known_ = started_ = true;
  ++counts_.steps;
}

void PlainFlow::land(double time, std::span<double> y) {
  check_flow_size(y.size(), state_.size(), "land");
  check_flow_time(*this, time, "land");
  if (time == end_) {
    std::copy(state_.begin(), state_.end(), y.begin());
  } else if (time == begin_) {
    std::copy(start_.begin(), start_.end(), y.begin());
  } else {
    reach(time, y);
  }
}

}  // namespace carom
