#pragma once

/// \file
/// Joints at the start of a run: positions and velocities that obey them, and what freedom they leave.

#include <carom/core/assembly.h>
#include <carom/core/export.h>
#include <carom/core/state.h>

#include <vector>

namespace carom {

/// What was corrected to close the joints.
struct JointClosure {
  double shift = 0.0;   ///< largest displacement of a body, angles weighed by its radius of gyration [m]
  double change = 0.0;  ///< largest change of a velocity, likewise [m/s]
};

/// Moves the bodies of a state so that all joints are closed, and changes their velocities so that they stay
/// so, both by the smallest changes in the sense of the masses; bodies for which System::keeps_place() holds
/// are left where they are. A state that obeys the joints up to rounding is left alone. Throws ModelError
/// naming the joint that cannot be closed and by how much, with those that contradict it.
CAROM_API JointClosure close_joints(const Assembly& assembly, State& state);

/// A joint whose rows follow from those of others: its reactions, and theirs, are not unique.
struct RedundantJoint {
  JointId joint;              ///< what is redundant
  std::vector<JointId> with;  ///< what it follows from
};

/// Degrees of freedom of a model at a configuration.
struct Mobility {
  Index velocities = 0;                   ///< numbers that the velocities of all bodies are
  Index rows = 0;                         ///< rows of all joints and drivers
  Index independent_rows = 0;             ///< those that do not follow from others
  Index degrees_of_freedom = 0;           ///< velocities - independent_rows
  std::vector<RedundantJoint> redundant;  ///< by the order of assembly
};

/// Counts the degrees of freedom at a state, contacts aside.
[[nodiscard]] CAROM_API Mobility mobility(const Assembly& assembly, const State& state);

}  // namespace carom
