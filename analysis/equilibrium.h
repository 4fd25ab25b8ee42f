#pragma once

/// \file
/// Static equilibrium: loads, reactions of joints and forces of closed contacts balance,
///
///     f(q) + G(q)^T l = 0,   g(q) = 0,
///
/// where G has the rows of the joints, the normals of the closed contacts and the tangents of those that
/// stick. Matrices are dense: for models of a few hundred bodies.

#include <carom/core/constraint.h>
#include <carom/core/export.h>
#include <carom/core/joint_kind.h>
#include <carom/core/state.h>
#include <carom/core/system.h>
#include <carom/integrators/run/stop_request.h>

#include <array>
#include <string>
#include <vector>

namespace carom {

class Assembly;

/// Options of the search for an equilibrium.
struct EquilibriumOptions {
  /// Contacts with gaps up to this at the start are taken as closed, and stay so; with friction, they stick
  /// where they touch. >= 0 [m]
  double contact_tolerance = 1e-6;
  /// Forces that may be left over against those that act, and gaps against coordinates (at least 1 m), where
  /// Newton's method makes no more progress. > 0
  double tolerance = 1e-10;
  int most_steps = 200;  ///< of Newton's method, >= 1
  /// Asked at every trial; where it returns true the search ends with Cancelled. May be empty.
  StopFunction stop_when{};
};

/// Forces of a joint in equilibrium.
struct JointForce {
  JointId joint;                    ///< identity
  std::vector<double> multipliers;  ///< of its rows [N, N m]
  JointReaction reaction;           ///< on its body `to`
};

/// Forces of a closed contact or a limit in equilibrium.
struct ContactForce {
  ConstraintKey key;                   ///< identity
  std::string name;                    ///< "particle 'lower' on half-plane #0"
  double normal = 0.0;                 ///< force, >= 0 [N; N m of the stop of an angle]
  std::array<double, 2> tangential{};  ///< along the contact's other rows [N]; one of them in the plane
  double friction = 0.0;               ///< coefficient of sticking; 0 without friction
};

/// A state of rest. Forces of joints and contacts that are not determined (redundant ones) are one choice of
/// many: the smallest, or where that is outside a cone of friction one within all of them.
struct Equilibrium {
  State state;                         ///< positions; velocities are 0
  std::vector<JointForce> joints;      ///< by component, then by kind; stops are among the contacts
  std::vector<ContactForce> contacts;  ///< closed ones
  double residual = 0.0;               ///< largest force left over, moments over radii of gyration [N]
  double gap = 0.0;                    ///< largest gap left in joints and closed contacts [m, rad]
  int steps = 0;                       ///< of Newton's method

  /// Forces of a joint. Throws ModelError for a joint that is not in it.
  [[nodiscard]] CAROM_API const JointForce& force(JointId joint) const;
};

/// Computes an equilibrium near a state by Newton's method, at the time of the state: prescribed motions are
/// at their positions at that time. Stability is not tested (see find_modes()). Throws ModelError for invalid
/// options or states and for elements with internal variables; SolverError, naming the parts,
///  - if no equilibrium is found: the parts furthest from balance or from being closed,
///  - if there is a motion without stiffness: the bodies that can move,
///  - if a contact would have to pull, would slip, or an open one would be penetrated.
[[nodiscard]] CAROM_API Equilibrium find_equilibrium(const Assembly& assembly, const State& start,
                                                     const EquilibriumOptions& options = {});
/// Computes an equilibrium near the described positions, at time 0; throws as the function for a state. A
/// Simulation accepts states of its own assembly only: for that, pass its assembly() and state().
[[nodiscard]] CAROM_API Equilibrium find_equilibrium(const System& system,
                                                     const EquilibriumOptions& options = {});

}  // namespace carom
