#pragma once

/// \file
/// Memory of the search for events, shared by clock groups: one at a time makes a step.

#include <carom/contact/force_margins.h>
#include <carom/core/export.h>
#include <carom/integrators/event_driven/guard_samples.h>
#include <carom/integrators/event_driven/known_accelerations.h>
#include <carom/integrators/event_driven/motion_sample.h>
#include <carom/integrators/event_driven/step_ends.h>

#include <vector>

namespace carom {

/// Guards of a step that turned out to be false alarms.
struct FalseAlarms {
  std::vector<double> gaps;  ///< by pair: its gap is looked at from then on [s]
  std::vector<char> forces;  ///< by island that touches: not looked at
};

/// Memory of one step.
struct CAROM_API DetectionMemory {
  /// \param sample must outlive it
  explicit DetectionMemory(MotionSample& sample) : within(sample) {}

  MotionSample& within;                   ///< at a time of a step; events have it when they look at no step
  std::vector<double> y;                  ///< unknowns at that time
  std::vector<double> path_acceleration;  ///< accelerations at that time, along the path of a step
  std::vector<ForceMargin> margins;
  GuardSample located;               ///< where an event is located
  GuardSamples samples;              ///< within one step
  GuardSamples path_samples;         ///< of guards of elements along the path of a step
  KnownAccelerations accelerations;  ///< where gaps were looked at
  StepEnds ends;                     ///< of the step
  std::vector<char> is_active;       ///< by pair: closed at both ends
  FalseAlarms passed_over;           ///< in the step
};

}  // namespace carom
