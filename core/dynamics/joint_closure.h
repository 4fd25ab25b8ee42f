#pragma once

/// \file
/// Joints at the start of a run: projection of positions and velocities onto them, and degrees of freedom.

#include <carom/core/export.h>
#include <carom/core/state.h>

#include <string>
#include <vector>

namespace carom {

class Assembly;

/// A joint or driver, and by how much it is open.
struct OpenJoint {
  JointId joint;       ///< identity
  double gap = 0.0;    ///< of its row that is furthest off [m, rad]
  bool turns = false;  ///< it is an angle
  std::string far;     ///< of a joint between points that is far open: what is refused and allowed
};

/// Corrections that closed the joints.
struct JointClosure {
  double shift = 0.0;           ///< largest displacement of a body, angles times its radius of gyration [m]
  double change = 0.0;          ///< largest change of a velocity, spins times radii of gyration [m/s]
  std::vector<OpenJoint> open;  ///< joints that were not roughly closed before (core/dynamics/open_joints.h)
};

/// Projects the positions of a state onto the joints, and then its velocities, both by the smallest changes
/// in the mass norm; bodies with System::keeps_place() are not moved. A state that satisfies the joints up to
/// rounding is not changed. Throws ModelError naming the joint that cannot be closed, its gap, and the joints
/// that contradict it; and for a state of
/// another model.
CAROM_API JointClosure close_joints(const Assembly& assembly, State& state);

/// A joint whose rows depend linearly on those of others: its reactions, and theirs, are not unique.
struct RedundantJoint {
  JointId joint;              ///< the redundant joint
  std::vector<JointId> with;  ///< joints on whose rows it depends
};

/// Degrees of freedom of a model at a configuration.
struct Mobility {
  Index velocities = 0;                   ///< velocity coordinates of all bodies
  Index rows = 0;                         ///< rows of all joints and drivers
  Index independent_rows = 0;             ///< linearly independent rows
  Index degrees_of_freedom = 0;           ///< velocities - independent_rows
  std::vector<RedundantJoint> redundant;  ///< by the order of assembly
};

/// Counts the degrees of freedom at a state, without contacts. Throws ModelError for a state of another
/// model.
[[nodiscard]] CAROM_API Mobility mobility(const Assembly& assembly, const State& state);

}  // namespace carom
