#pragma once

/// \file
/// Events as data: impacts, contacts that close, open, stick and slip, accumulations (Zeno), switching
/// points.

#include <carom/contact/solvers/contact_solver.h>
#include <carom/core/constraint.h>
#include <carom/core/contact_frame.h>
#include <carom/core/export.h>
#include <carom/core/ids.h>
#include <carom/integrators/run/impact_note.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <iosfwd>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace carom {

/// Kinds of events.
enum class EventKind : std::uint8_t {
  impact,        ///< a contact that took part in an impact
  accumulation,  ///< a contact closed by an impact without restitution below the capture speed (Zeno)
  closing,       ///< an open contact joins the active set: it stays closed
  lift_off,      ///< a closed contact opens
  stick,         ///< a slipping contact sticks
  slip,          ///< a sticking contact slips, or a slipping one reverses
  impact_without_collision,  ///< no contact forces exist (Painleve): an impact at zero normal speed
  several_accelerations,     ///< several accelerations are possible (Painleve): one was chosen by rule
  switching_point,           ///< loads of an element change their form
  discontinuity,             ///< of a law of time: it jumps or has a kink, as its part says
  mode_switch,               ///< a contact was opened when the simulation changed to the event-driven mode
  roll,  ///< a contact whose rolling resistance held it begins to roll, or rolls the other way
  hold   ///< the relative spin of a contact that rolls has stopped: rolling resistance holds it
};
/// Number of kinds.
inline constexpr std::size_t event_kind_count = 13;

/// Name of a kind: "impact", "lift-off", ...
[[nodiscard]] CAROM_API std::string_view to_string(EventKind kind);
/// True of kinds of impacts: velocities jump.
[[nodiscard]] constexpr bool is_impulsive(EventKind kind) {
  return kind == EventKind::impact || kind == EventKind::accumulation ||
         kind == EventKind::impact_without_collision;
}

/// Parts that an event is of.
struct EventParts {
  ConstraintKey contact{};  ///< of a contact
  BodyId body{};            ///< its body, that of `a` of the key
  ObstacleId obstacle{};    ///< what it touches; or whose law of time jumps
  ElementId element{};      ///< of a switching point, or whose law of time jumps
  JointId joint{};          ///< driver whose law of time jumps
  BodyId other{};           ///< of a contact of two bodies: that of `b` of the key
};

/// Answer of the contact solvers that an event follows from.
struct EventSolution {
  ContactMode mode = ContactMode::open;   ///< of the contact, after
  Outcome outcome = Outcome::not_solved;  ///< number of solutions of the problem that decided, if known
  double residual = 0.0;                  ///< certificate of its answer
  std::string_view solver{};              ///< solver whose answer was used
};

/// Motion of a body at an event. In the plane x, y and the angle; in space x, y, z.
struct EventMotion {
  BodyId body{};                            ///< not valid where there is none
  std::array<double, 3> position{};         ///< at the event [m], [rad]
  std::array<double, 3> velocity_before{};  ///< before the event [m/s], [rad/s]
  std::array<double, 3> velocity_after{};   ///< after the event [m/s], [rad/s]; as before but for impacts
};

/// One event, of one contact; or, where there is no contact (`body` is not valid), of one force element,
/// driver or shape on ground. Simulation::name() names the part. Numbers by direction are along the normal
/// first, then along the tangents; ContactFrame::vector_of() makes them a vector in the fixed frame. The
/// frame is known of impacts and mode changes, and zero of other events.
struct EventRecord : EventParts, EventSolution, ImpactNote, ContactFrame {
  double time = 0.0;  ///< [s]
  /// Number of the instant: records of one group of bodies at one time, with what follows there from one
  /// event, have the same. Ascends along the list by 0 or 1, from 0 where none were cleared.
  std::int64_t instant = 0;
  EventKind kind = EventKind::impact;       ///< what happened
  std::array<double, 3> velocity_before{};  ///< gamma^- [m/s]
  std::array<double, 3> velocity_after{};   ///< gamma^+ [m/s]
  std::array<double, 3> impulse{};          ///< P [N s]; 0 but for impacts and changes of the mode
  double gap = 0.0;                         ///< of impacts and mode changes: gap then [m]
  double energy_before = 0.0;               ///< kinetic energy of all bodies that answer, before [J]
  double energy_after = 0.0;                ///< kinetic energy of all bodies that answer, after [J]
  /// Motions of the bodies that the contact is of, first that which `body` names; none of events without a
  /// contact.
  std::array<EventMotion, 3> motions{};
  /// Of a Painleve state: W_nn - s mu W_nt, the normal acceleration per unit of normal force while slipping
  /// with sign s [1/kg], and the normal acceleration without contact [m/s^2].
  double stiffness = 0.0, free_acceleration = 0.0;
  /// Of an accumulation: time at which infinitely many impacts would have ended, by the ratio of their
  /// intervals; NaN where the ratios had not converged [s].
  double accumulation_time = std::numeric_limits<double>::quiet_NaN();
};

/// Events by kind.
using EventCounts = std::array<std::int64_t, event_kind_count>;

/// Writes events as CSV, one line each: time, kind, name, numbers with units in the header, exact digits.
/// \param name_of gives the name of the part of an event (Simulation::name())
CAROM_API void write_events(std::ostream& out, const std::vector<EventRecord>& events,
                            const std::function<std::string(const EventRecord&)>& name_of);

}  // namespace carom
