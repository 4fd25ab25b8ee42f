// Problem: make the end of a step the state, and tell the report and the statistics what it did.

#include <carom/integrators/time_stepping/step_balance.h>
#include <carom/integrators/time_stepping/step_commit.h>

#include <algorithm>
#include <utility>

namespace carom {

namespace {

/// Counts the contacts of a step, and takes over the modes of those that last, behind those of joints.
void take_contacts(StepResult& result, Companion& companion) {
  Statistics& statistics = companion.statistics;
  const ContactTally& tally = result.tally;
  statistics.contact_steps += static_cast<std::int64_t>(result.report.contacts.size());
  statistics.impacts += tally.impacts;
  statistics.several_solutions += tally.several_solutions;
  statistics.forces_not_unique += tally.forces_not_unique;
  statistics.deepest_gap = std::min(statistics.deepest_gap, tally.deepest_gap);
  statistics.worst_residual = std::max(statistics.worst_residual, tally.worst_residual);
  if (!result.report.contacts.empty()) statistics.count_step(tally.worst_residual);
  if (result.joint_friction_modes.empty()) return companion.modes.swap(result.contact_modes);
  companion.modes = result.joint_friction_modes;
  companion.modes.insert(companion.modes.end(), result.contact_modes.begin(), result.contact_modes.end());
}

/// Takes the report over, and gives the room of the last one back. Findings stay: they are of the model.
void hand_over(StepReport& made, StepReport& report) {
  static_cast<StepNumbers&>(report) = made;
  report.contacts.swap(made.contacts);
  if (!report.joint_impulses.empty() || !made.joint_impulses.empty()) {
    report.joint_impulses.swap(made.joint_impulses);
  }
}

}  // namespace

void commit(const StepInput& in, StepMemory& memory, StepTrial& trial, StepResult& result, State& state,
            Companion& companion, StepReport& report) {
  const double step = in.step;
  memory.joints->record(step, companion.joints);
  take_end(in, memory.mean, trial, state, companion);
  if (memory.guesses) {  // else no loads change
    PresentLoads& loads = companion.loads;
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
  companion.ledger.book(result.flows, result.stored);
  if (!companion.contacts.empty() || !result.contacts.empty()) std::swap(companion.contacts, result.contacts);
  take_contacts(result, companion);
  count_step(result.report, companion.statistics);
  companion.statistics.cut_sequences += result.cut_sequences;
  companion.statistics.scaled_impacts += result.scaled_impacts;
  companion.statistics.plastic_jams += result.plastic_jams;
  hand_over(result.report, report);
}

}  // namespace carom
