#pragma once

/// \file
/// Sweeps over an island of which some components have joints (joint_stage.h). Contact of all of them is one
/// problem, W = H B H^T, with B = K for the components with joints and M^-1 for the others; each component
/// moves as it does alone, with the velocities that contact gives it. Friction in joints is bound by the
/// forces in them, whichever components contact has joined.

#include <carom/contact/detection/joint_rows.h>
#include <carom/contact/friction_bound_solver.h>
#include <carom/contact/friction_bounds.h>
#include <carom/contact/island_problem.h>
#include <carom/core/assembly.h>
#include <carom/core/dynamics/components_response.h>
#include <carom/core/export.h>
#include <carom/integrators/time_stepping/joint_stage.h>
#include <carom/integrators/time_stepping/step_input.h>
#include <carom/integrators/time_stepping/step_islands.h>
#include <carom/integrators/time_stepping/step_rule.h>
#include <carom/integrators/time_stepping/step_trial.h>

#include <span>
#include <vector>

namespace carom {

/// The contact problem of an island, and how it is solved.
struct IslandContact {
  std::span<Constraint> constraints;  ///< of the island
  IslandProblem* problem = nullptr;   ///< null where nothing touches or rubs
  SolverChain& chain;
  bool stale_matrix = false;  ///< W of the problem is that of another stage, and is to be made anew
};

/// The components of one island at a time. Keeps memory only.
class CAROM_API IslandJoints {
public:
  /// \param joints rows of joints, as detection finds them \param stages of all components. All must outlive
  /// it
  IslandJoints(const Assembly& assembly, const JointRows& joints, JointStages& stages);

  /// Takes an island.
  void bind(const StepIsland& island);
  /// True if a component of the island has joints.
  [[nodiscard]] bool any() const { return !jointed_.empty(); }
  /// The joints of its components that have some.
  [[nodiscard]] std::span<JointStage* const> jointed() const { return jointed_; }
  /// The joints of an island of one component; null where it has none, or there are several components.
  [[nodiscard]] JointStage* alone() const {
    return components_.size() == 1 && any() ? jointed_.front() : nullptr;
  }
  /// The first guess, and the matrix of the problem.
  void start(const StepInput& in, const StepRule& rule, Iteration iteration, const IslandContact& contact,
             StepTrial& trial);
  /// One sweep. False if the contact problem is not solved.
  [[nodiscard]] bool sweep(const StepInput& in, const StepRule& rule, const IslandContact& contact,
                           StepTrial& trial);
  /// Takes the change that the sweep has made to the components with joints, or that another would make, with
  /// the growth of rounding in them.
  void take_change(const StepInput& in, const StepTrial& trial, SweepChange& change);
  /// True if that change is to be judged as the one that another sweep would make.
  [[nodiscard]] bool looks_ahead() const;
  /// Largest distance of a component from obeying its joints (JointStage::violation()).
  [[nodiscard]] double violation(const StepInput& in, StepTrial& trial);
  /// True if a component is near a singular position.
  [[nodiscard]] bool is_near_singular() const;

private:
  void free_component(const StepInput& in, const StepRule& rule, Index component, StepTrial& trial);
  [[nodiscard]] bool react(const StepInput& in, const IslandContact& contact, StepTrial& trial);
  void respond(IslandProblem& problem, JointsTouch touch);

  const Assembly* assembly_;
  const JointRows* rows_of_joints_;
  JointStages* stages_;
  std::span<const Index> components_;         // of the island
  std::vector<JointStage*> jointed_;          // of those that have joints
  std::vector<FrictionBounds*> bounds_;       // of friction in them
  std::vector<JointConstraints*> rows_;       // that answer contact
  JointsTouch touch_ = JointsTouch::nothing;  // the island is touched
  ComponentsResponse response_;               // of its bodies
  FrictionBoundSolver bound_solver_;
  std::vector<double> velocity_, change_;  // over all velocities: without contact; by contact
};

}  // namespace carom
