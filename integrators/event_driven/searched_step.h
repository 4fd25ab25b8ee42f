#pragma once

/// \file
/// The last step of a flow, as the search for its first event reads it.

#include <carom/core/export.h>
#include <carom/integrators/event_driven/detection_memory.h>
#include <carom/integrators/event_driven/event_scales.h>
#include <carom/integrators/event_driven/guard_search.h>
#include <carom/integrators/event_driven/smooth_motion.h>
#include <carom/integrators/event_driven/step_ends.h>
#include <carom/integrators/flow/flow.h>

#include <span>
#include <vector>

namespace carom {

/// One step; all that it refers to stays as it is during the search, but the memory.
struct SearchedStep {
  SmoothMotion& motion;
  Flow& flow;
  const StepEnds& ends;
  const EventScales& scales;
  const GuardSearch& guards;        ///< sides of the guards of elements
  std::span<const char> is_active;  ///< by pair: closed at both ends
  DetectionMemory& memory;

  /// Begin of the step [s].
  [[nodiscard]] double begin() const { return flow.begin(); }
  /// End of the step [s].
  [[nodiscard]] double end() const { return flow.end(); }
  /// True if there are guards of elements.
  [[nodiscard]] bool has_guards() const { return !ends.end().sample.guards.empty(); }
  /// True of a gap that is known exactly all along the step: of flights under constant fields, to shapes that
  /// are looked at in each step.
  [[nodiscard]] bool is_exact(std::size_t pair) const {
    return motion.is_ballistic() && motion.model().bound_of(pair) == none;
  }
  /// Samples the motion at a time of the step, by interpolation, into the memory.
  const MotionSample& sample(double time) {
    memory.y.resize(motion.size());
    flow.sample(time, memory.y);
    motion.sample(time, memory.y.data(), Forces::all, memory.within);
    return memory.within;
  }
  /// A sample within the step for looks at gaps, which do not ask for the forces of contact themselves.
  const MotionSample& sample_for_gaps(double time) {
    memory.y.resize(motion.size());
    flow.sample(time, memory.y);
    memory.accelerations.sample(motion, time, memory.y.data(), memory.within);
    return memory.within;
  }
};

/// A state on which a step of the flow ends.
struct Landing {
  double time = 0.0;      ///< [s]; infinity: none
  std::vector<double> y;  ///< unknowns at that time
};

}  // namespace carom
