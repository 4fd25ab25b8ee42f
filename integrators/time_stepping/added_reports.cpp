#include <carom/integrators/time_stepping/added_reports.h>

#include <algorithm>
#include <cstddef>

namespace carom {

namespace {

/// All but the impulses of joints.
void add_all_else(const StepReport& part, StepReport& sum) {
  sum.time = part.time;
  sum.iteration = std::max(sum.iteration, part.iteration);
  sum.fallbacks += part.fallbacks;
  sum.sweeps = std::max(sum.sweeps, part.sweeps);
  sum.local_sweeps = std::max(sum.local_sweeps, part.local_sweeps);
  sum.contraction = std::max(sum.contraction, part.contraction);
  if (part.worst_coupling_rate > sum.worst_coupling_rate) {
    sum.worst_coupling = part.worst_coupling;
    sum.worst_coupling_rate = part.worst_coupling_rate;
  }
  sum.energy_gain += part.energy_gain;
  sum.lasting_gain += part.lasting_gain;
  sum.projected = std::max(sum.projected, part.projected);
  if (!part.capped_problem.empty()) sum.capped_problem = part.capped_problem;  // worse than those before
  sum.contacts.insert(sum.contacts.end(), part.contacts.begin(), part.contacts.end());
}

/// The impulse of a joint in a report. \param likely its place, if components were advanced in the same order
const JointImpulse& impulse_of(JointId joint, const StepReport& report, std::size_t likely) {
  const std::vector<JointImpulse>& list = report.joint_impulses;
  if (list[likely].joint == joint) return list[likely];
  return *std::find_if(list.begin(), list.end(), [&](const JointImpulse& at) { return at.joint == joint; });
}

}  // namespace

void add(const StepReport& part, StepReport& sum) {
  add_all_else(part, sum);
  for (std::size_t i = 0; i < sum.joint_impulses.size(); ++i) {
    JointImpulse& to = sum.joint_impulses[i];
    const JointImpulse& more = impulse_of(to.joint, part, i);
    for (std::size_t k = 0; k < to.impulse.force.size(); ++k) to.impulse.force[k] += more.impulse.force[k];
    to.impulse.moment += more.impulse.moment;
    to.time = more.time;
  }
}

void join(const StepReport& part, StepReport& sum) {
  add_all_else(part, sum);
  sum.joint_impulses.insert(sum.joint_impulses.end(), part.joint_impulses.begin(), part.joint_impulses.end());
}

}  // namespace carom
