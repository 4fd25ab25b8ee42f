#pragma once

/// \file
/// The parts that the pages of a step work with: what they share is here, and nothing else is shared.

#include <carom/core/assembly.h>
#include <carom/integrators/run/time_stepping.h>
#include <carom/integrators/time_stepping/contact_stage.h>
#include <carom/integrators/time_stepping/joint_stage.h>
#include <carom/integrators/time_stepping/located_impacts.h>
#include <carom/integrators/time_stepping/step_constraints.h>
#include <carom/integrators/time_stepping/step_errors.h>
#include <carom/integrators/time_stepping/step_flights.h>
#include <carom/integrators/time_stepping/step_rule.h>
#include <carom/integrators/time_stepping/step_trial.h>
#include <carom/integrators/time_stepping/sweep_schedule.h>

#include <algorithm>

namespace carom {

/// Parts of the steps of one assembly.
struct StepParts {
  /// \param model must outlive it \param chosen options that have been checked
  StepParts(const Assembly& model, const TimeStepping& chosen)
      : assembly(&model),
        options(chosen),
        rule(chosen.force_rule),
        constraints(model, chosen),
        contacts(model, chosen),
        located(model, constraints.detector(), chosen),
        trial(model, step_needs(model, constraints.detector(), rule.is_mean())),
        schedule(model, chosen, trial.needs),
        joints(model) {
    if (options.impacts == ImpactTimes::located) {
      constraints.allow_rounding(options.step, ends_at_closings());
    }
  }

  /// Stages of a component.
  [[nodiscard]] SweepStages stages(const StepInput& in, Index component) {
    return {in, rule, component, contacts, trial, joints.of(component) != nullptr, &located};
  }
  /// Errors of one.
  [[nodiscard]] StepErrors errors(const StepInput& in, Index component) {
    return {in, component, constraints.detector(), options, trial};
  }
  /// Errors of the component of the first body of a contact problem.
  [[nodiscard]] StepErrors errors(const StepInput& in, const IslandProblem& problem) {
    return errors(in, assembly->component_of(problem.constraints().front().body()));
  }
  /// Contacts that part at the start are free where impacts are located: their next closing is looked for.
  [[nodiscard]] Parting parting() const {
    return options.impacts == ImpactTimes::located ? Parting::is_free : Parting::acts;
  }
  /// True if impacts are located and LocatedImpacts does not find all of them: bodies touch each other,
  /// joints bind them, impacts have rules of their own, or Newton's method alone is to solve the step.
  [[nodiscard]] bool ends_at_closings() const {
    return options.impacts == ImpactTimes::located &&
           (!located.on() || constraints.detector().bodies_touch() || joints.any() ||
            options.iteration == Iteration::linearly_implicit);
  }
  /// The components of a step, batch by batch.
  [[nodiscard]] std::span<const Range> batches(const StepInput& in) const {
    return in.part.scope == nullptr ? schedule.batches() : in.part.scope->batches();
  }
  /// Tolerance of the iteration, for a part of a step less: velocities of short parts are as exact as those
  /// of long ones [m].
  [[nodiscard]] double tolerance(const StepInput& in) const { return in.part.share * options.tolerance; }
  /// The problem where bodies of an island answer together; null where nothing touches.
  [[nodiscard]] IslandProblem* problem() {
    return contacts.problems().empty() ? nullptr : &contacts.problems().front();
  }
  /// True if the loads of all components of an island are those at the start.
  [[nodiscard]] bool has_constant_loads(const StepIsland& island) const {
    return std::all_of(island.batches.begin(), island.batches.end(), [this](Range batch) {
      return schedule.coupling(batch.begin) == CouplingClass::constant_loads;
    });
  }

  const Assembly* assembly;
  TimeStepping options;
  StepRule rule;
  StepConstraints constraints;
  ContactStage contacts;
  LocatedImpacts located;
  StepTrial trial;
  SweepSchedule schedule;
  JointStages joints;
  StepFlights flights;
};

}  // namespace carom
