#pragma once

/// \file
/// Newton's method for the loads at the end of a step, for couplings too stiff for sweeps: with the
/// linearised step A = M - (h/2) C - (h^2/4) K (core/dynamics/implicit_solver.h), the guess x and the loads g
/// that it led to,
///
///     A d = w (g - x) + H^T (P' - P),   P' from the contact problem with W = H A^-1 H^T,
///
/// leads to the guess  x' = x + (M d - H^T (P' - P)) / w. Where joints bind bodies,
///
///     A d - Gm^T l = w (g - x) + H^T (P' - P),   G (v + d) + rate = 0,   x' = g + (M - A) d / w.
///
/// Where nothing touches or rubs, reactions L and conditions are linearised too as their rows turn, and the
/// iterate is (v, L) itself: with R and B of joint_turn.h, at v, its loads g and rows,
///
///     (A - R) d - Gm^T l = M (v_free(g) - v) + Gm^T L,   (G + B) d = -(G v + rate),   v' = v + d,   L' = L +
///     l.
///
/// Reactions of a light body, made anew along rows that have turned by rounding, would move it by much more
/// than that; v' is kept as it is.

#include <carom/contact/delassus.h>
#include <carom/contact/island_problem.h>
#include <carom/core/dynamics/implicit_solver.h>
#include <carom/core/export.h>
#include <carom/integrators/time_stepping/joint_stage.h>
#include <carom/integrators/time_stepping/joint_turn.h>
#include <carom/integrators/time_stepping/step_input.h>
#include <carom/integrators/time_stepping/step_rule.h>
#include <carom/integrators/time_stepping/step_trial.h>

#include <vector>

namespace carom {

/// Newton's method over one component at a time. Keeps memory only.
class CAROM_API NewtonIteration {
public:
  /// Outcome of a step of it.
  enum class Outcome : std::uint8_t { done, singular, unsolved };

  /// The first guess: loads that would leave the velocities as they are, to be corrected by the loads at the
  /// start as they grow with the motion. \param joints of the component; null: none
  [[nodiscard]] Outcome start(const StepInput& in, const StepRule& rule, Index component, JointStage* joints,
                              IslandProblem* contact, StepTrial& trial);
  /// One step from the iterate: impulses, and the guess that leads to the new velocities.
  [[nodiscard]] Outcome step(const StepInput& in, const StepRule& rule, Index component,
                             IslandProblem* contact, SolverChain& chain, StepTrial& trial);
  /// The same step where joints bind bodies, for the guess alone, which the sweep behind it takes as any
  /// other.
  [[nodiscard]] Outcome step_with_joints(const StepInput& in, const StepRule& rule, Index component,
                                         JointStage& joints, IslandProblem* contact, SolverChain& chain,
                                         StepTrial& trial);
  /// A sweep where joints bind bodies and nothing touches or rubs.
  [[nodiscard]] Outcome sweep_untouched(const StepInput& in, const StepRule& rule, JointIterate& joints,
                                        StepTrial& trial);
  /// Change by the last step.
  [[nodiscard]] SweepChange change(const StepInput& in, Index component, const StepTrial& trial) const;
  /// Takes note of how the iteration contracts: badly with a matrix that is out of date.
  void note_contraction(int sweeps, double contraction);

private:
  [[nodiscard]] bool linearise(const StepInput& in, Index component, const StateView& at,
                               const Evaluation& evaluation, JointStage* joints, IslandProblem* contact);
  void begin_untouched(const StepInput& in, const StepRule& rule, JointIterate& joints, StepTrial& trial);
  [[nodiscard]] bool correct_untouched(const StepInput& in, const StepRule& rule, JointIterate& joints,
                                       StepTrial& trial);

  ImplicitSolver matrix_;
  bool stale_ = false;  // the matrix is to be made anew
  Delassus by_masses_;  // impulses as the sweep behind applies them
  JointTurn turn_;
  std::vector<double> update_, scratch_, residuals_, multipliers_, ahead_;
};

}  // namespace carom
