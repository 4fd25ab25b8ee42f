#pragma once

/// \file
/// Decisions that follow from the model and the options of a run, the same in all its steps.

#include <carom/contact/detection/detector.h>
#include <carom/contact/island_problem.h>
#include <carom/core/assembly.h>
#include <carom/core/export.h>
#include <carom/integrators/run/time_stepping.h>
#include <carom/integrators/time_stepping/step_batches.h>
#include <carom/integrators/time_stepping/step_constraints.h>
#include <carom/integrators/time_stepping/step_errors.h>
#include <carom/integrators/time_stepping/step_input.h>
#include <carom/integrators/time_stepping/step_rule.h>
#include <carom/integrators/time_stepping/step_trial.h>

namespace carom {

/// Model and options of steps. All stages read it, none changes it.
struct CAROM_API StepModel {
  /// \param model,contacts must outlive it \param chosen options that have been checked
  StepModel(const Assembly& model, const TimeStepping& chosen, const Detector& contacts);

  /// Tolerance of the iteration, for a part of a step less: velocities of short parts are as exact as those
  /// of long ones [m].
  [[nodiscard]] double tolerance(const StepInput& in) const { return in.part.share * options.tolerance; }
  /// Contacts that part at the start are free where impacts are located: their next closing is looked for.
  [[nodiscard]] Parting parting() const {
    return options.impacts == ImpactTimes::located ? Parting::is_free : Parting::acts;
  }
  /// Errors of a component. \param trial as the step left it
  [[nodiscard]] StepErrors errors(const StepInput& in, Index component, StepTrial& trial) const {
    return {in, component, detector, options, trial};
  }
  /// Errors of the component of the first body of a contact problem. \param trial as the step left it
  [[nodiscard]] StepErrors errors(const StepInput& in, const IslandProblem& problem, StepTrial& trial) const {
    return errors(in, assembly.component_of(problem.constraints().front().body()), trial);
  }

  const Assembly& assembly;
  TimeStepping options;
  const Detector& detector;  ///< of contacts
  StepRule rule;
  StepNeeds needs;  ///< what steps ask the model for
  StepBatches batches;
  bool follows_bodies;  ///< impacts are located, and all of Newton's law, each of all contacts that are
                        ///< closed: those of bodies alone are found by LocatedImpacts
  /// Impacts are located and LocatedImpacts does not find all of them: bodies touch each other, joints bind
  /// them, impacts have rules of their own, or Newton's method alone is to solve the step. Then a step ends
  /// where contacts close, so that its rest begins with the impact (set_phases.h).
  bool ends_at_closings;
};

}  // namespace carom
