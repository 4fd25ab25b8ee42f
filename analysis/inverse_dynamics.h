#pragma once

/// \file
/// Forces of drivers: what it takes to move a mechanism as prescribed. Contacts and stops do not act.

#include <carom/core/assembly.h>
#include <carom/core/export.h>
#include <carom/core/state.h>
#include <carom/core/system.h>

#include <span>
#include <vector>

namespace carom {

/// Forces of all drivers at one time.
struct DriverForces {
  State state;                        ///< positions and velocities
  std::vector<double> accelerations;  ///< of all velocity coordinates [m/s^2, rad/s^2]
  std::vector<double> forces;         ///< by driver, along its coordinate, as of a motor [N m, N]
  std::vector<double> powers;         ///< by driver: force times rate of the coordinate [W]
};

/// Drivers and their forces over time.
struct InverseDynamics {
  std::vector<JointId> drivers;       ///< by island, then by kind
  std::vector<DriverForces> samples;  ///< by time
};

/// Drivers of a model, in the order in which their forces are told: by island.
[[nodiscard]] CAROM_API std::vector<JointId> drivers(const Assembly& assembly);

/// Forces of the drivers at a state that obeys the joints. Motions that drivers do not prescribe accelerate
/// as loads make them. Throws ModelError for a state that cannot be, and SolverError, naming it, where the
/// force of a driver is not determined (it and others prescribe the same).
[[nodiscard]] CAROM_API DriverForces driver_forces(const Assembly& assembly, const State& state);

/// Forces of the drivers at times given: the positions at each are those that joints and drivers leave, found
/// from those at the time before. Times must lie so near to each other that no joint is closed in another
/// way than in the motion that is meant. \param times finite, ascending [s]; the first near the described
/// positions
/// Throws ModelError for times that cannot be, for a system without drivers or with freedom that they leave,
/// and for joints that cannot be closed; SolverError as driver_forces().
[[nodiscard]] CAROM_API InverseDynamics inverse_dynamics(const System& system, std::span<const double> times);

}  // namespace carom
