#pragma once

/// \file
/// The time-stepping mode: one step from t_j to t_{j+1} (Johansson 1999, section 4). Its page is
/// time_stepper.cpp:
///
///   contacts     those with gap <= 0 at t_j, and of the step before those that turning has opened; against
///                the velocities of moving ground shapes at t_j and t_{j+1}
///   guess        F_{j+1} by extrapolation
///   repeat       v_free = v_j + M^-1 h (F_j + F_{j+1})/2
///                v_{j+1} = v_free + M^-1 H^T P,  P from the contact problem
///                q_{j+1} = q_j advanced by h (v_j + v_{j+1})/2
///                F_{j+1} = F(q_{j+1}, v_{j+1}, t_{j+1})
///   until        with these loads for the guess positions and h times velocities would no longer change.
///
/// Joints: joint_stage.h. Rules: step_rule.h. The order of stages and blocks: sweep_schedule.h.

#include <carom/core/assembly.h>
#include <carom/core/dynamics/prescribed_joints.h>
#include <carom/core/export.h>
#include <carom/integrators/run/companion.h>
#include <carom/integrators/run/step_report.h>
#include <carom/integrators/run/stop_request.h>
#include <carom/integrators/run/time_stepping.h>
#include <carom/integrators/time_stepping/contact_turning.h>
#include <carom/integrators/time_stepping/island_steps.h>
#include <carom/integrators/time_stepping/step_constraints.h>
#include <carom/integrators/time_stepping/step_impacts.h>
#include <carom/integrators/time_stepping/step_model.h>
#include <carom/integrators/time_stepping/step_trial.h>
#include <carom/integrators/time_stepping/uncoupled_step.h>

#include <memory>
#include <optional>
#include <span>

namespace carom {

/// Advances states of one assembly. Owns workspaces only: what a step depends on is state, companion,
/// options.
class CAROM_API TimeStepper {
public:
  /// Throws ModelError for impossible options or a contact without a law.
  /// \param stop asked between sweeps, may be null; must outlive this
  TimeStepper(const Assembly& assembly, const TimeStepping& options, const StopRequest* stop = nullptr);

  /// Makes one step of length `step` [s] whose end is called `end_time`. On success state and companion are
  /// those at its end and `report` tells what happened; on an error none of the three has changed, nor where
  /// StepPart::stops has ended it: then it is false.
  bool step(State& state, Companion& companion, double step, double end_time, StepReport& report,
            const StepPart& part = {});

  /// Options.
  [[nodiscard]] const TimeStepping& options() const { return model_.options; }
  /// True if a step is to end where contacts close, so that its rest begins with the impact (set_phases.h).
  [[nodiscard]] bool ends_at_closings() const { return model_.ends_at_closings; }
  /// How the last step was made.
  struct LastStep {
    int passes;                           ///< how often: again where contacts turn in it (contact_turning.h)
    const State& end;                     ///< of the last pass: of a step that was made not known any more
    const State* after_impacts;           ///< its start behind impacts there; null if there were none
    std::span<const StepIsland> islands;  ///< components that contact joined
    StepFlights* flights;                 ///< of bodies that were hit within it
    const StepProjection* projection;     ///< what TimeStepping::project_gaps has moved at its end
  };
  /// The last step. Valid until the next one.
  [[nodiscard]] LastStep last() {
    return {passes_,
            trial_.end,
            struck_ ? &impacts_->start() : nullptr,
            constraints_.islands(),
            &islands_.books().flights(),
            &islands_.projection()};
  }
  /// All components, batch by batch.
  [[nodiscard]] std::span<const Range> batches() const { return model_.batches.all(); }
  /// Names of contacts.
  [[nodiscard]] const Detector& detector() const { return model_.detector; }

private:
  void evaluate_start(const StepInput& in, Companion& companion);
  [[nodiscard]] bool step_from(const StepInput& in, State& state, Companion& companion, StepReport& report);
  [[nodiscard]] bool strike(const StepInput& in);
  [[nodiscard]] bool make_step(const StepInput& in);
  void give_up(const StepInput& in, Companion& companion);
  void prepare(const StepInput& in);
  void advance_all(const StepInput& in);
  [[nodiscard]] std::span<const Range> batches_of(const StepInput& in) const {
    return model_.batches.of(in.part.scope);
  }

  StepConstraints constraints_;
  StepModel model_;
  StepTrial trial_;
  IslandSteps islands_;
  std::unique_ptr<StepImpacts> impacts_;  // null where all impacts are those of the step
  std::unique_ptr<ContactTurning>
      turning_;                             // null where contacts act along their rows at the start of a step
  std::optional<UncoupledStep> uncoupled_;  // none where no step is one
  PrescribedJoints prescribed_;
  int passes_ = 1;                   // of the last step
  bool struck_ = false;              // there were impacts at the start of the step at hand
  PresentLoads loads_before_;        // these
  Flight flown_ = Flight::not_free;  // of the step at hand
};

}  // namespace carom
