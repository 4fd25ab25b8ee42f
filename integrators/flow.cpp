// Problem: choose a method of integration.

#include <carom/integrators/flow.h>
#include <carom/integrators/one_step_flow.h>

namespace carom {

std::unique_ptr<Flow> make_flow(FlowMethod /*method*/, FlowProblem& problem, double relative_tolerance) {
  return std::make_unique<OneStepFlow>(problem, relative_tolerance);
}

}  // namespace carom
