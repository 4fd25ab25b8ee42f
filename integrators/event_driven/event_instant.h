#pragma once

/// \file
/// The instant of an event: the state of a clock group there, which the stages of the event read and change.

#include <carom/contact/active_set.h>
#include <carom/contact/island_problem.h>
#include <carom/contact/solvers/solver_chain.h>
#include <carom/core/constraint_set.h>
#include <carom/core/export.h>
#include <carom/integrators/event_driven/event_balance.h>
#include <carom/integrators/event_driven/event_islands.h>
#include <carom/integrators/event_driven/event_scales.h>
#include <carom/integrators/event_driven/motion_sample.h>
#include <carom/integrators/event_driven/smooth_motion.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace carom {

/// Memory of an instant, shared by clock groups: an instant at a time uses it.
struct CAROM_API InstantMemory {
  explicit InstantMemory(const Assembly& assembly) : now(assembly) {}

  MotionSample now;
  std::vector<double> acceleration_before;  ///< empty before a group with contact pairs
  ConstraintSet contacts;
  std::vector<ActiveContact> before;
  std::vector<Index> before_at;
  EventIslands islands;
  std::vector<Index> stopped;
};

/// One instant of one clock group.
struct CAROM_API EventInstant {
  /// \param y the state; it is changed with that of the group
  EventInstant(SmoothMotion& group, InstantMemory& memory, double at_time, std::span<double> y_in,
               EventBalance& books);

  SmoothMotion& motion;
  double time;          ///< [s]
  std::span<double> y;  ///< state
  MotionSample& now;    ///< sample of the state, without contact
  /// Accelerations with the forces of contact up to the event; those without contact at a start.
  std::vector<double>& acceleration_before;
  ConstraintSet& contacts;             ///< contacts of all pairs at the state
  std::vector<ActiveContact>& before;  ///< contacts that were closed before the event
  std::vector<Index>& before_at;       ///< by pair: place in `before`, `none` if it was open
  EventIslands& islands;               ///< bodies that touch each other, found by find_islands()
  /// Pairs whose slow sliding is stopped at this instant, found by ImpactSettling.
  std::vector<Index>& stopped;
  EventBalance& balance;   ///< books
  EventScales scales{};    ///< of the phase to come
  double touch_gap = 0.0;  ///< gaps up to here touch, by find_touch_gap() [m]
  /// The rate of a driver, or of a shape on ground, jumps: contacts that were closed approach without having
  /// approached before.
  bool rate_jumps = false;

  /// Brings the sample, without contact, and all contacts to the state. Pairs of two bodies that cannot touch
  /// have no bodies then, and a gap that may be less than it is: infinite of two sharp corners, which meet at
  /// an edge of either, or not at all.
  void update();
  /// Finds the gap up to which contacts touch: gap_tolerance at a start, else their rounding.
  void find_touch_gap(bool starts);
  /// Takes the accelerations of the sample for those before the event.
  void take_accelerations_before();
  /// Takes the contacts of the active set for those before the event.
  void take_contacts_before();
  /// Finds the islands, by the contacts as they are; they stay during the event.
  void find_islands();
  /// True if a pair touches. One that has no bodies is known to be apart.
  [[nodiscard]] bool touches(std::size_t pair) const {
    const Constraint& contact = contacts[pair];
    return contact.rows > 0 &&
           (contact.gap <= touch_gap || (before_at[pair] != none && std::isfinite(contact.gap)));
  }
  /// True if the sliding of a pair is one that was stopped at this instant: constraints that follow from
  /// others to rounding leave some of it, which is no sliding. \param slip [m/s]
  [[nodiscard]] bool is_stopped(Index pair, double slip) const {
    return std::abs(slip) <= ActiveSet::left_by_dependent * scales.speed &&
           std::find(stopped.begin(), stopped.end(), pair) != stopped.end();
  }
  /// True if a pair takes part in impacts: one that is no farther apart than gap_tolerance. Bodies of a heap
  /// hit each other over gaps far below that, nanoseconds apart: one impact of all takes the place of these.
  [[nodiscard]] bool is_struck(std::size_t pair) const {
    const Constraint& contact = contacts[pair];
    return touches(pair) || (contact.rows > 0 && contact.gap <= motion.model().options->gap_tolerance);
  }
  /// Distance that bodies are not moved by during the event, projections included [m]: a longer way may lead
  /// into what is not in their island.
  [[nodiscard]] double longest_shift() const;
  /// Speed at which a pair approaches [m/s].
  [[nodiscard]] double approach(std::size_t pair) const {
    return -contacts[pair].normal_velocity(now.state.v.data());
  }
  /// Velocities of the model, in the sample.
  [[nodiscard]] double* velocities() { return now.state.v.data(); }
  [[nodiscard]] const double* velocities() const { return now.state.v.data(); }
  /// Takes the velocities of the sample over into the state.
  void take_velocities();

private:
  /// Whatever touches, or is moved in the event, is nearer [m].
  [[nodiscard]] double near() const;
};

/// Largest acceleration of contacts and limits along their rows at an instant [m/s^2].
[[nodiscard]] double largest_acceleration(std::span<const Constraint> constraints, const EventInstant& at);
/// Solves for the velocities after some time under the accelerations of an instant, b = gamma + time a.
/// \param time [s] \param constraints without restitution; their rows turn during that time \param ahead
/// memory \param problem that is stated and solved; true if its answer is usable
[[nodiscard]] bool solve_ahead(double time, std::span<Constraint> constraints, EventInstant& at,
                               std::vector<double>& ahead, IslandProblem& problem, SolverChain& chain);

}  // namespace carom
