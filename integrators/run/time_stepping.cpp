#include <carom/integrators/run/time_stepping.h>

namespace carom {

std::string_view to_string(ForceRule rule) {
  switch (rule) {
    case ForceRule::trapezoidal:
      return "trapezoidal";
    case ForceRule::energy_momentum:
      return "energy_momentum";
  }
  return "unknown";
}

std::string_view to_string(ImpactTimes times) {
  switch (times) {
    case ImpactTimes::at_step_start:
      return "at_step_start";
    case ImpactTimes::located:
      return "located";
  }
  return "unknown";
}

std::string_view to_string(Iteration iteration) {
  switch (iteration) {
    case Iteration::fixed_point:
      return "fixed-point";
    case Iteration::anderson:
      return "Anderson";
    case Iteration::linearly_implicit:
      return "linearly implicit";
    case Iteration::automatic:
      return "automatic";
  }
  return "unknown";
}

}  // namespace carom
