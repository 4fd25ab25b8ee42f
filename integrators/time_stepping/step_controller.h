#pragma once

/// \file
/// Steps as long as their error allows. A step of second order is compared with two halves of it: of the
/// difference one third is the error of the halves, which are kept.

#include <carom/core/assembly.h>
#include <carom/core/export.h>
#include <carom/core/function_ref.h>
#include <carom/integrators/run/companion.h>
#include <carom/integrators/run/step_report.h>
#include <carom/integrators/run/time_stepping.h>

#include <vector>

namespace carom {

/// Chooses lengths of steps. Owns workspaces only.
class CAROM_API StepController {
public:
  /// Makes a step as TimeStepper::step(), in one part or in several (PartedSteps).
  using MakeStep =
      FunctionRef<void(State& state, Companion& companion, double step, double end_time, StepReport& report)>;

  StepController(const Assembly& assembly, const TimeStepping& options);

  /// Makes one step that ends at `limit` [s] at the latest; shorter than the smallest step only for that. On
  /// success state and companion are those at its end; on SolverError none of the three has changed.
  void step(MakeStep make, State& state, Companion& companion, double limit, StepReport& report);

private:
  /// A step that was tried.
  struct Attempt {
    bool accepted = false;
    bool compared = false;  // whether its error could be estimated
    double error = 0.0;     // then [m]
    double next = 0.0;      // length to go on with [s]
  };
  [[nodiscard]] Attempt attempt(MakeStep make, const State& state, const Companion& companion, double step,
                                double end);
  bool try_step(MakeStep make, const State& state, const Companion& companion, double step, double end);
  [[nodiscard]] double error(double step) const;
  void merge(StepReport& report);
  [[noreturn]] static void fail_short(double time, double step);
  [[noreturn]] void fail_smallest(double time, double step, double error) const;

  struct Run {
    State state;
    Companion companion;
  };

  const Assembly* assembly_;
  TimeStepping options_;
  std::vector<double> lengths_;
  Run whole_, halves_;
  StepReport of_whole_, first_, second_;
};

}  // namespace carom
