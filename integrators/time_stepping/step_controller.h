#pragma once

/// \file
/// Steps as long as their error allows. A step of second order is compared with two halves of it: of the
/// difference one third is the error of the halves, which are kept.
/// Where sliding ends, turns round or begins in a half, what that adds to the error is bounded as well
/// (slip_changes.h). A step with the same impacts in both is short enough for the motion around them.

#include <carom/core/assembly.h>
#include <carom/core/export.h>
#include <carom/core/function_ref.h>
#include <carom/integrators/run/companion.h>
#include <carom/integrators/run/step_report.h>
#include <carom/integrators/run/time_stepping.h>
#include <carom/integrators/time_stepping/slip_changes.h>

#include <optional>
#include <vector>

namespace carom {

/// Chooses lengths of steps. Owns workspaces only.
class CAROM_API StepController {
public:
  /// Makes a step as TimeStepper::step(), in one phase or in several (PhasedSteps).
  using MakeStep =
      FunctionRef<void(State& state, Companion& companion, double step, double end_time, StepReport& report)>;

  StepController(const Assembly& assembly, const TimeStepping& options);

  /// Makes one step that ends at `limit` [s] at the latest; shorter than the smallest step only for that. On
  /// success state and companion are those at its end; on SolverError none of the three has changed.
  void step(MakeStep make, State& state, Companion& companion, double limit, StepReport& report);

private:
  /// Meaning of the difference of the whole step and the halves.
  enum class Comparison {
    nothing,      // other contacts, or other impacts
    least_error,  // the same impacts: when they are, and what follows, is another error
    error         // the same contacts, no impact
  };
  /// A step that was tried.
  struct Attempt {
    bool accepted = false;
    bool compared = false;  // whether its error could be estimated
    bool changed = false;   // whether sliding ended, turned round or began in it
    double error = 0.0;     // if it could be estimated [m]
    double next = 0.0;      // length to go on with [s]
  };
  [[nodiscard]] Attempt attempt(MakeStep make, const State& state, const Companion& companion, double step,
                                double end);
  Comparison try_step(MakeStep make, const State& state, const Companion& companion, double step, double end);
  void judge(double step, Attempt& made) const;
  void judge_across_impacts(double step, Attempt& made) const;
  [[nodiscard]] bool same_impacts();
  [[nodiscard]] bool modes_differ() const;
  [[nodiscard]] double difference(double step) const;
  void estimate(double step, Attempt& made) const;
  void merge(StepReport& report);
  [[noreturn]] static void fail_short(double time, double step);
  [[noreturn]] void fail_smallest(double time, double step, double error) const;

  struct Run {
    State state;
    Companion companion;
  };
  struct Keys {
    std::vector<ConstraintKey> hit, of_whole, of_halves;
  };

  const Assembly* assembly_;
  TimeStepping options_;
  std::vector<double> lengths_;
  Run whole_, halves_;
  State middle_;
  ContactModes modes_of_first_;
  double changed_speed_ = 0.0;               // SlipChanges::largest_speed() of the halves
  std::optional<SlipChanges> slip_changes_;  // none without control
  StepReport of_whole_, first_, second_;
  Keys keys_;  // workspace of same_impacts()
};

}  // namespace carom
