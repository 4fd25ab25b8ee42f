// Problem: make the end of a step the state, and tell the report and the statistics what it did.

#include <carom/integrators/time_stepping/step_balance.h>

#include <algorithm>
#include <utility>

namespace carom {

namespace {

/// Counts the contacts of a step, and lists the modes of those that last: records are large, and are gone
/// through once.
void take_contacts(const StepReport& report, double end_time, Companion& companion) {
  Statistics& statistics = companion.statistics;
  double residual = 0.0;
  for (const ContactRecord& contact : report.contacts) {
    ++statistics.contact_steps;
    if (contact.impact) ++statistics.impacts;
    if (contact.outcome == Outcome::several_solutions) ++statistics.several_solutions;
    if (contact.outcome == Outcome::forces_not_unique) ++statistics.forces_not_unique;
    statistics.deepest_gap = std::min(statistics.deepest_gap, contact.gap);
    residual = std::max(residual, contact.residual);
    if (contact.time < end_time) continue;  // an impact within the step, or contact up to it
    companion.modes.emplace_back(contact.key, contact.mode);
  }
  if (report.contacts.empty()) return;
  statistics.worst_residual = std::max(statistics.worst_residual, residual);
  statistics.count_step(residual);
}

void add_to(Statistics& statistics, const StepReport& report) {
  ++statistics.steps;
  statistics.sweeps += report.sweeps;
  ++statistics.steps_by_iteration[static_cast<std::size_t>(report.iteration)];
  statistics.fallbacks += report.fallbacks;
  statistics.most_sweeps = std::max(statistics.most_sweeps, report.sweeps);
  statistics.largest_contraction = std::max(statistics.largest_contraction, report.contraction);
  if (report.energy_gain > report.lasting_gain) {
    ++statistics.energy_gains;
    statistics.energy_gained += report.energy_gain - report.lasting_gain;
  }
  if (report.lasting_gain > 0.0) {
    ++statistics.lasting_gains;
    statistics.lasting_gained += report.lasting_gain;
  }
}

/// Takes the report over, and gives the room of the last one back. Findings stay: they are of the model.
void hand_over(StepReport& made, StepReport& report) {
  static_cast<StepNumbers&>(report) = made;
  report.contacts.swap(made.contacts);
  report.joint_impulses.swap(made.joint_impulses);
}

}  // namespace

void commit(const StepInput& in, StepMemory& memory, StepTrial& trial, StepResult& result, State& state,
            Companion& companion, StepReport& report) {
  const double step = in.step, end_time = in.end_time;
  memory.joints->record(step, companion.joints);
  std::swap(state.q, trial.end.q);
  std::swap(state.v, trial.end.v);
  std::swap(state.z, trial.end.z);
  state.time = end_time;
  PresentLoads& loads = companion.loads;
  loads.valid = true;
  loads.mean = memory.mean;
  companion.history.step = step;
  if (memory.guesses) {  // else no loads change
    loads.total.swap(trial.loads_end.total);
    loads.dissipative.swap(trial.loads_end.dissipative);
    loads.external.swap(trial.loads_end.external);
    // The loads at the start are kept as those to which the next step compares its own.
    companion.history = std::move(trial.history);
    companion.history.sweeps.assign(memory.sweeps.begin(), memory.sweeps.end());
    companion.history.go_on(step, trial.loads_end.total.size());
    companion.history.before.swap(trial.loads_end.total);
    companion.iterations.swap(memory.iterations);
  } else {
    companion.iterations.clear();
  }
  std::swap(companion.rounding, trial.rounding);
  companion.ledger.book(result.flows, result.stored);
  if (!companion.contacts.empty() || !result.contacts.empty()) std::swap(companion.contacts, result.contacts);
  companion.modes = result.joint_friction_modes;
  take_contacts(result.report, end_time, companion);
  add_to(companion.statistics, result.report);
  companion.statistics.cut_sequences += result.cut_sequences;
  companion.statistics.scaled_impacts += result.scaled_impacts;
  companion.statistics.plastic_jams += result.plastic_jams;
  hand_over(result.report, report);
}

}  // namespace carom
