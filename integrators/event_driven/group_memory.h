#pragma once

/// \file
/// Memory and solvers that clock groups share: one group at a time uses them.

#include <carom/contact/island_partition.h>
#include <carom/contact/solvers/solver_chain.h>
#include <carom/core/assembly.h>
#include <carom/core/export.h>
#include <carom/integrators/event_driven/detection_memory.h>
#include <carom/integrators/event_driven/event_instant.h>
#include <carom/integrators/event_driven/group_limits.h>
#include <carom/integrators/event_driven/impact_stage.h>
#include <carom/integrators/event_driven/mode_selection.h>
#include <carom/integrators/event_driven/motion_memory.h>
#include <carom/integrators/flow/flow_pool.h>
#include <carom/integrators/run/event_driven.h>
#include <carom/integrators/run/stop_request.h>

#include <vector>

namespace carom {

/// Components of a group that closed contacts connect.
struct ComponentIslands {
  IslandPartition partition;
  std::vector<JoinedNodes> joined;
};

/// Memory by stage.
struct CAROM_API GroupMemory {
  /// \param stop asked within the work, may be null
  GroupMemory(const Assembly& assembly, const EventDriven& options, const StopRequest* stop)
      : motion(assembly),
        flows(options.method, options.relative_tolerance),
        instant(assembly),
        impacts(options.impact_rules, chain),
        detection(instant.now),
        work(assembly.components().size()) {
    motion.limit = EvaluationLimit(options.evaluation_limit, stop);
  }

  MotionMemory motion;
  FlowPool flows;  ///< a group has one in its turn, and between turns if it cannot do without
  SolverChain chain;
  InstantMemory instant;
  ImpactMemory impacts;
  ModeMemory modes;
  DetectionMemory detection;
  ComponentIslands components;
  WorkCounts work;
};

}  // namespace carom
