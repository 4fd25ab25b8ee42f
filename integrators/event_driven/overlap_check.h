#pragma once

/// \file
/// Nothing overlaps at the end of a step, whatever the search for events has seen: all shapes are looked at
/// with the contact search of the time-stepping mode, which knows nothing of groups and pairs. At events the
/// contacts of the group that takes part are looked at, which are at hand there. A closing that was missed is
/// an error that names the contact, never a motion of bodies in each other.

#include <carom/contact/detection/detector.h>
#include <carom/core/assembly.h>
#include <carom/core/constraint_set.h>
#include <carom/core/evaluation.h>
#include <carom/core/export.h>
#include <carom/core/state.h>
#include <carom/integrators/event_driven/event_instant.h>
#include <carom/integrators/event_driven/group_failure.h>
#include <carom/integrators/run/event_driven.h>

#include <span>
#include <string>
#include <vector>

namespace carom {

/// How deep shapes may be in each other [m]: ten times the tolerance of gaps, and what the tolerances of the
/// integrator leave of a place; and the way that bodies go between two times that the clock can tell apart.
/// \param places coordinates of bodies \param speed of the fastest [m/s] \param time [s]
[[nodiscard]] CAROM_API double allowed_overlap(const EventDriven& options, std::span<const double> places,
                                               double speed, double time);
/// Throws the ModelError of a state that cannot be a start, \param contact its name, \param gap [m]
/// \param tolerance EventDriven::gap_tolerance [m]
[[noreturn]] CAROM_API void refuse_start(const std::string& contact, double gap, double tolerance);
/// Throws SolverError naming the deepest contact of a clock group at an event where one is deeper. \param at
/// brought to the state, with its scales
CAROM_API void demand_apart(const EventInstant& at, const GroupFailure& failure);

/// The check of the states of one model. Keeps memory only.
class CAROM_API OverlapCheck {
public:
  /// All must outlive it.
  OverlapCheck(const Assembly& assembly, const Detector& detector, const EventDriven& options);

  /// Throws ModelError naming the deepest contact where one is deeper than the tolerance of gaps. The pairs
  /// of a group do not show that: of two shapes that cross no corner need be in the other one.
  /// \param evaluation position group up to date
  void demand_start(const State& state, const Evaluation& evaluation);
  /// Throws SolverError naming the deepest contact where one is deeper.
  /// \param evaluation position group up to date \param lengths Assembly::length_scales() \param from begin
  /// of the step, the last good state [s]
  void demand_apart(const State& state, const Evaluation& evaluation, const std::vector<double>& lengths,
                    double from);

private:
  struct Deepest {
    ConstraintKey key{};
    double gap = 0.0;  // [m]
    bool is_deeper = false;
  };
  [[nodiscard]] Deepest find_deepest(const State& state, const Evaluation& evaluation, double limit);

  const Assembly* assembly_;
  const Detector* detector_;
  const EventDriven* options_;
  GroundPlaces places_;
  BodyContactSearch search_;
  ConstraintSet found_;
};

}  // namespace carom
