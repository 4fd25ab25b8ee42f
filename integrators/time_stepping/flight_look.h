#pragma once

/// \file
/// Looks at one body on its way through a step: where it is, and which shapes on ground are near.

#include <carom/contact/detection/ground_shapes.h>
#include <carom/contact/detection/lasting_contacts.h>
#include <carom/core/constraint_set.h>
#include <carom/core/export.h>
#include <carom/integrators/time_stepping/motion_phase.h>

#include <span>
#include <vector>

namespace carom {

/// Looks along a flight. Keeps memory.
class CAROM_API FlightLook {
public:
  /// Brings the body of the trial to a share of the step: impulses of the flight's contacts,
  /// StepTrial::dv_impulses, act evenly.
  static void go(const LocatedBody& at, const MotionPhase& flight, double share);
  /// Brings the rotation of the body to its coordinates.
  static void rotate(const LocatedBody& at);

  /// Contacts of the body where it is whose gap is at most `margin` [m].
  /// \param to_end time passes up to the end of the step; else none
  const ConstraintSet& find(const LocatedBody& at, double share, double margin, bool to_end);
  /// Contacts that are `wanted`, however far they are open, and others that are near: `wanted` closed within
  /// the step, so that the body is hardly farther from them than it moves in one; where it is, all are found.
  const ConstraintSet& find(const LocatedBody& at, double share, std::span<const ConstraintKey> wanted,
                            bool to_end);
  /// Makes a list of some of the contacts found last, in the order in which they are wanted: the order in
  /// which they are found follows gaps, which may be the same but for rounding.
  void take(std::span<const ConstraintKey> wanted, ConstraintSet& out) const;

private:
  const ConstraintSet& find(const LocatedBody& at, double share, double margin, bool to_end,
                            const LastingContacts* lasting);

  LastingContacts lasting_;  // those that are wanted
  GroundPlaces places_, places_at_end_;
  ConstraintSet found_;
};

}  // namespace carom
