#pragma once

/// \file
/// How the rows of the joints of one component turn with the velocities at the end of a step. Reactions that
/// turn are a stiffness of their own: a light body between heavy ones, on which forces pull that are large
/// against its mass, swings across them with a frequency that may be far above one in a step. Sweeps, with
/// rows as the sweep before has left them, do not contract then.

#include <carom/core/dynamics/implicit_solver.h>
#include <carom/core/export.h>
#include <carom/core/joint_kind.h>
#include <carom/integrators/time_stepping/joint_iterate.h>
#include <carom/integrators/time_stepping/step_input.h>
#include <carom/integrators/time_stepping/step_trial.h>

#include <vector>

namespace carom {

/// Derivatives at one iterate. Keeps memory only.
class CAROM_API JointTurn {
public:
  /// Finds the derivatives where the rows of the iterate have been placed, with its impulses.
  void differentiate(const StepInput& in, JointIterate& joints, const StepTrial& trial);
  /// d(Gm^T L)/dv_{j+1}, by velocities of the model.
  [[nodiscard]] const std::vector<MatrixNumber>& of_reactions() const { return of_reactions_; }
  /// dG1/dv_{j+1} v_{j+1} and that of the rates, by rows and velocities of the model; none along mean rows,
  /// whose condition is that of positions.
  [[nodiscard]] const std::vector<MatrixNumber>& of_conditions() const { return of_conditions_; }

private:
  std::vector<JointRowDerivative> changes_;
  std::vector<MatrixNumber> of_reactions_, of_conditions_;
};

}  // namespace carom
