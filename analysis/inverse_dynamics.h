#pragma once

/// \file
/// Forces of drivers that move a mechanism as prescribed (inverse dynamics). Contacts and limits are ignored.

#include <carom/core/export.h>
#include <carom/core/state.h>
#include <carom/core/system.h>

#include <span>
#include <vector>

namespace carom {

class Assembly;

/// Forces of all drivers at one time.
struct DriverForces {
  State state;                        ///< positions and velocities
  std::vector<double> accelerations;  ///< of all velocity coordinates [m/s^2, rad/s^2]
  std::vector<double> forces;         ///< by driver, along its coordinate, as of a motor [N m, N]
  std::vector<double> powers;         ///< by driver: force times rate of the coordinate [W]
};

/// Drivers and their forces over time.
struct InverseDynamics {
  std::vector<JointId> drivers;       ///< by component, then by kind
  std::vector<DriverForces> samples;  ///< by time
};

/// Drivers of a model, in the order of their forces: by component.
[[nodiscard]] CAROM_API std::vector<JointId> drivers(const Assembly& assembly);

/// Forces of the drivers at a state that satisfies the joints. Accelerations that drivers do not prescribe
/// follow from the loads. Throws ModelError for an invalid state, and SolverError, naming the driver, if its
/// force is not determined (because others prescribe the same).
[[nodiscard]] CAROM_API DriverForces driver_forces(const Assembly& assembly, const State& state);

/// Forces of the drivers at given times: the positions at each time are determined by joints and drivers, and
/// computed from those at the time before. Times must be so close to each other that the joints are not
/// closed in another configuration than the intended one. \param times finite, ascending [s]; the first near
/// the described positions Throws ModelError for invalid times, for a system without drivers or with degrees
/// of freedom that no driver prescribes, and for joints that cannot be closed; SolverError as
/// driver_forces().
[[nodiscard]] CAROM_API InverseDynamics inverse_dynamics(const System& system, std::span<const double> times);

}  // namespace carom
