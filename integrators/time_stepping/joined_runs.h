#pragma once

/// \file
/// The end of a step whose coupling sets were advanced one by one.

#include <carom/core/assembly.h>
#include <carom/core/export.h>
#include <carom/integrators/run/companion.h>
#include <carom/integrators/run/step_report.h>
#include <carom/integrators/time_stepping/set_phases.h>

#include <span>
#include <vector>

namespace carom {

/// Puts the ends of steps together. Keeps memory only.
class CAROM_API JoinedRuns {
public:
  /// \param assembly must outlive it
  explicit JoinedRuns(const Assembly& assembly) : assembly_(&assembly) {}

  /// Makes one state, companion and report, but for the findings, which stay, and StepReport::steps_made.
  /// \param runs of sets that together have all bodies, each once
  /// \param state where the step begins; out: where it ends
  /// \param companion where the step begins; out: where it ends
  void join(const WholeStep& whole, std::span<SetRun> runs, State& state, Companion& companion,
            StepReport& report);

private:
  void take_iterations(std::span<const SetRun> runs, IterationMemory& to);
  void put_in_order(std::vector<ContactRecord>& contacts);

  const Assembly* assembly_;
  StepReport report_;
  std::vector<IterationMemory::Entry> entries_;
  std::vector<Index> order_;
  std::vector<ContactRecord> records_;
};

}  // namespace carom
