#pragma once

/// \file
/// The parts of a clock group, each with its own state, and where the group stands.

#include <carom/contact/detection/detector.h>
#include <carom/core/assembly.h>
#include <carom/core/export.h>
#include <carom/integrators/event_driven/event.h>
#include <carom/integrators/event_driven/event_detector.h>
#include <carom/integrators/event_driven/group_closure.h>
#include <carom/integrators/event_driven/group_failure.h>
#include <carom/integrators/event_driven/group_flow.h>
#include <carom/integrators/event_driven/group_limits.h>
#include <carom/integrators/event_driven/group_memory.h>
#include <carom/integrators/event_driven/group_output.h>
#include <carom/integrators/event_driven/impact_stage.h>
#include <carom/integrators/event_driven/mode_selection.h>
#include <carom/integrators/event_driven/smooth_motion.h>
#include <carom/integrators/event_driven/unbounded_forces.h>
#include <carom/integrators/run/event_driven.h>

#include <vector>

namespace carom {

/// The parts refer to each other: it stays where it is.
struct CAROM_API GroupParts {
  /// All must outlive it. Throws ModelError for contact in space.
  GroupParts(const Assembly& assembly, const Detector& contacts, const EventDriven& options,
             const GroupComponents& components, GroupMemory& shared);
  GroupParts(const GroupParts&) = delete;
  GroupParts& operator=(const GroupParts&) = delete;

  GroupMemory* memory;        ///< shared with other groups
  SmoothMotion motion;        ///< unknowns, loads, closed contacts
  GroupClock clock;           ///< times
  GroupFailure failure;       ///< errors that name the parts of the group
  UnboundedForces unbounded;  ///< contacts whose forces grow without bound
  EventDetector detector;     ///< what ends a smooth phase
  ImpactStage impacts;        ///< impacts of an event
  ModeSelection modes;        ///< modes after an event
  GroupClosure closure;       ///< of joints and closed contacts
  GroupLimits limits;         ///< bounds on work
  GroupFlow flow;             ///< integrator of the smooth phases
  GroupOutput output;         ///< output state, and works booked
  std::vector<double> y;      ///< unknowns at clock.now
  Phase phase;                ///< what it is in between
};

}  // namespace carom
