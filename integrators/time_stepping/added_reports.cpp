#include <carom/integrators/time_stepping/added_reports.h>

#include <algorithm>
#include <cstddef>

namespace carom {

void add(const StepReport& part, StepReport& sum) {
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
  for (std::size_t i = 0; i < sum.joint_impulses.size(); ++i) {
    JointImpulse& to = sum.joint_impulses[i];
    const JointImpulse& more = part.joint_impulses[i];
    for (std::size_t k = 0; k < to.impulse.force.size(); ++k) to.impulse.force[k] += more.impulse.force[k];
    to.impulse.moment += more.impulse.moment;
    to.time = more.time;
  }
}

}  // namespace carom
