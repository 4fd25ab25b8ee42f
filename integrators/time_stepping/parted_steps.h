#pragma once

/// \file
/// Steps that nothing passes through anything in (OverlapRules::never_tunnel): a step in which a pair would
/// come too deep ends there, and the rest of it is another one, which begins with their impact.

#include <carom/core/assembly.h>
#include <carom/core/export.h>
#include <carom/integrators/run/companion.h>
#include <carom/integrators/run/step_report.h>
#include <carom/integrators/time_stepping/passage_search.h>
#include <carom/integrators/time_stepping/time_stepper.h>

namespace carom {

/// Parts steps. Owns workspaces only.
class CAROM_API PartedSteps {
public:
  /// Parts of one step at the most: more are needed only where something flies to and fro in it for ever.
  static constexpr int most_parts = 10000;

  /// Both must outlive it.
  PartedSteps(const Assembly& assembly, const Detector& detector) : search_(assembly, detector) {}

  /// Makes a step as TimeStepper::step(), in as many parts as it takes. Throws SolverError naming the pair
  /// that needs too many; on an error none of the three has changed.
  void step(TimeStepper& stepper, State& state, Companion& companion, double step, double end_time,
            StepReport& report);

private:
  struct Run {
    State state;
    Companion companion;
  };
  PassageSearch search_;
  Run done_, trial_;
  StepReport part_, sum_;
};

}  // namespace carom
