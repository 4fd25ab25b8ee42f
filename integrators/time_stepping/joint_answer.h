#pragma once

/// \file
/// Answer of the joints of one component to contact within a step: impulses along rows A, which no sweep
/// changes, by the condition A v + a = 0 on velocities at the end. These are the rows at the start and the
/// rates at the end,
///
///     A = G0,   a = r1,
///
/// or, where the step is repeated with the rows of its own path (contact_turning.h), those halfway there and
/// what they leave of the condition at its end,
///
///     A = G((q_j + q_{j+1})/2),   a = (G1 - A) v_{j+1} + r1,
///
/// so that A v_{j+1} + a = 0 is that condition, G1 v_{j+1} + r1 = 0.

#include <carom/core/assembly.h>
#include <carom/core/dynamics/joint_constraints.h>
#include <carom/core/export.h>
#include <carom/integrators/time_stepping/step_input.h>
#include <carom/integrators/time_stepping/step_joint_rows.h>
#include <carom/integrators/time_stepping/step_trial.h>

#include <cstddef>
#include <vector>

namespace carom {

/// Rows and constants of the answer. Memory of one component.
class CAROM_API JointAnswer {
public:
  /// \param like constraints of the component, whose pattern it shares
  JointAnswer(Index component, const JointConstraints& like);

  /// A step begins, whose path is not known.
  void forget_path() { halfway_ = false; }
  /// Acts along the rows halfway of the path that led to the trial, until forget_path(). Evaluates rotations
  /// at the start, halfway, at the end. True if anything turns by more than rounding. \param middle the mean
  /// of the coordinates at both ends \param joints the rows, of which those at the end are brought there.
  /// Throws SolverError where a prescribed motion is not finite.
  [[nodiscard]] bool follow_path(const StepInput& in, const State& middle, StepJointRows& joints,
                                 StepTrial& trial);
  /// Unless a path is followed acts along the rows at the start, with rotations there. Throws SolverError
  /// where a prescribed motion is not finite.
  void place(const StepInput& in, StepTrial& trial);

  /// A.
  [[nodiscard]] JointConstraints& rows() { return rows_; }
  /// Makes velocities obey the condition. \param end the rows at the end \param left work, one number by row
  void allow(const JointConstraints& end, double* velocity, std::vector<double>& left);
  /// Errors A v_j - a + r0 + r1 of the condition at the start along the rows of the answer: half of them
  /// times the multipliers of the answer is its work, but for that on drivers. \param out by row
  void errors(const JointConstraints& end, const double* velocity_before, double* out) const;
  /// The rate r0 of a row at the start.
  [[nodiscard]] double rate_at_start(std::size_t row) const {
    return halfway_ ? rate_at_start_[row] : rows_.rate(row);
  }

private:
  Index component_;
  JointConstraints rows_;
  std::vector<double> constant_, rate_at_start_, sizes_;  // a; r0; of velocities along rows
  bool halfway_ = false;
};

}  // namespace carom
