// Problem: derivatives of the rows of joints by the velocities at the end of a step.

#include <carom/integrators/time_stepping/joint_turn.h>

#include <array>
#include <cstddef>

namespace carom {

void JointTurn::differentiate(const StepInput& in, JointIterate& joints, const StepTrial& trial) {
  changes_.resize(std::size_t{JointKind::most_rows});
  of_reactions_.clear();
  of_conditions_.clear();
  StepJointRows& rows = joints.rows;
  const JointConstraints& at_end = rows.at_end();
  const JointPattern& pattern = at_end.pattern();
  // Bodies go by h/2 times what velocities at the end change, and the places halfway by half of that.
  const bool pushed_at_end = rows.reactions() == Reactions::at_end;
  const double by_end = 0.5 * in.step, by_pushing = pushed_at_end ? by_end : 0.5 * by_end;
  const JointView end{trial.end.view(), trial.at_end.rotation.data()};
  const JointView pushing =
      pushed_at_end ? end : JointView{trial.midpoint.view(), trial.at_midpoint.rotation.data()};
  std::array<Index, static_cast<std::size_t>(JointRowDerivative::most)> columns{};
  for (std::size_t joint = 0; joint < pattern.size(); ++joint) {
    const Index first = pattern.first_row(joint), last = pattern.first_row(joint + 1);
    const JointRow like = at_end.row(first);  // rows of a joint have the same blocks
    std::size_t count = 0;
    for (int b = 0; b < like.bodies; ++b) {
      const JointRow::Block& block = like.blocks[static_cast<std::size_t>(b)];
      for (int c = 0; c < block.columns; ++c) columns[count++] = block.v + static_cast<Index>(c);
    }
    pattern.derivatives(pushing, joint, changes_.data());
    for (Index row = first; row < last; ++row) {
      const JointRowDerivative& change = changes_[row - first];
      for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t j = 0; j < count; ++j) {
          if (change.jacobian[i][j] == 0.0) continue;  // most are: points hold bodies without turning them
          of_reactions_.push_back(
              {columns[i], columns[j], by_pushing * joints.impulse[row] * change.jacobian[i][j]});
        }
      }
    }
    if (rows.is_mean()) continue;
    pattern.derivatives(end, joint, changes_.data());
    for (Index row = first; row < last; ++row) {
      for (std::size_t j = 0; j < count; ++j) {
        // The drift has each of these terms twice.
        of_conditions_.push_back(
            {row, columns[j], 0.5 * by_end * changes_[row - first].drift_by_velocity[j]});
      }
    }
  }
}

}  // namespace carom
