#pragma once

/// \file
/// Constraints of a step: contacts with gap <= 0 at its start, those of the step before that turning has
/// opened, limits and friction of joints (Johansson 1999, section 4); and the islands that they make of
/// components.

#include <carom/contact/detection/detector.h>
#include <carom/core/constraint_set.h>

#include <carom/core/assembly.h>
#include <carom/core/export.h>
#include <carom/integrators/run/time_stepping.h>
#include <carom/integrators/time_stepping/step_input.h>
#include <carom/integrators/time_stepping/step_islands.h>
#include <carom/integrators/time_stepping/step_trial.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace carom {

/// Contacts that are closed to rounding and part at the start of a step: they act in it, so that what comes
/// back in it is held where it is; or they do not, and their next closing is looked for (StepClosings).
enum class Parting : std::uint8_t { acts, is_free };

/// Finds constraints and islands. Keeps memory.
class CAROM_API StepConstraints {
public:
  /// Throws ModelError for a contact without a law.
  StepConstraints(const Assembly& assembly, const TimeStepping& options);

  /// Detector that finds the contacts.
  [[nodiscard]] const Detector& detector() const { return detector_; }
  /// Ground shapes that move, at the start of the step or at its end.
  [[nodiscard]] const GroundPlaces& places(bool at_end) const { return at_end ? ground_.end : ground_.start; }
  /// Jumps of the velocities of ground shapes in a part of the step, behind its begin and up to its end [s].
  [[nodiscard]] std::span<const GroundJump> jumps_within(double begin, double end) const;
  /// Moves ground shapes. Throws SolverError naming one whose motion is not finite or jumps.
  void place_surfaces(const StepInput& in);

  /// Lets batches of more bodies than `size` go part by part: nothing asks for all their contacts at once.
  void allow_parts(Index size) { rules_.part_size = size; }
  /// Takes contacts that are closed to rounding for closed ones. \param step that rounding of velocities may
  /// open them in [s] \param pressed_open those that pushed in the step before may be open by more, since
  /// answers of many contacts are wrong by more
  void allow_rounding(double step, bool pressed_open);

  /// Gaps that count as closed [m].
  [[nodiscard]] double margin() const { return rules_.margin; }

  /// Finds all constraints of a step, and its islands: every component belongs to one. Rotations at the start
  /// (StepTrial::at_start) must be up to date where asked for. \param batches as StepIslands::find()
  void find(const StepInput& in, std::span<const Range> batches, const StepTrial& trial,
            Parting parting = Parting::acts);
  /// The islands, in the order of their first components. Valid until the next find().
  [[nodiscard]] std::span<const StepIsland> islands() const { return islands_.list(); }
  /// True if the contacts of an island are not among those found: find_part() finds them.
  [[nodiscard]] bool finds_in_parts(const StepIsland& island) const {
    return island.batches.size() == 1 && goes_in_parts(island.batches.front());
  }
  /// Begins a step whose contacts are all found part by part, without islands.
  void begin(const StepInput& in, Parting parting = Parting::acts) {
    rules_.parting = parting;
    remember(in, in.last_step);
  }
  /// False if some components surely have no contact in a step that begin() began, or in an island for which
  /// finds_in_parts() is true.
  [[nodiscard]] bool may_touch(const StepInput& in, Range components, const StepTrial& trial) const {
    return !rules_.plain || detector_.points().any_near(components, query(in, trial));
  }
  /// Finds the contacts of some components in a step that begin() began, or in an island for which
  /// finds_in_parts() is true. Valid until the next call.
  [[nodiscard]] std::span<Constraint> find_part(const StepInput& in, Range components,
                                                const StepTrial& trial);
  /// Memory for the constraints of an island before its first iteration, which changes them.
  [[nodiscard]] ConstraintSet& kept() { return kept_; }

private:
  void remember(const StepInput& in, double last_step);
  void find_in(const StepInput& in, Range components, const StepTrial& trial, ConstraintSet& out);
  [[nodiscard]] bool goes_in_parts(Range batch) const {
    return rules_.by_part && batch.size() > rules_.part_size;
  }
  [[nodiscard]] bool find_joining(const StepInput& in, std::span<const Range> batches,
                                  const StepTrial& trial);
  [[nodiscard]] bool is_freed(const StepInput& in, bool of_corners, Constraint& constraint) const;
  void free_parting(const StepInput& in, std::size_t first, ConstraintSet& out) const;
  void merge(const StepInput& in, std::span<const Touch> touching);
  void add_rolling(std::size_t first, ConstraintSet& out);
  void take_sticking(std::span<Constraint> found) const;
  [[nodiscard]] ContactQuery query(const StepInput& in, const StepTrial& trial) const;

  Detector detector_;
  struct Rules {
    double capture_speed;
    double rounding;                  // gap_rounding() [m]
    double slack;                     // opening of lasting contacts that is none [m]
    bool keeps_pressed;               // contacts with an impulse in the step before last
    bool drifts;                      // contacts of two bodies need their drifts
    bool keeps_slow;                  // contacts that pushed in the step before and part slowly, or are open
    bool turning;                     // contacts may be opened by turning, or by slack
    bool plain;                       // nothing touches but ground at rest, with laws of sliding alone
    Parting parting = Parting::acts;  // in the last find()
    bool by_part = false;             // large batches go part by part, in the last find()
    Index part_size = none;           // allow_parts()
    double margin = 0.0;              // gaps that count as closed [m]
    double slowest = 0.0;             // contacts that part more slowly do not part [m/s]

    // Of a step of that length [s], which gaps may come from.
    [[nodiscard]] OpeningSlack slack_of(double step) const;
  } rules_;
  struct {
    GroundPlaces start, end;
    std::vector<GroundJump> jumps;  // of velocities, ascending
  } ground_;
  LastingContacts lasting_;              // contacts of the last step that turning may have opened
  std::vector<ConstraintKey> sticking_;  // in the last step, ordered; where static friction asks
  BodyContactSearch search_;
  ConstraintSet constraints_, kept_, with_rolling_;
  ConstraintSet single_;             // those that join no components, or of a part of a batch
  std::vector<JoinedNodes> joined_;  // components of all constraints, before they are written
  std::vector<Index> sources_;  // of the same: place among those of two bodies, or behind them in single_
  StepIslands islands_;
};

}  // namespace carom
