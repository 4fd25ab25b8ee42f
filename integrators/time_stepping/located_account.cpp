// Problem: what the flights and impacts of a body that is hit within a step make of the account, and of loads
// that depend on velocities.

#include <carom/integrators/time_stepping/located_motion.h>

#include <algorithm>

namespace carom {

Range LocatedMotion::velocities(const StepInput& in) const {
  const BodySlot slot = in.assembly.layout()->bodies()[body_];
  return {slot.v, slot.v + slot.v_size};
}

void LocatedMotion::show_end(const StepInput& in, const MotionPhase& phase, StepTrial& trial) const {
  const Range v = velocities(in);
  std::copy_n(phase.v1.begin(), v.size(), trial.end.v.begin() + v.begin);
}

void LocatedMotion::take_back(const StepInput& in, bool weighted, StepTrial& trial) const {
  const Range v = velocities(in);
  for (const MotionPhase& phase : phases()) {
    if (!phase.is_impact()) continue;
    const double weight = weighted ? 1.0 - 2.0 * phase.begin : 1.0;
    for (Index i = 0; i < v.size(); ++i) trial.end.v[v.begin + i] -= weight * (phase.v1[i] - phase.v0[i]);
  }
}

double LocatedMotion::work(const StepInput& in, const StepLoads& loads) const {
  const Range v = velocities(in);
  double sum = 0.0;
  for (const MotionPhase& phase : phases()) {
    for (Index i = 0; i < v.size(); ++i) {
      const double load =
          loads.at(v.begin + i, phase.begin, phase.hit) + loads.at(v.begin + i, phase.end, phase.hit);
      sum += 0.25 * (phase.end - phase.begin) * in.step * load * (phase.v0[i] + phase.v1[i]);
    }
  }
  return sum;
}

}  // namespace carom
