#pragma once

/// \file
/// Options of the time-stepping mode (Johansson 1999, section 4).

namespace carom {

/// Steps of fixed length: coupling forces by the implicit trapezoidal rule through a fixed-point iteration,
/// contacts found at the start of a step, their law in every step of a lasting contact.
struct TimeStepping {
  double step = 1e-3;  ///< h > 0 [s]

  /// The iteration ends when positions, and h times velocities, change less than this between two sweeps
  /// (angles weighed with the radius of gyration). At 0 it goes on until the change stops shrinking [m].
  double tolerance = 1e-12;
  int max_sweeps = 200;  ///< sweeps after which the iteration is given up

  /// A contact that closes faster than this is booked as an impact, otherwise as lasting contact. It decides
  /// about lines of the energy account only, never about the motion [m/s].
  double capture_speed = 1e-2;
  /// Refuse, with a SolverError, a step in which contact adds energy (possible where e_n and e_t differ).
  bool refuse_energy_gain = false;
};

}  // namespace carom
