#pragma once

/// \file
/// Several components that contact joins in a step, of which some have joints (joint_stage.h). One problem of
/// contact, W = H B H^T, with B = K for the components with joints and M^-1 for the others; each component
/// moves as it does alone, with the velocities that contact gives it.

#include <carom/contact/island_problem.h>
#include <carom/core/assembly.h>
#include <carom/core/dynamics/components_response.h>
#include <carom/core/export.h>
#include <carom/integrators/time_stepping/joint_stage.h>
#include <carom/integrators/time_stepping/step_input.h>
#include <carom/integrators/time_stepping/step_islands.h>
#include <carom/integrators/time_stepping/step_rule.h>
#include <carom/integrators/time_stepping/step_trial.h>

#include <vector>

namespace carom {

/// Sweeps over islands of several components, of which some have joints. Keeps memory only.
class CAROM_API JoinedMechanisms {
public:
  /// \param assembly,stages must outlive it
  JoinedMechanisms(const Assembly& assembly, JointStages& stages);

  /// True if an island has several components, and one of them joints.
  [[nodiscard]] bool takes(const StepIsland& island) const;
  /// The first guess, and the matrix of the problem.
  void start(const StepInput& in, const StepIsland& island, IslandProblem& problem, StepTrial& trial);
  /// Makes the matrix again, after another stage has made its own.
  void respond(IslandProblem& problem) { problem.respond(response_); }
  /// One sweep. False if the problem is not solved.
  [[nodiscard]] bool sweep(const StepInput& in, const StepRule& rule, const StepIsland& island,
                           IslandProblem& problem, SolverChain& chain, StepTrial& trial);
  /// Change that the sweep has made to the components with joints, with the growth of rounding in them.
  void take_change(const StepInput& in, const StepIsland& island, const StepTrial& trial,
                   SweepChange& change);
  /// Largest distance of a component from obeying its joints, as JointStage::violation().
  [[nodiscard]] double violation(const StepInput& in, const StepIsland& island, StepTrial& trial);

private:
  void free_component(const StepInput& in, const StepRule& rule, Index component, StepTrial& trial);

  const Assembly* assembly_;
  JointStages* stages_;
  std::vector<JointConstraints*> joints_;  // of the island, at the start of the step
  ComponentsResponse response_;            // of its bodies
  std::vector<double> velocity_, change_;  // over all velocities: without contact; by contact
};

}  // namespace carom
