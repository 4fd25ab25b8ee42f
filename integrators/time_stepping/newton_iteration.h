#pragma once

/// \file
/// Newton's method for the loads at the end of a step, for couplings too stiff for sweeps: with the
/// linearised step A = M - (h/2) C - (h^2/4) K of each component of an island
/// (core/dynamics/implicit_solver.h), the guess x and the loads g that it led to,
///
///     A d = w (g - x) + H^T (P' - P),   P' from the contact problem with W = H A^-1 H^T,
///
/// leads to the guess  x' = x + (M d - H^T (P' - P)) / w. Where joints bind bodies of a component,
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
///
/// Contact of all components of the island is one problem.

#include <carom/contact/delassus.h>
#include <carom/contact/island_problem.h>
#include <carom/core/dynamics/body_response.h>
#include <carom/core/dynamics/implicit_solver.h>
#include <carom/core/export.h>
#include <carom/integrators/time_stepping/joint_stage.h>
#include <carom/integrators/time_stepping/joint_turn.h>
#include <carom/integrators/time_stepping/newton_damping.h>
#include <carom/integrators/time_stepping/step_input.h>
#include <carom/integrators/time_stepping/step_rule.h>
#include <carom/integrators/time_stepping/step_trial.h>

#include <span>
#include <vector>

namespace carom {

/// The island that Newton's method works on.
struct NewtonIsland {
  std::span<const Index> components;  ///< ascending
  JointStages& joints;                ///< of all components of the model
  IslandProblem* contact;             ///< null where nothing touches
  SolverChain& chain;
};

/// Newton's method over one island at a time. Keeps memory only.
class CAROM_API NewtonIteration {
public:
  /// Outcome of a step of it.
  enum class Outcome : std::uint8_t { done, singular, unsolved };

  /// The first guess: loads that would leave the velocities as they are, to be corrected by the loads at the
  /// start as they grow with the motion.
  [[nodiscard]] Outcome start(const StepInput& in, const StepRule& rule, const NewtonIsland& island,
                              StepTrial& trial);
  /// One step from the iterate: impulses, and the guess that leads to the new velocities. Where joints bind
  /// bodies it is for the guess alone, which the sweep behind it takes as any other.
  [[nodiscard]] Outcome step(const StepInput& in, const StepRule& rule, const NewtonIsland& island,
                             StepTrial& trial);
  /// True if steps are made by sweep_untouched(): joints bind bodies, and nothing touches or rubs.
  [[nodiscard]] bool follows_rows() const { return follows_rows_; }
  /// A sweep of one component where joints bind bodies and nothing touches or rubs.
  [[nodiscard]] Outcome sweep_untouched(const StepInput& in, const StepRule& rule, JointIterate& joints,
                                        StepTrial& trial);
  /// Change of a component by the last step.
  [[nodiscard]] SweepChange change(const StepInput& in, Index component, const StepTrial& trial) const;
  /// Takes note of how the iteration contracts: badly with a matrix that is out of date.
  void note_contraction(int sweeps, double contraction);

private:
  [[nodiscard]] bool linearise(const StepInput& in, const NewtonIsland& island, const StateView& at,
                               const Evaluation& evaluation);
  [[nodiscard]] Outcome step_with_joints(const StepInput& in, const StepRule& rule,
                                         const NewtonIsland& island, StepTrial& trial);
  void solve(const StepTrial& trial, JointStage* joints, const LinearisedComponent& component);
  [[nodiscard]] SweepChange change(const StepInput& in, std::span<const Index> components,
                                   const StepTrial& trial) const;
  void begin_untouched(const StepInput& in, const StepRule& rule, JointIterate& joints, StepTrial& trial);
  [[nodiscard]] bool correct_untouched(const StepInput& in, const StepRule& rule, JointIterate& joints,
                                       StepTrial& trial);

  std::vector<ImplicitSolver> matrices_;         // by component of the island, and more
  std::vector<LinearisedComponent> linearised_;  // of the island
  bool stale_ = false;                           // the matrices are to be made anew
  bool follows_rows_ = false;
  NewtonDamping damping_;
  Delassus by_masses_;  // impulses as the sweep behind applies them
  JointTurn turn_;
  std::vector<double> update_, scratch_, residuals_, multipliers_, ahead_;
};

}  // namespace carom
