#pragma once

/// \file
/// Limits of the work on a clock group: a run that gets nowhere ends, and its error names the cause.

#include <carom/core/export.h>
#include <carom/integrators/event_driven/event.h>
#include <carom/integrators/event_driven/group_failure.h>
#include <carom/integrators/event_driven/motion_sample.h>
#include <carom/integrators/event_driven/smooth_motion.h>
#include <carom/integrators/run/work_limits.h>

#include <string>
#include <vector>

namespace carom {

/// Limits of one clock group, and its counts.
class CAROM_API GroupLimits {
public:
  /// Both must outlive it.
  GroupLimits(SmoothMotion& motion, const GroupFailure& failure) : motion_(&motion), failure_(&failure) {}

  /// Begins with a new motion.
  void start(double time);
  /// Longest step that a flow may make [s].
  [[nodiscard]] double longest_step() const;
  /// Refuses a target that steps of this length cannot reach before any are made.
  void demand_reachable(double target) const;
  /// Counts a step; fails beyond the limit. \param y the state \param memory overwritten then
  void count_step(double time, const double* y, MotionSample& memory);
  /// Counts an event; fails beyond the limit. \param at sample of the state there
  void count_event(const Event& event, const MotionSample& at);
  /// Fails where there were too many evaluations.
  [[noreturn]] void fail_evaluations() const;

private:
  [[nodiscard]] std::vector<std::string> parts_of(const Event& event, const MotionSample& at) const;

  SmoothMotion* motion_;
  const GroupFailure* failure_;
  RateLimit events_{1000}, steps_{10'000};
};

}  // namespace carom
