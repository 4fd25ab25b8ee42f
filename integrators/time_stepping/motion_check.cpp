// Problem: refuse the end of a step where no motion leads.

#include <carom/integrators/time_stepping/far_turn.h>
#include <carom/integrators/time_stepping/motion_check.h>

namespace carom {

void demand_motion(const JointStage& joints, const StepInput& in, const StepModel& model, StepTrial& trial) {
  const StrayBody stray = joints.find_stray(in, trial, model.options.tolerance);
  if (stray.body.valid()) model.errors(in, joints.iterate().component, trial).fail_stray(stray);
}

void demand_closed(const JointStage& joints, const StepInput& in, const StepModel& model, StepTrial& trial) {
  constexpr double unseen = 1e-8, tolerances = 10.0;  // of the size of the mechanism, and of the tolerance
  double gap = 0.0;
  const JointId worst = joints.worst_joint(gap);
  const Index component = joints.iterate().component;
  const Range bodies = in.assembly.components()[component].bodies;
  const double size = size_of(in.assembly, bodies, joints.iterate().arrays->lengths, trial.end);
  if (gap > tolerances * model.options.tolerance + unseen * size)
    model.errors(in, component, trial).fail_open(worst, gap);
}

}  // namespace carom
