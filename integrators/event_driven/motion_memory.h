#pragma once

/// \file
/// Memory that the motions of components share: nothing in it lasts from one call to the next but where a
/// function says so.

#include <carom/contact/active_set.h>
#include <carom/contact/closure.h>
#include <carom/contact/friction_bound_solver.h>
#include <carom/core/assembly.h>
#include <carom/core/export.h>
#include <carom/integrators/event_driven/group_joints.h>
#include <carom/integrators/event_driven/motion_sample.h>
#include <carom/integrators/run/work_limits.h>

#include <memory>
#include <vector>

namespace carom {

/// Arrays over the whole model, of which a motion uses the component's part.
struct CAROM_API MotionMemory {
  explicit MotionMemory(const Assembly& assembly)
      : no_joints(assembly, {}), flow(assembly), z_rates(flow.state.z.size()), closure(assembly) {}

  BoundComponents no_joints;    ///< of groups without joints; never changes
  MotionSample flow;            ///< where a flow asks for rates last
  std::vector<double> z_rates;  ///< rates of internal variables
  /// Joints and closed contacts, closed; its arrays are scratch for all else, but for the lengths.
  ClosureMemory closure;
  std::vector<Index> components;  ///< of the group at hand
  /// GroupModel::tolerances of the group that was made last.
  std::shared_ptr<const std::vector<double>> tolerances;
  std::vector<double> multipliers;     ///< of joints
  ActiveSetMemory active;              ///< of closed contacts
  FrictionBoundSolver friction_bound;  ///< of impacts with friction in joints
  EvaluationLimit limit;               ///< of evaluations
};

}  // namespace carom
