// Problem: say what is wrong with a call of a flow, or with the motion it follows.

#include <carom/core/part_check.h>
#include <carom/core/run_error.h>
#include <carom/integrators/flow/flow_checks.h>

#include <cmath>
#include <utility>

namespace carom {

void check_flow_problem(const FlowProblem& problem, double relative_tolerance) {
  const auto refuse = [](const std::string& what, const std::string& value, const std::string& allowed) {
    throw ModelError("flow: " + what + " is " + value + "; allowed: " + allowed);
  };
  if (problem.size() == 0) refuse("the number of unknowns", "0", "at least 1");
  if (!(std::isfinite(relative_tolerance) && relative_tolerance > 0.0)) {
    refuse("the relative tolerance", to_text(relative_tolerance), "finite and > 0");
  }
  const auto absolute = problem.absolute_tolerances();
  if (absolute.size() != problem.size()) {
    refuse("the number of absolute tolerances", std::to_string(absolute.size()),
           std::to_string(problem.size()) + ", one for each unknown");
  }
  for (std::size_t i = 0; i < absolute.size(); ++i) {
    if (std::isfinite(absolute[i]) && absolute[i] > 0.0) continue;
    refuse("the absolute tolerance of unknown " + std::to_string(i), to_text(absolute[i]), "finite and > 0");
  }
}

void check_flow_bind(const FlowProblem& problem, std::size_t size, std::size_t integrals) {
  if (problem.size() == size && problem.integrals() == integrals) return;
  throw ModelError("flow: bind() is given a problem of " + std::to_string(problem.size()) + " unknowns, " +
                   std::to_string(problem.integrals()) + " of them integrals; allowed: " +
                   std::to_string(size) + " and " + std::to_string(integrals));
}

void check_flow_step(const FlowStep& step, std::size_t numbers) {
  if (step.numbers.size() == numbers) return;
  throw ModelError("flow: resume() is given a step of " + std::to_string(step.numbers.size()) +
                   " numbers; allowed: " + std::to_string(numbers) + ", as leave() of this method writes");
}

void check_flow_size(std::size_t given, std::size_t size, const char* call) {
  if (given == size) return;
  throw ModelError(std::string("flow: ") + call + "() is given " + std::to_string(given) +
                   " numbers; allowed: " + std::to_string(size));
}

void check_flow_start(double time, double first_step) {
  if (!std::isfinite(time)) throw ModelError("flow: start() at t = " + to_text(time) + "; allowed: finite");
  if (std::isfinite(first_step) && first_step >= 0.0) return;
  throw ModelError("flow: the first step is " + to_text(first_step) + "; allowed: finite and >= 0 s");
}

void check_flow_advance(bool started, double longest) {
  if (!started) throw ModelError("flow: advance() before start(), or after an error without one");
  if (longest > 0.0) return;
  throw ModelError("flow: a step of " + to_text(longest) + " s at most; allowed: > 0");
}

void check_flow_time(const Flow& flow, double time, const char* call) {
  if (time >= flow.begin() && time <= flow.end()) return;
  throw ModelError(std::string("flow: ") + call + "() at t = " + to_text(time) +
                   " s; allowed: within the last step, " + to_text(flow.begin()) + " to " +
                   to_text(flow.end()) + " s");
}

void fail_flow(const std::string& why, double time, double step) {
  SolverFailure failure;
  failure.time = time;
  failure.step = step;
  throw RunError("smooth motion at t = " + to_text(time) + " s, step " + to_text(step) + " s: " + why,
                 std::move(failure));
}

void fail_flow_not_finite(double where, double time, double step) {
  fail_flow("the rates are not finite at t = " + to_text(where) + " s, however short the step", time, step);
}

void fail_flow_too_short(double time, double step) {
  fail_flow("steps have shrunk to the rounding of time; the motion has no smooth continuation", time, step);
}

}  // namespace carom
