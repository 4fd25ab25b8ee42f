// Options of the modes.

#include "bind.h"
#include "types.h"

namespace carom_python {

using namespace carom;

void bind_options(nb::module_& core) {
  bind_record<StepControl>(core, "StepControl", {"StepControl"}, true, [](auto& fields) {
    fields("tolerance", &StepControl::tolerance)("smallest", &StepControl::smallest)("largest",
                                                                                     &StepControl::largest);
  });
  bind_record<SweepBudget>(core, "SweepBudget", {"SweepBudget"}, true, [](auto& fields) {
    fields("residual", &SweepBudget::residual)("sweeps", &SweepBudget::sweeps)("accepted",
                                                                               &SweepBudget::accepted);
  });
  bind_record<ImpactRules>(core, "ImpactRules", {"ImpactRules"}, true, [](auto& fields) {
    fields("order", &ImpactRules::order)("sequence_limit", &ImpactRules::sequence_limit)(
        "energy_gain", &ImpactRules::energy_gain)("refuse_jams", &ImpactRules::refuse_jams);
  });
  bind_record<OverlapRules>(core, "OverlapRules", {"OverlapRules"}, true, [](auto& fields) {
    fields("largest_at_start", &OverlapRules::largest_at_start)(
        "separate_at_start", &OverlapRules::separate_at_start)("never_tunnel", &OverlapRules::never_tunnel);
  });
  bind_record<TimeStepping>(core, "TimeStepping", {"TimeStepping"}, true, [](auto& fields) {
    using T = TimeStepping;
    fields("step", &T::step)("tolerance", &T::tolerance)("max_sweeps", &T::max_sweeps)(
        "capture_speed", &T::capture_speed)("impact_rules", &T::impact_rules)("impacts", &T::impacts)(
        "most_impacts", &T::most_impacts)("force_rule", &T::force_rule)("iteration", &T::iteration)(
        "project_gaps", &T::project_gaps)("control", &T::control)("threads", &T::threads)(
        "failure_directory", &T::failure_directory)("contact_budget", &T::contact_budget)("overlaps",
                                                                                          &T::overlaps);
  });
  bind_record<EventDriven>(core, "EventDriven", {"EventDriven"}, true, [](auto& fields) {
    using T = EventDriven;
    fields("relative_tolerance", &T::relative_tolerance)("absolute_tolerance", &T::absolute_tolerance)(
        "method", &T::method)("interval", &T::interval)("longest_step", &T::longest_step)(
        "gap_tolerance", &T::gap_tolerance)("capture_speed", &T::capture_speed)(
        "impact_rules", &T::impact_rules)("largest_projection", &T::largest_projection)(
        "event_limit", &T::event_limit)("step_limit", &T::step_limit)(
        "evaluation_limit", &T::evaluation_limit)("record_events", &T::record_events)(
        "record_limit", &T::record_limit)("failure_directory", &T::failure_directory);
  });
}

}  // namespace carom_python
