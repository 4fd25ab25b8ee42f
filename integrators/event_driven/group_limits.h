#pragma once

/// \file
/// Limits of the work on a clock group: a run that gets nowhere ends, and its error names the cause.

#include <carom/core/export.h>
#include <carom/integrators/event_driven/event.h>
#include <carom/integrators/event_driven/group_failure.h>
#include <carom/integrators/event_driven/motion_sample.h>
#include <carom/integrators/event_driven/smooth_motion.h>
#include <carom/integrators/run/work_limits.h>

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace carom {

/// Events and steps of every component, counted through all groups that it becomes part of: groups that join
/// and part again and again would begin anew each time.
struct CAROM_API WorkCounts {
  /// \param components of the model
  explicit WorkCounts(std::size_t components)
      : events(components, RateLimit(1000)), steps(components, RateLimit(10'000)) {}

  std::vector<RateLimit> events, steps;  ///< by component
};

/// Limits of one clock group.
class CAROM_API GroupLimits {
public:
  /// All must outlive it.
  GroupLimits(SmoothMotion& motion, const GroupFailure& failure, WorkCounts& counts)
      : motion_(&motion), failure_(&failure), counts_(&counts) {}

  /// Begins with a new motion of its components.
  void start(double time);
  /// Longest step that a flow may make, whatever the motion [s].
  [[nodiscard]] double longest_step() const;
  /// Longest step from a state: shorter where bodies that fly freely spin fast [s].
  [[nodiscard]] double longest_step(std::span<const double> y) const;
  /// Refuses a target that steps of this length cannot reach before any are made.
  void demand_reachable(double target) const;
  /// Counts a step; fails beyond the limit. \param y the state \param memory overwritten then
  void count_step(double time, const double* y, MotionSample& memory);
  /// Counts an event; fails beyond the limit. \param y the state there \param memory overwritten then
  void count_event(const Event& event, const double* y, MotionSample& memory);
  /// Fails where there were too many evaluations.
  [[noreturn]] void fail_evaluations() const;

private:
  [[nodiscard]] bool exceeds(std::vector<RateLimit>& counts, double most, double time);
  [[nodiscard]] std::string allowed_events(double time) const;
  [[nodiscard]] std::vector<std::string> names_by_margin(std::size_t island) const;
  [[nodiscard]] std::vector<std::string> parts_of(const Event& event, const MotionSample& at) const;

  SmoothMotion* motion_;
  const GroupFailure* failure_;
  WorkCounts* counts_;
};

}  // namespace carom
