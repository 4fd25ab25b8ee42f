#pragma once

/// \file
/// Memory that the motions of components share: nothing in it lasts from one call to the next but where a
/// function says so.

#include <carom/contact/active_set.h>
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
      : no_joints(assembly, {}),
        flow(assembly),
        lengths(assembly.length_scales()),
        z_rates(flow.state.z.size()),
        of_position(flow.state.v.size()),
        of_velocity(flow.state.v.size()),
        held(flow.state.v.size()) {}

  BoundComponents no_joints;                     ///< of groups without joints; never changes
  MotionSample flow;                             ///< where a flow asks for rates last
  std::vector<double> lengths;                   ///< Assembly::length_scales()
  std::vector<double> z_rates;                   ///< rates of internal variables
  std::vector<double> of_position, of_velocity;  ///< changes of coordinates, velocities or accelerations
  std::vector<double> held;  ///< impulse of a change of velocities, or accelerations without contacts
  /// GroupModel::tolerances of the group that was made last.
  std::shared_ptr<const std::vector<double>> tolerances;
  std::vector<double> multipliers;     ///< of joints
  ActiveSetMemory active;              ///< of closed contacts
  FrictionBoundSolver friction_bound;  ///< of impacts with friction in joints
  EvaluationLimit limit;               ///< of evaluations
};

}  // namespace carom
