#pragma once

/// \file
/// Joints of one component in a step in which nothing touches or rubs and no row is near to following from
/// others. What they do is guessed by the steps before, so that the first sweep comes as near to the answer
/// as rounding lets it; the iterate is the answer when its own rows leave nothing but rounding of both
/// conditions, and its Gm^T L is the impulse that led to it (joint_stage.h).

#include <carom/core/export.h>
#include <carom/integrators/run/joint_history.h>
#include <carom/integrators/time_stepping/joint_iterate.h>

namespace carom {

/// The iteration of a step in which nothing touches and no row is near to following from others.
class CAROM_API UntouchedJoints {
public:
  /// \param iterate must outlive it \param first_row of the component among the rows of all
  UntouchedJoints(JointIterate& iterate, Index first_row);

  /// The first iterate, under the loads of the guess. False where no step is remembered or a row is near to
  /// following from others: then there is none.
  [[nodiscard]] bool start(const StepInput& in, const StepRule& rule, StepTrial& trial);
  /// Impulses of the last step as a guess at those of this one; none where it is not remembered.
  void guess_impulses(const StepInput& in);
  /// One sweep.
  void sweep(const StepInput& in, const StepRule& rule, StepTrial& trial);
  /// Change that another sweep would make where the joints are obeyed, else that the sweep has made.
  [[nodiscard]] SweepChange change(const StepInput& in, const StepTrial& trial);
  /// JointIterate::violation() of the iterate.
  [[nodiscard]] double violation() const { return violation_.worst(); }
  /// Takes a step down, made by whatever iteration. \param struck something touched: what contact did is of
  /// its own step, and the steps before say nothing
  void record(bool struck, JointHistory& history) const;

private:
  void correct_again(const StepInput& in, const StepRule& rule, bool look, StepTrial& trial);
  void note_velocities(const StepTrial& trial);
  [[nodiscard]] double turn_of_rows(const StepInput& in, const StepTrial& trial) const;
  void return_to_joints(const StepInput& in, StepTrial& trial);

  JointIterate* iterate_;
  Range rows_;  // of the component, among all
  int sweeps_ = 0;
  JointViolation violation_;
};

}  // namespace carom
