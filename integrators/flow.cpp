// Problem: choose a method of integration.

#include <carom/integrators/flow.h>
#include <carom/integrators/one_step_flow.h>
#include <carom/integrators/sundials_flow.h>

namespace carom {

std::unique_ptr<Flow> make_flow(FlowMethod method, FlowProblem& problem, double relative_tolerance) {
  if (method == FlowMethod::one_step) return std::make_unique<OneStepFlow>(problem, relative_tolerance);
  if (method == FlowMethod::explicit_runge_kutta) return make_runge_kutta_flow(problem, relative_tolerance);
  return make_multistep_flow(method, problem, relative_tolerance);
}

}  // namespace carom
