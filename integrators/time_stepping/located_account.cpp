// Problem: what the flights and impacts of a body that is hit within a step make of the account, and of loads
// that depend on velocities.

#include <carom/integrators/time_stepping/located_impacts.h>

#include <algorithm>

namespace carom {

StepLoads step_loads(const StepInput& in, const StepRule& rule, const StepTrial& trial) {
  const double* const end = trial.loads_guess.data();
  const double* const start = rule.is_mean() ? end : in.companion.loads.total.data();
  if (!trial.jumps.on) return {.start = start, .end = end, .is_mean = rule.is_mean()};
  return {.start = start,
          .end = end,
          .jump = trial.jumps.jump.data(),
          .correction = trial.jumps.correction.data(),
          .is_mean = rule.is_mean()};
}

Range LocatedMotion::velocities(const StepInput& in) const {
  const BodySlot slot = in.assembly.layout()->bodies()[body_];
  return {slot.v, slot.v + slot.v_size};
}

void LocatedMotion::show_end(const StepInput& in, const MotionPhase& phase, StepTrial& trial) const {
  const Range v = velocities(in);
  std::copy_n(phase.v1.begin(), v.size(), trial.end.v.begin() + v.begin);
}

double LocatedMotion::work(const StepInput& in, const StepLoads& of) const {
  StepLoads loads = of;
  loads.at_impact = is_hit();
  const Range v = velocities(in);
  double sum = 0.0;
  for (const MotionPhase& phase : phases()) phase.add_work(loads, v, in.step, sum);
  return sum;
}

}  // namespace carom
