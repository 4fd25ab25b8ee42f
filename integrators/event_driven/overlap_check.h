#pragma once

/// \file
/// Nothing overlaps at the end of a step, whatever the search for events has seen: all shapes are looked at
/// with the contact search of the time-stepping mode, which knows nothing of groups and pairs. A closing that
/// was missed is an error that names the contact, never a motion of bodies in each other.

#include <carom/contact/detection/detector.h>
#include <carom/core/assembly.h>
#include <carom/core/constraint.h>
#include <carom/core/evaluation.h>
#include <carom/core/export.h>
#include <carom/core/state.h>
#include <carom/integrators/run/event_driven.h>

#include <vector>

namespace carom {

/// The check of the states of one model. Keeps memory only.
class CAROM_API OverlapCheck {
public:
  /// All must outlive it.
  OverlapCheck(const Assembly& assembly, const Detector& detector, const EventDriven& options);

  /// How deep shapes may be in each other at the end of a step [m]: ten times the tolerance of gaps, and what
  /// the tolerances of the integrator leave of a place.
  [[nodiscard]] double allowed(const State& state) const;
  /// Throws SolverError naming the deepest contact where one is deeper.
  /// \param evaluation position group up to date \param from begin of the step, the last good state [s]
  void demand_apart(const State& state, const Evaluation& evaluation, double from);

private:
  const Assembly* assembly_;
  const Detector* detector_;
  const EventDriven* options_;
  GroundPlaces places_;
  BodyContactSearch search_;
  std::vector<Constraint> found_;
};

}  // namespace carom
