// Problem: dq/dt = v, dv/dt = a constant, between the events of bodies in free flight, which are most of the
// motion of many: a method of integration would find the same parabola at the cost of its stages.

#include <carom/integrators/flow/ballistic_flow.h>
#include <carom/integrators/flow/flow_checks.h>

#include <algorithm>
#include <cmath>

namespace carom {

BallisticFlow::BallisticFlow(FlowProblem& problem, double relative_tolerance)
    : problem_(&problem), integrals_(problem.integrals()), relative_tolerance_(relative_tolerance) {
  check_flow_problem(problem, relative_tolerance);
  for (std::vector<double>* array : {&start_, &state_, &rates_}) array->assign(problem.size(), 0.0);
}

void BallisticFlow::bind(FlowProblem& problem) {
  check_flow_bind(problem, state_.size(), integrals_);
  check_flow_problem(problem, relative_tolerance_);
  problem_ = &problem;
  started_ = false;
}

bool BallisticFlow::leave(FlowStep& out) const {
  if (!started_) return false;
  const std::size_t n = state_.size();
  out.begin = begin_;
  out.end = end_;
  out.next = next_step_;
  out.restart = !known_;
  out.numbers.resize(3 * n);
  double* to = std::copy_n(start_.data(), n, out.numbers.data());
  to = std::copy_n(state_.data(), n, to);
  std::copy_n(rates_.data(), n, to);
  return true;
}

void BallisticFlow::resume(const FlowStep& step) {
  const std::size_t n = state_.size();
  check_flow_step(step, 3 * n);
  begin_ = step.begin;
  end_ = step.end;
  next_step_ = step.next;
  known_ = !step.restart;
  const double* const from = step.numbers.data();
  std::copy_n(from, n, start_.data());
  std::copy_n(from + n, n, state_.data());
  std::copy_n(from + 2 * n, n, rates_.data());
  started_ = true;
}

void BallisticFlow::start(double time, std::span<const double> y, double first_step) {
  check_flow_size(y.size(), state_.size(), "start");
  check_flow_start(time, first_step);
  ++counts_.restarts;
  begin_ = end_ = time;
  next_step_ = first_step;
  std::copy(y.begin(), y.end(), state_.begin());
  std::copy(y.begin(), y.end(), start_.begin());
  started_ = true;
  known_ = false;
}

void BallisticFlow::correct(std::span<const double> y) {
  check_flow_size(y.size(), state_.size(), "correct");
  std::copy(y.begin(), y.end(), state_.begin());
  std::copy(y.begin(), y.end(), start_.begin());
  begin_ = end_;
  known_ = false;
}

void BallisticFlow::advance(double longest) {
  check_flow_advance(started_, longest);
  const double until = end_ + longest;
  if (!(until > end_)) {
    fail_flow("the length allowed for the step is below the rounding of time", end_, longest);
  }
  started_ = false;  // unless the step succeeds
  if (!known_) {
    ++counts_.evaluations;
    problem_->rates(end_, state_.data(), rates_.data());
    const bool defined =
        std::all_of(rates_.begin(), rates_.end(), [](double rate) { return std::isfinite(rate); });
    if (!defined) fail_flow_not_finite(end_, end_, longest);
  } else {
    std::copy_n(state_.data() + integrals_, integrals_, rates_.data());
  }
  begin_ = end_;
  start_.swap(state_);
  fly(until, state_);
  end_ = until;
  next_step_ = longest;
  known_ = started_ = true;
  ++counts_.steps;
}

/// Writes y at a time, from the start of the step.
void BallisticFlow::fly(double time, std::span<double> y) const {
  const double dt = time - begin_;
  for (std::size_t i = 0; i < integrals_; ++i) {
    y[i] = start_[i] + dt * (rates_[i] + 0.5 * dt * rates_[integrals_ + i]);
  }
  for (std::size_t i = integrals_; i < y.size(); ++i) y[i] = start_[i] + dt * rates_[i];
}

void BallisticFlow::land(double time, std::span<double> y) {
  check_flow_size(y.size(), state_.size(), "land");
  check_flow_time(*this, time, "land");
  if (time == end_) {
    std::copy(state_.begin(), state_.end(), y.begin());
  } else if (time == begin_) {
    std::copy(start_.begin(), start_.end(), y.begin());
  } else {
    fly(time, y);
  }
}

}  // namespace carom
