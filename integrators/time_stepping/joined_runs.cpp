// Problem: bodies were advanced set by set; make one state, one companion and one report of them.

#include <carom/integrators/time_stepping/added_reports.h>
#include <carom/integrators/time_stepping/joined_runs.h>
#include <carom/integrators/time_stepping/step_commit.h>

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace carom {

namespace {

/// Copies the numbers of some places, where there are any.
template <class T>
void copy(const std::vector<T>& from, Range places, std::vector<T>& to) {
  if (from.empty()) return;
  to.resize(from.size());
  std::copy(from.begin() + places.begin, from.begin() + places.end, to.begin() + places.begin);
}

/// Takes what is known by body: places, velocities, loads.
void take_numbers(const Assembly& assembly, const SetRun& run, State& state, Companion& companion) {
  run.scope.for_each([&](Index component) {
    const Component& of = assembly.components()[component];
    copy(run.state.q, of.q, state.q);
    copy(run.state.v, of.v, state.v);
    copy(run.state.z, of.z, state.z);
    copy(run.companion.rounding, of.v, companion.rounding);
    copy(run.companion.loads.total, of.v, companion.loads.total);
    copy(run.companion.loads.dissipative, of.v, companion.loads.dissipative);
    copy(run.companion.loads.external, of.v, companion.loads.external);
  });
  companion.loads.valid = run.companion.loads.valid;
  companion.loads.mean = run.companion.loads.mean;
}

/// Takes the impulses of contacts, per length of the whole step.
void take_impulses(const ContactHistory& from, ContactHistory& to) {
  for (std::size_t i = 0; i < from.starts.size(); ++i) {
    SweepStart start = from.starts[i];
    if (from.step != to.step) {
      for (double& impulse : start.impulse) impulse *= to.step / from.step;
      start.kept = 0;
    }
    to.add(from.contacts.keys()[i], start);
  }
}

/// Takes what is known by contact.
void take_contacts(const Companion& from, Companion& to) {
  to.modes.insert(to.modes.end(), from.modes.begin(), from.modes.end());
  take_impulses(from.contacts, to.contacts);
  to.closings.free.insert(to.closings.free.end(), from.closings.free.begin(), from.closings.free.end());
  to.closings.cut.insert(to.closings.cut.end(), from.closings.cut.begin(), from.closings.cut.end());
}

/// Adds what is counted by contact, and takes extremes in.
void add_counts(const ContactCounts& from, ContactCounts& to) {
  to.impacts += from.impacts;
  to.contact_steps += from.contact_steps;
  to.several_solutions += from.several_solutions;
  to.forces_not_unique += from.forces_not_unique;
  to.cut_sequences += from.cut_sequences;
  to.scaled_impacts += from.scaled_impacts;
  to.plastic_jams += from.plastic_jams;
  to.deepest_gap = std::min(to.deepest_gap, from.deepest_gap);
  to.worst_residual = std::max(to.worst_residual, from.worst_residual);
}

/// Counts the step.
void count(const StepReport& report, std::span<const SetRun> runs, Statistics& statistics) {
  double worst = 0.0;
  for (const SetRun& run : runs) {
    const Statistics& of = run.companion.statistics;
    add_counts(of, statistics);
    worst = std::max(worst, of.worst_residual);
  }
  count_step(report, statistics);
  if (!report.contacts.empty()) statistics.count_step(worst);
}

/// Forgets the course of loads and joints: steps of sets had different lengths.
void forget_course(const WholeStep& whole, const SetRun& last, Companion& companion) {
  companion.history.known = 0;
  companion.history.pending = false;
  companion.history.before.clear();
  companion.history.step = whole.step;
  companion.history.sweeps = last.companion.history.sweeps;
  companion.joints.clear();
}

}  // namespace

/// Takes memories of iterations, which are ordered by component.
void JoinedRuns::take_iterations(std::span<const SetRun> runs, IterationMemory& to) {
  entries_.clear();
  for (const SetRun& run : runs) {
    const std::vector<IterationMemory::Entry>& more = run.companion.iterations.entries();
    entries_.insert(entries_.end(), more.begin(), more.end());
  }
  std::sort(entries_.begin(), entries_.end(),
            [](const auto& a, const auto& b) { return a.component < b.component; });
  to.clear();
  for (const IterationMemory::Entry& entry : entries_) static_cast<void>(to.append(entry));
}

/// Puts records in the order of time; those of one time stay as they are.
void JoinedRuns::put_in_order(std::vector<ContactRecord>& contacts) {
  order_.clear();
  for (Index i = 0; i < contacts.size(); ++i) order_.push_back(i);
  std::sort(order_.begin(), order_.end(), [&](Index a, Index b) {
    return contacts[a].time < contacts[b].time || (contacts[a].time == contacts[b].time && a < b);
  });
  records_.clear();
  for (const Index i : order_) records_.push_back(contacts[i]);
  std::swap(contacts, records_);
}

void JoinedRuns::join(const WholeStep& whole, std::span<SetRun> runs, State& state, Companion& companion,
                      StepReport& report) {
  static_cast<StepNumbers&>(report_) = {};
  report_.contacts.clear();
  report_.joint_impulses.clear();
  report_.capped_problem.clear();
  StoredEnergies stored;
  companion.modes.clear();
  companion.contacts.start(whole.step);
  companion.closings.all_free = runs[0].companion.closings.all_free;
  companion.closings.free.clear();
  companion.closings.cut.clear();
  for (const SetRun& run : runs) {
    take_numbers(*assembly_, run, state, companion);
    take_contacts(run.companion, companion);
    companion.contact_statistics += run.companion.contact_statistics;
    companion.ledger.add_flows(run.companion.ledger);
    for (std::size_t i = 0; i < stored_energy_count; ++i)
      stored.values[i] += run.companion.ledger.stored().values[i];
    carom::join(run.report, report_);
  }
  state.time = whole.end;
  report_.step = whole.step;
  put_in_order(report_.contacts);
  if (!companion.contacts.empty()) companion.contacts.contacts.finish();
  companion.ledger.book({}, stored);
  take_iterations(runs, companion.iterations);
  if (runs.size() == 1) {
    std::swap(companion.history, runs[0].companion.history);
    std::swap(companion.joints, runs[0].companion.joints);
  } else {
    forget_course(whole, runs.back(), companion);
  }
  count(report_, runs, companion.statistics);
  report_.findings.swap(report.findings);
  std::swap(report, report_);
}

}  // namespace carom
