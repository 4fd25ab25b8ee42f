#pragma once

/// \file
/// Joints and closed contacts of a clock group are closed (contact/closure.h): refused where that changes too
/// much, booked, and with the contacts that count as closed.

#include <carom/contact/closure.h>
#include <carom/core/export.h>
#include <carom/integrators/event_driven/event_balance.h>
#include <carom/integrators/event_driven/event_instant.h>
#include <carom/integrators/event_driven/group_failure.h>
#include <carom/integrators/event_driven/motion_sample.h>
#include <carom/integrators/event_driven/smooth_motion.h>

#include <cstddef>
#include <span>

namespace carom {

/// Finds what closes the joints and closed contacts of a group: MotionMemory::closer has it then. False where
/// there is nothing to close. \param at the sample that the motion made last
[[nodiscard]] CAROM_API bool find_closure(SmoothMotion& motion, const MotionSample& at);

/// Closes the joints and closed contacts of a group. \param at the sample of y that the motion made last; it
/// is out of date if y was changed
CAROM_API Closure close(SmoothMotion& motion, const MotionSample& at, std::span<double> y);

/// Closures of one clock group. Samples given must be those of y that the motion made last; they are out of
/// date where y was changed.
class CAROM_API GroupClosure {
public:
  /// \param motion,failure must outlive it
  GroupClosure(SmoothMotion& motion, const GroupFailure& failure) : motion_(&motion), failure_(&failure) {}

  /// Closes an output state: the energy taken out is returned, not booked [J].
  [[nodiscard]] double apply_to_output(const MotionSample& at, std::span<double> y, EventBalance& balance);
  /// Closes the state and books. True if it was changed.
  bool apply(const MotionSample& at, std::span<double> y, EventBalance& balance);
  /// Closes the state with a contact that has just stopped slipping as sticking, with all that can only move
  /// with it, and books.
  void apply_with_contact_stuck(std::size_t contact, const MotionSample& at, std::span<double> y,
                                EventBalance& balance);
  /// A run that goes on from a state within a phase: takes out what the tolerances left of the contacts known
  /// to be closed there; a lift-off or an impact would be made of it. Updates the instant.
  void apply_to_known_contacts(EventInstant& at);

private:
  [[nodiscard]] double close_and_judge(const MotionSample& at, std::span<double> y, bool& changed,
                                       EventBalance& balance);

  SmoothMotion* motion_;
  const GroupFailure* failure_;
};

}  // namespace carom
