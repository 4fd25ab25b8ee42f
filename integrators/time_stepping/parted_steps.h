#pragma once

/// \file
/// Steps in several parts. A step ends early where a pair would come too deep and could leave each other on
/// the far side (OverlapRules::never_tunnel, TimeStepping::impacts), or where a contact closes that has to be
/// hit then (TimeStepping::impacts); the rest of it is another one, which begins with the impact.
///
/// Every closing takes some steps of the whole model. In a heap something closes all the time: so the steps
/// that are made are counted, those repeated because contacts turn included, and with s of them allowed for
/// each (steps_per_step) n steps take at most (n + 50) s and one search, if one by itself takes
/// no more than s. What is not searched for any more acts when the next step begins, by the same laws, and is
/// counted (ContactCounts::cut_sequences); only what would pass through anything parts the step then.
///
/// A step whose parts have no solution is made again, whole, without closings: these are counted in the same
/// way. It fails where the whole one has none either, or gains energy in impacts; and where jams or gains are
/// to be refused (ImpactRules), which the whole one would hide.

#include <carom/core/assembly.h>
#include <carom/core/export.h>
#include <carom/integrators/run/companion.h>
#include <carom/integrators/run/step_report.h>
#include <carom/integrators/time_stepping/closing_counts.h>
#include <carom/integrators/time_stepping/step_closings.h>
#include <carom/integrators/time_stepping/time_stepper.h>

#include <memory>
#include <vector>

namespace carom {

/// Parts steps. Owns workspaces only.
class CAROM_API PartedSteps {
public:
  /// Parts of one step at the most: more are needed only where something flies to and fro in it for ever.
  static constexpr int most_parts = 10000;
  /// Steps of the whole model that finding closings may take for one step, on average over a run.
  static constexpr int steps_per_step = 10;
  /// Steps that may be saved for that, times steps_per_step.
  static constexpr int saved_steps = 50;

  /// All must outlive it.
  PartedSteps(const Assembly& assembly, TimeStepper& stepper);
  /// True if steps may have to be parted.
  [[nodiscard]] static bool needed(const Assembly& assembly, const TimeStepper& stepper);

  /// Makes a step as TimeStepper::step(), in as many parts as it takes. Throws SolverError naming the pair
  /// that needs too many; on an error none of the three has changed.
  void step(State& state, Companion& companion, double step, double end_time, StepReport& report);

private:
  struct Run {
    State state;
    Companion companion;
  };
  // Where the whole step begins, and its length.
  struct Whole {
    double start, step, end;
  };
  void make_part(const Whole& whole, double length, double end);
  void make_part_up_to(const Whole& whole, double length);
  void make_parts(const State& state, const Companion& companion, const Whole& whole, bool searches);
  [[nodiscard]] StepClosing first_closing(bool searches);
  [[nodiscard]] bool may_search() const;
  [[nodiscard]] const State& after_impacts() const;
  [[nodiscard]] bool is_followed(const StepClosing& closing) const;
  void note_closings(const StepClosing* hit);
  [[noreturn]] void fail(const ConstraintKey& key, const Whole& whole, int allowed) const;
  void keep_impulses();

  TimeStepper* stepper_;
  std::unique_ptr<StepClosings> closings_;
  std::unique_ptr<ClosingCounts> counts_;  // null where none is looked for
  Run done_, trial_;
  State came_;              // the end of a part before bodies are moved out of others
  int parts_ = 0;           // that ended early
  int made_ = 0;            // steps of the whole model for the step at hand, with those repeated
  bool searches_ = true;    // for closings, in the step at hand
  bool repeats_ = false;    // the step before began where the part at hand does
  bool is_parted_ = false;  // some of it was made that is shorter
  std::vector<double> accelerations_;
  StepReport part_, sum_;
};

}  // namespace carom
