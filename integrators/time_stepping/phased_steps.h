#pragma once

/// \file
/// Steps in phases (set_phases.h), coupling set by coupling set. A closing ends a phase of its set, not of
/// the model: no load crosses a set, so that this is exact, with joints too.
///
/// A step is tried in one phase first, of all bodies. Where something closes on its way, sets are formed over
/// the boxes that bodies sweep on it (coupling_sets.h). The sets that have a closing start anew, each by
/// itself; then all others together, in one phase unless its last pass finds what the first one missed. Where
/// a body, once it was hit, comes near one of another set, both are one, which starts again.
///
/// A set whose phases have no solution is advanced in one, without closings: these are counted in the same
/// way. It fails where that has none either, or gains energy in impacts; and where jams or gains are to be
/// refused (ImpactRules), which one phase would hide.

#include <carom/core/assembly.h>
#include <carom/core/export.h>
#include <carom/integrators/run/companion.h>
#include <carom/integrators/run/step_report.h>
#include <carom/integrators/time_stepping/coupling_sets.h>
#include <carom/integrators/time_stepping/joined_runs.h>
#include <carom/integrators/time_stepping/set_phases.h>
#include <carom/integrators/time_stepping/time_stepper.h>

#include <cstddef>
#include <span>
#include <vector>

namespace carom {

/// Makes steps in phases. Owns workspaces only.
class CAROM_API PhasedSteps {
public:
  /// All must outlive it.
  PhasedSteps(const Assembly& assembly, TimeStepper& stepper);

  /// Makes a step as TimeStepper::step(), in as many phases as it takes. Throws SolverError naming the pair
  /// that needs too many; on an error none of the three has changed.
  void step(State& state, Companion& companion, double step, double end_time, StepReport& report);

private:
  [[nodiscard]] std::size_t make_sets(const State& state, const Companion& companion, const WholeStep& whole);
  void list_sets();
  void make(SetRun& run, const State& state, const Companion& companion, const WholeStep& whole);
  [[nodiscard]] std::size_t rest() const { return runs_[names_.size()].scope.bodies() > 0 ? 1 : 0; }
  void begin(SetRun& run, const State& state, const Companion& companion);
  [[nodiscard]] const StepClosing* first_of(const SetRun& run);

  const Assembly* assembly_;
  TimeStepper* stepper_;
  SetPhases phases_;
  CouplingSets sets_;
  std::vector<StepClosing> closings_;  // of the step in one phase
  std::vector<Box<2>> boxes_;          // that outlines of bodies sweep in the step
  std::vector<SetRun> runs_;           // of sets with closings, then of all others; some more for their room
  std::vector<Index> names_;           // of these sets
  std::size_t made_ = 0;               // the first so many are made
  struct {
    std::vector<Index> sizes, run_of;  // components, and the run, by set
  } numbers_;
  std::vector<std::vector<Index>> members_;  // components by run
  Evaluation evaluation_;
  JoinedRuns joined_;
};

}  // namespace carom
