// Problem: decisions that hold for all steps of a run.

#include <carom/integrators/time_stepping/step_model.h>

namespace carom {

namespace {

/// True if impacts are located, and all are as those of LocatedMotion.
bool follow_newton(const Detector& detector, const TimeStepping& options) {
  const ImpactRules& rules = options.impact_rules;
  return options.impacts == ImpactTimes::located && rules.order == ImpactOrder::simultaneous &&
         rules.energy_gain != EnergyGain::limit && !has_other_impact_law(detector) &&
         !resists_rolling(detector);
}

}  // namespace

StepModel::StepModel(const Assembly& model, const TimeStepping& chosen, const Detector& contacts)
    : assembly(model),
      options(chosen),
      detector(contacts),
      rule(chosen.force_rule),
      needs(step_needs(model, contacts, rule.is_mean())),
      batches(model, chosen, needs.load_rotations),
      follows_bodies(follow_newton(contacts, chosen)),
      ends_at_closings(chosen.impacts == ImpactTimes::located &&
                       (!follows_bodies || contacts.bodies_touch() || has_joints(model) ||
                        chosen.iteration == Iteration::linearly_implicit)) {}

}  // namespace carom
