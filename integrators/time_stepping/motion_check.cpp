// Problem: refuse the end of a step where no motion leads.

#include <carom/integrators/time_stepping/far_turn.h>
#include <carom/integrators/time_stepping/motion_check.h>

namespace carom {

void demand_motion(const StepIsland& island, const StepInput& in, StepParts& parts) {
  for (const Index component : island.components) {
    const JointStage* const joints = parts.joints.of(component);
    if (joints == nullptr) continue;
    const StrayBody stray = joints->find_stray(in, parts.trial, parts.options.tolerance);
    if (stray.body.valid()) parts.errors(in, component).fail_stray(stray);
  }
}

void demand_closed(JointStage& joints, const StepInput& in, StepParts& parts) {
  constexpr double unseen = 1e-8, tolerances = 10.0;  // of the size of the mechanism, and of the tolerance
  double gap = 0.0;
  const JointId worst = joints.worst_joint(gap);
  const Index component = joints.iterate().component;
  const Range bodies = in.assembly.components()[component].bodies;
  const double size = size_of(in.assembly, bodies, joints.iterate().arrays->lengths, parts.trial.end);
  if (gap > tolerances * parts.options.tolerance + unseen * size) {
    parts.errors(in, component).fail_open(worst, gap);
  }
}

}  // namespace carom
