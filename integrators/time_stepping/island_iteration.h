#pragma once

/// \file
/// The implicit equations of a step over one island: sweeps from the guess at the loads to impulses, bodies
/// and the loads that they lead to, until the next sweep would change no more than the tolerance.

#include <carom/core/export.h>
#include <carom/core/numerics/fixed_point.h>
#include <carom/integrators/run/stop_request.h>
#include <carom/integrators/time_stepping/island_joints.h>
#include <carom/integrators/time_stepping/load_iteration.h>
#include <carom/integrators/time_stepping/located_impacts.h>
#include <carom/integrators/time_stepping/step_constraints.h>
#include <carom/integrators/time_stepping/step_input.h>
#include <carom/integrators/time_stepping/step_model.h>
#include <carom/integrators/time_stepping/sweep_schedule.h>

#include <utility>
#include <vector>

namespace carom {

/// Iterates islands. Keeps memory only.
class CAROM_API IslandIteration {
public:
  /// All must outlive it. \param stop asked between sweeps, may be null
  IslandIteration(const StepModel& model, const StepConstraints& constraints, SweepSchedule& schedule,
                  ContactStage& contacts, LocatedImpacts& located, JointStages& joints, StepTrial& trial,
                  const StopRequest* stop);

  /// Uses another iteration.
  void use(Iteration iteration) { method_.use(iteration); }
  /// A sweep over one component, stage by stage.
  [[nodiscard]] SweepStages sweep_of(const StepInput& in, Index component) const {
    return {in,      model_->rule, component, *contacts_, *trial_, joint_stages_->of(component) != nullptr,
            located_};
  }
  /// The one in use.
  [[nodiscard]] Iteration current() const { return method_.current(); }
  /// Solves the equations of an island. Returns what is known of the loads of the last iterate. Throws
  /// SolverError, with the trial as it failed.
  [[nodiscard]] LoadsKnown solve(const StepIsland& island, const StepInput& in, FixedPointJudge& judge);

  /// Sweeps that the components needed when they were iterated last; 1 if they never were.
  [[nodiscard]] const std::vector<int>& sweeps() const { return sweeps_; }
  /// The most sweeps around contacts alone since the last call.
  [[nodiscard]] int take_local_sweeps() { return std::exchange(local_sweeps_, 0); }

private:
  /// One sweep, or two in one pass.
  struct SweepsMade {
    SweepChange change;                    // that another would make, or that it made
    LoadsKnown known = LoadsKnown::total;  // of the loads that it led to
    bool converged_one_early = false;      // of two the first was enough
  };
  [[nodiscard]] LoadsKnown iterate(const StepIsland& island, const StepInput& in, FixedPointJudge& judge);
  [[nodiscard]] IslandContact contact_of(const StepIsland& island);
  void begin(const StepIsland& island, const StepInput& in);
  [[nodiscard]] bool find_impacts(const StepIsland& island, const StepInput& in);
  [[nodiscard]] bool loads_jump(const StepIsland& island, const StepInput& in, bool local);
  [[nodiscard]] bool contacts_return(const StepInput& in) const;
  void presolve(const StepIsland& island, const StepInput& in);
  [[nodiscard]] SweepsMade sweep_streamed(const SweepStages& stages, int expected, FixedPointJudge& judge);
  [[nodiscard]] SweepsMade sweep_staged(const StepIsland& island, const StepInput& in, int expected,
                                        const FixedPointJudge& judge);
  void sweep_joints(const StepIsland& island, const StepInput& in);
  void follow(const StepInput& in, Index component);
  [[nodiscard]] bool converge_joints(const StepIsland& island, const StepInput& in);
  [[nodiscard]] bool is_streamed(const StepIsland& island) const;
  [[nodiscard]] NewtonIsland newton_island(const StepIsland& island);
  void improve(const StepIsland& island, const StepInput& in, const FixedPointJudge& judge);
  void demand(NewtonIteration::Outcome outcome, const StepIsland& island, const StepInput& in);
  [[noreturn]] void fail_contraction(const StepIsland& island, const StepInput& in,
                                     const FixedPointJudge& judge);

  const StepModel* model_;
  const StepConstraints* constraints_;
  SweepSchedule* schedule_;
  ContactStage* contacts_;
  LocatedImpacts* located_;
  JointStages* joint_stages_;
  StepTrial* trial_;
  const StopRequest* stop_;  // may be null
  LoadIteration method_;
  IslandJoints joints_;      // of the island at hand
  std::vector<int> sweeps_;  // by component
  int local_sweeps_ = 0;
  int jump_updates_ = 0;  // of the island at hand
};

}  // namespace carom
