#pragma once

/// \file
/// Impacts at the start of a step, where not every contact follows Newton's law, or impacts are sequential,
/// or their energy is limited, or nothing may pass through anything: what closes faster than the capture
/// speed is resolved at the velocities v_j, as in the event-driven mode; the step follows from the velocities
/// after it, and its contacts have e = 0. A contact that closes more slowly does not rebound, unless it is
/// located and nothing presses it (ClosingNotes). Which constraints take part: impacts_of_steps.

#include <carom/contact/island_partition.h>
#include <carom/contact/island_problem.h>
#include <carom/contact/solvers/solver_chain.h>
#include <carom/contact/strike.h>
#include <carom/core/constraint_set.h>
#include <carom/core/dynamics/components_response.h>
#include <carom/core/dynamics/joint_constraints.h>
#include <carom/core/export.h>
#include <carom/integrators/run/impact_note.h>
#include <carom/integrators/time_stepping/capture_rule.h>
#include <carom/integrators/time_stepping/contact_stage.h>
#include <carom/integrators/time_stepping/step_balance.h>
#include <carom/integrators/time_stepping/step_input.h>
#include <carom/integrators/time_stepping/step_islands.h>
#include <carom/integrators/time_stepping/step_model.h>

#include <span>
#include <vector>

namespace carom {

/// Resolves such impacts. Keeps memory, and statistics of its solvers.
class CAROM_API StepImpacts {
public:
  /// \param model must outlive it
  explicit StepImpacts(const StepModel& model);

  /// True if impacts are resolved at the start of steps.
  [[nodiscard]] bool on() const { return on_; }
  /// Resolves the impacts of a step whose constraints are found. True if there were any: start() is the state
  /// after them, result() what they did. Throws SolverError where one is not solved, or is refused.
  /// \param islands of the step \param trial rotations in it are worked with
  [[nodiscard]] bool resolve(const StepInput& in, std::span<const StepIsland> islands, StepTrial& trial);
  /// State after the impacts.
  [[nodiscard]] const State& start() const { return start_; }
  /// Works and records of the impacts.
  [[nodiscard]] const StepResult& result() { return balance_.result(); }
  /// Takes the restitution from the constraints of a step.
  static void remove_restitution(std::span<const StepIsland> islands);
  /// Solvers.
  [[nodiscard]] SolverChain& chain() { return chain_; }

private:
  [[nodiscard]] bool is_noted(const std::vector<ConstraintKey>& keys, bool all, const Constraint& contact,
                              const double* v) const;
  void resolve_island(const StepInput& in, std::span<const Constraint> contacts, StepTrial& trial);
  [[nodiscard]] double fastest(std::span<const Constraint> contacts) const;
  [[nodiscard]] StrikeAnswer solve(ImpactLaw law);
  [[nodiscard]] StepErrors errors(const StepInput& in, StepTrial& trial) const;
  void place_joints(const StepInput& in, StepTrial& trial);
  void apply(const StepInput& in, const ImpactNote& note, const IslandProblem& problem, StepTrial& trial);

  const StepModel* model_;
  bool on_;
  CaptureRule capture_;
  State start_;
  StepBalance balance_;
  IslandPartition partition_;
  ImpactProblems problems_;
  SolverChain chain_;
  std::vector<JointConstraints> joints_;
  std::vector<JointConstraints*> list_;  // of them
  ComponentsResponse response_;
  ConstraintSet contacts_, touching_;
};

}  // namespace carom
