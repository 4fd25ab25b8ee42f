// Problem: steps of an integrator as a sequence that somebody watches: where each began and ended, what was
// there, and in plain words why there is no next one.

#include <carom/integrators/flow/ballistic_flow.h>
#include <carom/integrators/flow/flow_checks.h>
#include <carom/integrators/flow/one_step_flow.h>
#include <carom/integrators/flow/sundials_flow.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace carom {

SundialsFlow::SundialsFlow(FlowProblem& problem, double relative_tolerance)
    : link_(problem, relative_tolerance), begin_state_(link_.size()), end_state_(link_.size()) {
  begin_vector_ = link_.vector(begin_state_.data());
  end_vector_ = link_.vector(end_state_.data());
  out_vector_ = link_.vector(end_state_.data());
}

void SundialsFlow::start(double time, std::span<const double> y, double first_step) {
  check_flow_size(y.size(), link_.size(), "start");
  check_flow_start(time, first_step);
  begin_ = end_ = time;
  next_ = first_step;
  std::copy(y.begin(), y.end(), end_state_.begin());
  begin_state_ = end_state_;
  started_ = true;
  stepped_ = false;
  ++counts_.restarts;
  forget();
}

void SundialsFlow::bind(FlowProblem& problem) {
  link_.bind(problem);
  started_ = false;
}

bool SundialsFlow::leave(FlowStep& out) const {
  if (!started_ || !(starts_anew() || history_size() > 0)) return false;
  const std::size_t n = link_.size();
  out.begin = begin_;
  out.end = end_;
  out.next = next_;
  out.restart = starts_anew();
  out.numbers.resize(2 * n + history_size());
  std::copy_n(begin_state_.data(), n, out.numbers.data());
  std::copy_n(end_state_.data(), n, out.numbers.data() + n);
  if (!out.restart) record_history(out.numbers.data() + 2 * n);
  return true;
}

void SundialsFlow::resume(const FlowStep& step) {
  const std::size_t n = link_.size();
  check_flow_step(step, 2 * n + history_size());
  begin_ = step.begin;
  end_ = step.end;
  next_ = step.next;
  std::copy_n(step.numbers.data(), n, begin_state_.data());
  std::copy_n(step.numbers.data() + n, n, end_state_.data());
  started_ = true;
  stepped_ = false;
  forget();
  if (!step.restart) restore_history(step.numbers.data() + 2 * n);
}

void SundialsFlow::advance(double longest) {
  check_flow_advance(started_, longest);
  begin_ = end_;
  std::copy(end_state_.begin(), end_state_.end(), begin_state_.begin());
  const double wanted = next_ > 0.0 ? std::min(next_, longest) : longest;
  if (!(begin_ + longest > begin_)) {
    fail_flow("the length allowed for the step is below the rounding of time", begin_, longest);
  }

  link_.clear();
  started_ = false;  // unless the step succeeds
  double reached = begin_;
  const int flag = step(longest, reached);
  if (flag < 0 || link_.errors().thrown()) {
    std::copy(begin_state_.begin(), begin_state_.end(), end_state_.begin());
    link_.errors().fail(flag, begin_, wanted);
  }
  // Who asks for a step to some time shall be there.
  const double last = begin_ + longest;
  constexpr double epsilon = std::numeric_limits<double>::epsilon();
  if (std::abs(reached - last) <= 16.0 * epsilon * (std::abs(last) + longest)) reached = last;
  // SUNDIALS goes on with steps that are lost in the rounding of time, and nobody would ever arrive.
  const double rounding = 8.0 * epsilon * std::abs(begin_);
  const double length = reached - begin_;
  if (!(length > 0.0) || (length <= rounding && length < 0.5 * longest)) {
    std::copy(begin_state_.begin(), begin_state_.end(), end_state_.begin());
    const double hole = link_.errors().not_finite_at() - begin_;
    if (hole >= 0.0 && hole <= 1e3 * rounding) link_.errors().fail_not_finite(begin_, length);
    fail_flow_too_short(begin_, length);
  }
  end_ = reached;
  started_ = stepped_ = true;
  ++counts_.steps;
}

void SundialsFlow::demand_step(double time, std::size_t size, const char* call) const {
  check_flow_size(size, link_.size(), call);
  check_flow_time(*this, time, call);
}

void SundialsFlow::sample(double time, std::span<double> y) {
  demand_step(time, y.size(), "sample");
  if (time == end_) {
    std::copy(end_state_.begin(), end_state_.end(), y.begin());
  } else if (time == begin_) {
    std::copy(begin_state_.begin(), begin_state_.end(), y.begin());
  } else if (stepped_) {
    interpolate(time, y.data());
  } else {
    integrate_to(time, y.data());
  }
}

void SundialsFlow::land(double time, std::span<double> y) {
  demand_step(time, y.size(), "land");
  if (time == end_ || time == begin_) {
    sample(time, y);
  } else {
    integrate_to(time, y.data());
  }
}

void SundialsFlow::correct(std::span<const double> y) {
  check_flow_size(y.size(), link_.size(), "correct");
  if (stepped_) {
    shift(y);
  } else {
    forget();
  }
  std::copy(y.begin(), y.end(), end_state_.begin());
  std::copy(y.begin(), y.end(), begin_state_.begin());
  begin_ = end_;
}

const FlowCounts& SundialsFlow::counts() const {
  counts_.evaluations = link_.evaluations();
  return counts_;
}

double SundialsFlow::horizon(double longest) const {
  // Not infinite: the guess of a first step is bounded below by the rounding of this time.
  return begin_ + std::min(longest, 1e3 + std::abs(begin_));
}

std::unique_ptr<Flow> make_flow(FlowMethod method, FlowProblem& problem, double relative_tolerance) {
  if (problem.is_ballistic()) return std::make_unique<BallisticFlow>(problem, relative_tolerance);
  if (method == FlowMethod::one_step) return std::make_unique<OneStepFlow>(problem, relative_tolerance);
  if (method == FlowMethod::explicit_runge_kutta) return make_runge_kutta_flow(problem, relative_tolerance);
  if (method > FlowMethod::one_step) {
    throw ModelError("flow: method is " + std::to_string(static_cast<int>(method)) +
                     "; allowed: one of FlowMethod, explicit_runge_kutta (0) to one_step (3)");
  }
  return make_multistep_flow(method, problem, relative_tolerance);
}

}  // namespace carom
