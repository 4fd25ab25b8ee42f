#pragma once

/// \file
/// Projections of a clock group onto its constraints: refused where they change too much, booked, and with
/// the contacts that count as closed.

#include <carom/core/export.h>
#include <carom/integrators/event_driven/event_balance.h>
#include <carom/integrators/event_driven/event_instant.h>
#include <carom/integrators/event_driven/group_failure.h>
#include <carom/integrators/event_driven/motion_sample.h>
#include <carom/integrators/event_driven/smooth_motion.h>

#include <cstddef>
#include <span>

namespace carom {

/// The projections of one clock group. Samples given must be those of y that the motion made last; they are
/// out of date where y was changed.
class CAROM_API ProjectionStage {
public:
  /// Both must outlive it.
  ProjectionStage(SmoothMotion& motion, const GroupFailure& failure) : motion_(&motion), failure_(&failure) {}

  /// Projects an output state: the energy taken out is returned, not booked [J].
  [[nodiscard]] double apply_to_output(const MotionSample& at, std::span<double> y, EventBalance& balance);
  /// Projects the state and books. True if it was changed.
  bool apply(const MotionSample& at, std::span<double> y, EventBalance& balance);
  /// Likewise with a contact that has just stopped slipping as sticking, with all that can only move with it.
  void apply_with_contact_stuck(std::size_t contact, const MotionSample& at, std::span<double> y,
                                EventBalance& balance);
  /// A run that goes on from a state within a phase: takes out what the tolerances left of the contacts known
  /// to be closed there; a lift-off or an impact would be made of it. Updates the instant.
  void apply_to_known_contacts(EventInstant& at);

private:
  [[nodiscard]] double project(const MotionSample& at, std::span<double> y, bool& changed,
                               EventBalance& balance);

  SmoothMotion* motion_;
  const GroupFailure* failure_;
};

}  // namespace carom
