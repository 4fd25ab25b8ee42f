#pragma once

/// \file
/// First event in each step of a smooth phase: guards are sampled at the ends of the step, predicted between
/// them, and located; steps that passed over events or loads are repeated.

#include <carom/core/export.h>
#include <carom/integrators/event_driven/event.h>
#include <carom/integrators/event_driven/event_prediction.h>
#include <carom/integrators/event_driven/event_scales.h>
#include <carom/integrators/event_driven/group_failure.h>
#include <carom/integrators/event_driven/guard_search.h>
#include <carom/integrators/event_driven/searched_step.h>
#include <carom/integrators/event_driven/smooth_motion.h>
#include <carom/integrators/event_driven/step_ends.h>
#include <carom/integrators/event_driven/unbounded_forces.h>
#include <carom/integrators/flow/flow.h>

#include <span>
#include <string>
#include <vector>

namespace carom {

/// The detector of one clock group.
class CAROM_API EventDetector {
public:
  /// All must outlive it.
  EventDetector(SmoothMotion& motion, const GroupFailure& failure, UnboundedForces& unbounded,
                DetectionMemory& memory)
      : motion_(&motion), failure_(&failure), unbounded_(&unbounded), memory_(&memory) {}

  /// Begins with a new motion.
  void start();
  /// Begins a smooth phase at a state, with the contacts that are closed. Fails where loads are not finite.
  void begin_phase(double time, const double* y, const EventScales& scales);
  /// Makes one step of a flow and finds its first event; `nothing` at the end of the step if there is none.
  /// \param time, y the group's, where the flow stands \param longest step [s]
  [[nodiscard]] Event step(Flow& flow, double time, std::span<const double> y, double longest);
  /// The last step had no event: its end is the start of the next one.
  void accept();
  /// Writes the state at an event of the last step.
  void land(Flow& flow, const Event& event, std::span<double> y) const;
  /// The guard of an element is on the other side from now on.
  void pass(const Event& event);
  /// Rounding of the force of an event of the last step; 0 of another event [N].
  [[nodiscard]] double force_noise(const Event& event) const;

private:
  void take_features(double time, const double* y);
  [[nodiscard]] Event search(Flow& flow, double time, std::span<const double> y, double longest);
  void list_active();
  [[nodiscard]] Event first(SearchedStep& step);
  void pass_over(const SearchedStep& step, const Event& predicted);
  [[nodiscard]] bool lowers_level(const SearchedStep& step, const Event& predicted);
  [[nodiscard]] bool is_false_alarm(SearchedStep& step, const Event& predicted, const Event& located);
  [[nodiscard]] Event first_of(SearchedStep& step, const Event& predicted, const Event& located);
  [[nodiscard]] bool finds_unbounded_force(double time, const double* y,
                                           double growth = UnboundedForces::growth);
  [[nodiscard]] bool comes_to_pole(double time, std::span<const double> y);
  [[nodiscard]] Event discontinuity_at(double time, std::span<const double> y);
  [[nodiscard]] Event unbounded_at(double time, std::span<const double> y, std::string reason);
  [[nodiscard]] bool repeat_shorter(SearchedStep& step, const Event& event, double time,
                                    std::span<const double> y);

  SmoothMotion* motion_;
  const GroupFailure* failure_;
  UnboundedForces* unbounded_;
  DetectionMemory* memory_;
  EventScales scales_;
  GuardSearch guards_;
  StepEnd start_;             // of the next step
  double force_noise_ = 0.0;  // of the event of the last step, that of a force [N]
  Landing landing_;           // on that event
};

}  // namespace carom
