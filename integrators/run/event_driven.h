#pragma once

/// \file
/// Options of the event-driven mode (docs/method.md, section 7).

#include <carom/contact/solvers/impact_rules.h>
#include <carom/core/export.h>
#include <carom/integrators/flow/flow_method.h>

#include <cstdint>
#include <string>

namespace carom {

/// Which events are recorded. Converts from bool: false is `nothing`, true `all`.
class EventRecords {
public:
  /// The choices.
  enum Choice : std::uint8_t {
    nothing,       ///< no event
    with_impulse,  ///< all but contacts without impulse in an impact
    all            ///< all events, also contacts without impulse in an impact
  };
  /// `all` or `nothing`. Implicit: an option is a bool or a choice.
  constexpr EventRecords(bool on)  // NOLINT(google-explicit-constructor)
      : choice_(on ? all : nothing) {}
  /// The given choice. Implicit: an option is a bool or a choice.
  constexpr EventRecords(Choice choice)  // NOLINT(google-explicit-constructor)
      : choice_(choice) {}
  /// The choice.
  [[nodiscard]] constexpr Choice choice() const { return choice_; }
  /// True unless it is `nothing`.
  constexpr explicit operator bool() const { return choice_ != nothing; }

private:
  Choice choice_;
};

/// Smooth phases by an integrator of variable step; the times of contact events are located, and impacts and
/// changes of contact modes are solved at these times. docs/events.md has a table of these options.
struct EventDriven {
  double relative_tolerance = 1e-9;  ///< largest error of a step relative to each unknown, > 0
  /// Largest absolute error of a step, > 0: of positions [m] and velocities [m/s]; angles count times the
  /// radius of gyration, works relative to the mass of their component times 1 m^2/s^2.
  double absolute_tolerance = 1e-11;
  FlowMethod method = FlowMethod::explicit_runge_kutta;  ///< of the smooth phases

  /// Output interval: step() stops and observers are called at its multiples, > 0 [s]. It does not change the
  /// motion: every component has its own steps, and output states are computed within them. Where nobody
  /// looks (no observer, no log with a sink, no stop function, no progress bar) run_until() goes straight to
  /// its end, or to the next periodic action, and that is one step.
  double interval = 1e-2;
  /// Longest step where loads or shapes on ground depend on time, > 0 [s]. Changes between the stages of a
  /// step are not detected: it must be shorter than the shortest pulse of a load, and than the period of a
  /// prescribed motion.
  double longest_step = 0.1;

  /// Surfaces at most this far apart at the start are in contact; deeper penetration is refused, > 0 [m].
  /// Rounding of gaps is judged against a billion times this where all coordinates are smaller, and a sharp
  /// corner this far beyond the end of an edge still touches it: scale it with bodies much smaller than 1 mm,
  /// or larger than 1 km.
  double gap_tolerance = 1e-9;
  /// Impacts with no faster approach than this are solved without restitution and close the contacts, > 0
  /// [m/s]: they end accumulations of impacts (Zeno). The neglected bounces are not higher than its square
  /// over 2 g, 5e-10 m for the default; the energy is booked as `accumulation`. Of a limit of an angle: its
  /// rate times the arm k_a k_b/sqrt(k_a^2 + k_b^2), radii of gyration, up to a power of two.
  double capture_speed = 1e-4;
  ImpactRules impact_rules{};  ///< impacts of several contacts, and those that would add energy
  /// After each step velocities are projected onto joints and closed contacts. A projection that changes them
  /// by more than this part of the component's kinetic energy, beyond what the absolute tolerance explains,
  /// ends the run with a SolverError that names the joints, > 0: the position is singular, or too near one.
  double largest_projection = 1e-6;
  /// A run with more events per second of simulated time, over the last 1,000 events of a component, ends
  /// with a SolverError, > 0 [1/s].
  double event_limit = 1e6;
  /// More steps of the integrator than this per second of simulated time, over the last 10,000 of a
  /// component, end a run with a SolverError that names its stiffest coupling, > 0 [1/s].
  double step_limit = 1e9;
  /// More evaluations of the motion of a component than this within one of its steps, its events or between
  /// two looks at it end a run with a SolverError, > 0.
  std::int64_t evaluation_limit = 10'000'000;
  /// Keep a record of every event (Simulation::events()). With false no record is made, and the report of a
  /// step lists neither contacts nor impulses of joints; statistics count events all the same. Contacts
  /// that were closed in an impact and took no impulse have none with EventRecords::with_impulse.
  EventRecords record_events = true;
  /// Keep at most so many records, the latest; the report of a step lists the contacts of these. 0: all.
  std::int64_t record_limit = 0;

  /// An existing directory where the contact problem of a SolverError is written to a file, whose name is in
  /// the message (docs/contact_problems.md). Empty: nothing is written.
  std::string failure_directory{};
};

/// Checks options. Throws ModelError naming the option that is not allowed.
CAROM_API void check_options(const EventDriven& options);

}  // namespace carom
