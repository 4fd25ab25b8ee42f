#pragma once

/// \file
/// Contacts that touch without normal speed, and in which direction each is taken to slip while modes are
/// decided (mode_decision.h).

#include <carom/contact/detection/detector.h>
#include <carom/contact/solvers/contact_mode.h>
#include <carom/contact/solvers/contact_problem.h>
#include <carom/contact/tangent_direction.h>
#include <carom/core/constraint.h>
#include <carom/core/export.h>

#include <cstddef>
#include <span>
#include <vector>

namespace carom {

/// A contact that touches without normal speed; or the rolling resistance of the candidate before it.
struct Candidate {
  ContactPair pair;
  Index place = none;  ///< of the pair among those of the motion
  SingleConstraint at;
  double slip = 0.0;  ///< tangential velocity, 0 if it may stick [m/s]; or relative spin [rad/s]
  ContactMode present = ContactMode::open;  ///< before the decision
  ContactMode mode = ContactMode::open;     ///< decided
  bool starts_slipping = false;     ///< its friction is exhausted: it slips against it, unless that cannot be
  bool frictionless = false;        ///< without friction
  bool releases = false;            ///< its force has come to an end: it opens, unless that cannot be
  bool stays_open = false;          ///< its force has ended twice at one instant: it opens
  double exhausted_friction = 0.0;  ///< the friction force that was exhausted [N]
  double noise = 0.0;               ///< uncertainty of `exhausted_friction` [N]
  // Where the problem was Painleve's:
  double stiffness = 0.0;          ///< W_nn - s mu W_nt [1/kg]; infinite of friction in a joint
  double free_acceleration = 0.0;  ///< normal acceleration without contact [m/s^2]
};

/// Mode of a contact that slips, or of one that rolls, by the sign of the velocity; sticking where it is 0.
[[nodiscard]] inline ContactMode mode_by_sign(double velocity) {
  return velocity > 0.0   ? ContactMode::slip_positive
         : velocity < 0.0 ? ContactMode::slip_negative
                          : ContactMode::stick;
}

/// Number of candidates that are not attached to others: groups of rows of their problem.
[[nodiscard]] CAROM_API std::size_t groups_of(std::span<const Candidate> candidates);

/// Mode that a candidate is taken to have.
struct SlipDirection {
  TangentDirection direction{};  ///< of the sliding velocity; zero: may stick
  bool open = false;             ///< taken as open
  bool reverted = false;         ///< was taken to start slipping or slip and did not
};

/// Modes that the candidates of an island are taken to have. Keeps memory only.
class CAROM_API SlipDirections {
public:
  /// An acceleration this small against those without contact is zero.
  static constexpr double no_acceleration = 1e-11;

  /// Begins with what velocities say, and events that have just ended modes.
  void start(std::span<const Candidate> candidates);
  /// Mode that a candidate is taken to have.
  [[nodiscard]] SlipDirection& operator[](std::size_t candidate) { return slips_[candidate]; }
  [[nodiscard]] const SlipDirection& operator[](std::size_t candidate) const { return slips_[candidate]; }
  /// Changes by an answer: contacts that start slipping have their sliding friction; those that were taken to
  /// open or slip and do not, since another one that slips took them along, are put back. True if the problem
  /// is to be solved anew. \param candidates with their modes \param problem answered \param size of
  /// accelerations without contact [m/s^2] \param acceleration of all bodies
  [[nodiscard]] bool revise(std::span<const Candidate> candidates, const ContactProblem& problem, double size,
                            const double* acceleration);

  /// Lets all that has no velocity stick or slip, and stay closed or open, as the law of contact has it:
  /// contacts that an event brought to the end of their modes, all of them together, may leave no forces,
  /// since impulses of contacts that jam do work on slips that no velocities of bodies have. The law without
  /// such assumptions has an answer. True if something was assumed.
  [[nodiscard]] bool forget_ends(std::span<const Candidate> candidates);

private:
  std::vector<SlipDirection> slips_;
};

}  // namespace carom
