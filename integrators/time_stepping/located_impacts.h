#pragma once

/// \file
/// Bodies of an island that shapes on ground hit within the step (TimeStepping::impacts). Found along the
/// iterate; what they are coupled to follows by the iteration, so that the step stays one implicit problem.

#include <carom/contact/detection/detector.h>
#include <carom/core/assembly.h>
#include <carom/core/constraint_set.h>
#include <carom/core/export.h>
#include <carom/integrators/time_stepping/jump_search.h>
#include <carom/integrators/time_stepping/located_motion.h>
#include <carom/integrators/time_stepping/step_model.h>

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace carom {

/// Finds bodies that shapes on ground hit within the step, and moves them. Keeps memory.
class CAROM_API LocatedImpacts {
public:
  /// \param model must outlive it
  explicit LocatedImpacts(const StepModel& model);

  /// True if impacts are located here. Those of other laws than Newton's, or with rules of their own, are by
  /// steps that end there (set_phases.h).
  [[nodiscard]] bool on() const { return on_; }
  /// Forgets all bodies.
  void clear() {
    in_use_ = 0;
    order_.clear();
  }
  /// True if no body was taken up.
  [[nodiscard]] bool empty() const { return in_use_ == 0; }
  /// Takes up bodies of a component that will be hit if their velocities at the start change little.
  /// \param contacts as in take_up() \param places ground at the start
  void expect(const StepInput& in, Index component, std::span<const Constraint> contacts,
              const GroundPlaces& places, StepTrial& trial);
  /// Takes up bodies of consecutive components whose gaps are closed at the end of the iterate, though not at
  /// its start; and those that a contact hits at its start, or holds where it turns. True if there are any
  /// that were not known. \param contacts of their island that take part from the start on \param places
  /// ground at the end
  bool take_up(const StepInput& in, Range components, std::span<const Constraint> contacts,
               const GroundPlaces& places, StepTrial& trial);
  /// Moves the bodies taken up among some bodies again, after the rule has moved all. Bodies may be shared
  /// out to threads.
  void advance(const StepInput& in, const StepRule& rule, const StepLoads& loads, Range bodies,
               StepTrial& trial);
  /// True if any of some bodies was taken up.
  [[nodiscard]] bool contains_any(Range bodies) const;
  /// Motions of those of some bodies that were, in their order. Valid until the next call.
  [[nodiscard]] std::span<const LocatedMotion* const> motions_of(Range bodies);
  /// A problem that was not solved; null if none.
  [[nodiscard]] const IslandProblem* first_unsolved() const;
  /// True if any body is hit within the step.
  [[nodiscard]] bool any_hit() const;
  /// Finds the jumps of loads of a component that depend on velocities, at the iterate. False if they move
  /// the bodies as those do that acted, but for less than the tolerance [m]: then these stay. \param
  /// only_local does nothing unless few blocks are concerned; of the iterate loads are not asked then
  [[nodiscard]] bool update_jumps(const StepInput& in, const StepRule& rule, Index component, bool only_local,
                                  double tolerance, StepTrial& trial);
  /// Brings mean velocities of a component, in the midpoint of the trial, to its flights.
  void add_mean(const StepInput& in, Index component, StepTrial& trial);
  /// Replaces, in the account of the trial, works of loads on some bodies along their mean velocities by
  /// those along their flights.
  void correct_works(const StepInput& in, const StepRule& rule, Range bodies, StepTrial& trial);
  /// Work of loads that do not change on some bodies, along their flights, less that along their mean
  /// velocities [J].
  [[nodiscard]] double work_of_flights(const StepInput& in, const StepRule& rule, Range bodies,
                                       const StepTrial& trial);
  /// Adds the counts of the solvers since the last call.
  void add_statistics(ChainStatistics& sum);
  /// Forgets the counts of the solvers since the last call, after a step that failed.
  void forget_statistics();

private:
  using OfBody = std::pair<Index, std::size_t>;  // a body, one of its contacts
  void find_new(const StepInput& in, Range components, std::span<const Constraint> contacts,
                const GroundPlaces& places, StepTrial& trial);
  void list(std::span<const Constraint> contacts);
  [[nodiscard]] std::span<const OfBody> of(Index body);
  void take_up_new(const StepInput& in, const Constraint& contact, StepTrial& trial);
  void take_up_held(const StepInput& in, Range bodies, StepTrial& trial);
  void take_up(const StepInput& in, Index body, StepTrial& trial);
  [[nodiscard]] bool takes_part(Index body, const ConstraintKey& key);
  [[nodiscard]] std::size_t place(Index body) const;

  const Assembly* assembly_;
  const Detector* detector_;
  JumpSearch jumps_;
  bool on_;
  bool of_one_piece_;  // every shape on ground is, and nothing else touches: a point has one contact with it
  LocatedRules rules_;
  SweepBudget budget_;
  std::vector<LocatedMotion> motions_;
  std::size_t in_use_ = 0;
  std::vector<std::pair<Index, std::size_t>> order_;  // body, its motion; ascending
  std::vector<const LocatedMotion*> of_bodies_;       // of the last motions_of(), by ascending body
  struct {
    std::span<const Constraint> contacts;
    std::vector<OfBody> of_bodies;  // of these, ascending
    std::size_t next = 0;           // behind those of the body asked for last: bodies come in order
    ConstraintSet own;              // of one body
  } island_;                        // at hand
  ConstraintSet found_;
};

}  // namespace carom
