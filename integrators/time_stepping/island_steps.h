#pragma once

/// \file
/// Advances islands through a step, each by itself, and books them. An island whose loads do not change is
/// one sweep (constant_steps.cpp); all others are iterated (island_iteration.h).

#include <carom/core/export.h>
#include <carom/integrators/run/stop_request.h>
#include <carom/integrators/time_stepping/contact_stage.h>
#include <carom/integrators/time_stepping/coupling_watch.h>
#include <carom/integrators/time_stepping/island_books.h>
#include <carom/integrators/time_stepping/island_iteration.h>
#include <carom/integrators/time_stepping/joint_stage.h>
#include <carom/integrators/time_stepping/located_impacts.h>
#include <carom/integrators/time_stepping/step_balance.h>
#include <carom/integrators/time_stepping/step_constraints.h>
#include <carom/integrators/time_stepping/step_input.h>
#include <carom/integrators/time_stepping/step_islands.h>
#include <carom/integrators/time_stepping/step_model.h>
#include <carom/integrators/time_stepping/step_projection.h>
#include <carom/integrators/time_stepping/step_trial.h>
#include <carom/integrators/time_stepping/sweep_schedule.h>
#include <carom/integrators/time_stepping/uncoupled_step.h>

#include <span>

namespace carom {

/// The islands of one step at a time. Throws SolverError, with the trial as it failed.
class CAROM_API IslandSteps {
public:
  /// All must outlive it. \param stop asked between sweeps, may be null
  IslandSteps(const StepModel& model, StepConstraints& constraints, StepTrial& trial,
              const StopRequest* stop);
  IslandSteps(const IslandSteps&) = delete;  // its parts know each other
  IslandSteps& operator=(const IslandSteps&) = delete;

  /// Begins a step, or one that is made again. \param impacts at its start; null: none
  void begin(const StepInput& in, const StepResult* impacts);
  /// Advances an island to the end of the step, and books it.
  void advance(const StepIsland& island, const StepInput& in);
  /// Advances all bodies of a model that nothing couples, over ground at rest, and books them. \param flown
  /// how far they have come with the step
  void advance(UncoupledStep& uncoupled, Flight flown, const StepInput& in);

  /// The account of the step.
  [[nodiscard]] IslandBooks& books() { return books_; }
  /// How the components of the step were iterated.
  [[nodiscard]] StepMemory& memory();
  /// The stage that has moved bodies out of others at the end of the step.
  [[nodiscard]] StepProjection& projection() { return projection_; }
  /// Contact.
  [[nodiscard]] ContactStage& contacts() { return contacts_; }
  /// Bodies that are hit within the step.
  [[nodiscard]] LocatedImpacts& located() { return located_; }
  /// Joints.
  [[nodiscard]] JointStages& joints() { return joints_; }

private:
  void iterate_automatically(const StepIsland& island, const StepInput& in, FixedPointJudge& judge);
  void book(const StepIsland& island, const StepInput& in, LoadsKnown known);
  void move_apart(const StepIsland& island, const StepInput& in);
  void advance_under_constant_loads(const StepIsland& island, const StepInput& in);
  void advance_part_by_part(const StepIsland& island, const StepInput& in);
  void advance_loose(UncoupledStep& uncoupled, std::span<const LooseBodies> pieces, bool flown,
                     const StepInput& in);
  void solve_part(const StepIsland& part, const StepInput& in);
  void locate(Range components, std::span<const Constraint> contacts, const StepInput& in);

  const StepModel* model_;
  StepConstraints* constraints_;
  StepTrial* trial_;
  SweepSchedule schedule_;
  ContactStage contacts_;
  LocatedImpacts located_;
  JointStages joints_;
  IslandIteration iteration_;
  IslandBooks books_;
  StepProjection projection_;
  CouplingWatch couplings_;
  StepMemory memory_;
};

}  // namespace carom
