#pragma once

/// \file
/// Options of the event-driven mode (docs/method.md, section 7).

#include <carom/core/export.h>
#include <carom/integrators/flow.h>

#include <cstdint>
#include <string>

namespace carom {

/// Smooth phases by an integrator of variable step, contact events located in time, impacts and changes of
/// contact modes solved where they happen.
struct EventDriven {
  double relative_tolerance = 1e-9;  ///< of every step, > 0
  /// Of every step, > 0: of positions [m] and, per second, velocities; angles are weighed with the radius of
  /// gyration; works with the mass of their island times 1 m^2/s^2.
  double absolute_tolerance = 1e-11;
  FlowMethod method = FlowMethod::explicit_runge_kutta;  ///< of the smooth phases

  /// Distance of the times at which step() stops and observers are called, > 0 [s]. It does not change the
  /// motion: every island goes at its own pace, and is looked at in between.
  double interval = 1e-2;
  /// No step is longer where loads or obstacles depend on time, > 0 [s]. What happens between the stages of a
  /// step goes unseen: it must be shorter than the shortest pulse of a load, and than a period of a motion.
  double longest_step = 0.1;

  /// Two surfaces this near at the start touch; deeper ones are refused, > 0 [m].
  double gap_tolerance = 1e-9;
  /// Impacts in which nothing approaches faster than this end in closed contacts, > 0 [m/s]: so end
  /// accumulations of impacts. A body bounces no higher than its square over 2 g after that, 5e-10 m for the
  /// default; the energy is booked as `accumulation`.
  double capture_speed = 1e-4;
  /// Refuse, with a SolverError, an impact that adds energy (possible where e_n and e_t differ).
  bool refuse_energy_gain = false;
  /// More events than this per second of simulated time, over the last 1,000 of an island, end a run with a
  /// SolverError, > 0 [1/s].
  double event_limit = 1e6;
  /// Whether every event is kept (Simulation::events()).
  bool record_events = true;

  /// An existing directory where the contact problem of a SolverError is written to a file
  /// (docs/contact_problems.md), whose name the message tells. Empty: nothing is written.
  std::string failure_directory{};
};

/// Demands options that can be. Throws ModelError naming the option.
CAROM_API void check_options(const EventDriven& options);

}  // namespace carom
