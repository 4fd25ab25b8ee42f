#pragma once

/// \file
/// The phases of a step. A phase ends early where a contact closes that has to be hit then
/// (TimeStepping::impacts), or where a pair would come too deep and could leave each other on the far side
/// (OverlapRules::never_tunnel, TimeStepping::impacts); the next one begins with the impact. Phases are of
/// the bodies of some coupling sets alone (StepScope); the others stand still meanwhile.
///
/// Every closing takes some steps of these bodies. In a heap something closes all the time: so they end at a
/// number of closings and not at more. What is not searched for any more acts when the next step begins, by
/// the same laws, and is counted (ContactCounts::cut_sequences); only what would pass through anything ends a
/// phase then.

#include <carom/core/assembly.h>
#include <carom/core/export.h>
#include <carom/integrators/run/companion.h>
#include <carom/integrators/run/step_report.h>
#include <carom/integrators/time_stepping/closing_counts.h>
#include <carom/integrators/time_stepping/step_closings.h>
#include <carom/integrators/time_stepping/step_scope.h>
#include <carom/integrators/time_stepping/time_stepper.h>

#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace carom {

/// A step as its user sees it.
struct WholeStep {
  double start, step, end;  ///< where it begins, its length, where it ends [s]
};

/// The bodies of some coupling sets on their way through a step.
struct SetRun {
  StepScope scope;      ///< these
  State state;          ///< where they are; others stand where the step began
  Companion companion;  ///< then; its ledger and counts are theirs alone, and of this step
  StepReport report;    ///< of the phases so far
};

/// Makes phases. Owns workspaces only.
class CAROM_API SetPhases {
public:
  /// Phases of one step at the most: more are needed only where something flies to and fro in it for ever.
  static constexpr int most_phases = 10000;
  /// Phases of a step that may end at contacts, of one body: of several over the square of their number, one
  /// at least.
  static constexpr int hits_of_bodies = 1000;

  /// All must outlive it.
  SetPhases(const Assembly& assembly, TimeStepper& stepper);
  /// True if steps may have several phases.
  [[nodiscard]] static bool needed(const Assembly& assembly, const TimeStepper& stepper);

  /// Tries a step of all bodies in one phase. Returns the closings on its way, as far as that is known: where
  /// there are some the step may not have been made to its end. Throws as TimeStepper::step().
  [[nodiscard]] std::span<const StepClosing> try_whole(const State& state, const Companion& companion,
                                                       const WholeStep& whole);
  /// Takes this step over, on whose way nothing closes.
  void take_whole(State& state, Companion& companion, StepReport& report);

  /// Extends boxes around all that outlines of bodies sweep, by the way of this step.
  void add_boxes_of_whole(std::vector<Box<2>>& boxes) { closings_->add_boxes(way(), boxes); }

  /// Whether contacts that close end phases.
  enum class Hits : std::uint8_t { end_phases, are_left_out };
  /// Advances bodies to the end of the step, in as many phases as it takes. Throws SolverError naming the
  /// pair that needs too many. \param run from the start of the step on \param first the first closing on
  /// their way where the step has one phase; null: it is to be looked for \param boxes around all that
  /// outlines of bodies sweep, are extended by their ways
  void make(SetRun& run, const WholeStep& whole, const StepClosing* first, Hits hits,
            std::vector<Box<2>>& boxes);
  /// True if the last make() ended for too many phases.
  [[nodiscard]] bool had_too_many() const { return phases_ > most_phases; }
  /// Bodies that were advanced, each as often as a step of it was made, since the last call.
  [[nodiscard]] std::int64_t take_count() { return std::exchange(made_, 0); }

private:
  using Stops = FunctionRef<bool(const State& end, const ContactModes& modes)>;
  bool try_phase(const WholeStep& whole, double end, Stops stops = {});
  void make_phase(const WholeStep& whole, const StepClosing* first);
  void finish_phase(const WholeStep& whole, StepClosing& found);
  void begin(const StepScope* scope, const State& state, const Companion& companion);
  [[nodiscard]] StepWay way_to(const State& end, const ContactModes& modes);
  [[nodiscard]] StepWay way() { return way_to(trial_.state, trial_.companion.modes); }
  [[nodiscard]] Index count() const { return scope_ == nullptr ? bodies_ : scope_->bodies(); }
  [[nodiscard]] int most_hits() const;
  [[nodiscard]] const State& after_impacts() const;
  [[nodiscard]] bool is_followed(const StepClosing& closing) const;
  void note_closings(const StepClosing* hit);
  [[noreturn]] void fail(const ConstraintKey& key, const WholeStep& whole, int allowed) const;

  TimeStepper* stepper_;
  std::unique_ptr<StepClosings> closings_;
  std::unique_ptr<ClosingCounts> counts_;  // null where none is looked for
  Index bodies_;                           // of the model
  const StepScope* scope_ = nullptr;       // of the phase at hand; null: all bodies
  const State* start_ = nullptr;           // where the phase at hand begins
  const Companion* companion_ = nullptr;   // there
  SetRun trial_;                           // where it ends
  State came_;                             // the end of a phase before bodies are moved out of others
  int phases_ = 0;                         // that ended early
  Hits hits_ = Hits::end_phases;
  bool repeats_ = false;   // the step before began where the phase at hand does
  std::int64_t made_ = 0;  // bodies, each as often as it was advanced
  std::vector<double> accelerations_;
};

}  // namespace carom
