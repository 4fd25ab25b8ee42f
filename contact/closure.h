#pragma once

/// \file
/// Joints and contacts that last are closed: gaps = 0, and velocities along rows = 0, by the smallest change
/// in the sense of the masses:
///     minimise |d|_M  such that  G d = -g(q),        minimise |u|_M  such that  G (v + u) = 0,
/// for the rows G of joints and of closed contacts; of those that stick the tangential row too, on velocity
/// level alone, since they have no place of their own. What is linearised leaves the square of an error.

#include <carom/contact/active_set.h>
#include <carom/core/assembly.h>
#include <carom/core/dynamics/joint_constraints.h>
#include <carom/core/export.h>
#include <carom/core/function_ref.h>
#include <carom/core/state.h>

#include <span>
#include <vector>

namespace carom {

/// Gaps that are to be closed, and where bodies stand.
struct ClosureInput {
  const Assembly& assembly;
  std::span<const Index> components;          ///< components that may move, ascending
  std::span<JointConstraints* const> joints;  ///< of the components that have joints; factored at the state
  ActiveSet& contacts;                        ///< closed contacts with their modes, brought to the state
  StateView state;                            ///< q and v of the model
  const double* force = nullptr;              ///< loads over all velocities at the state [N, N m]
};

/// The changes that a closure has made.
struct Closure {
  bool changed = false;  ///< true if anything has changed
  /// Energy taken out [J]; the potential changes by minus the work of its forces, to first order: the rest is
  /// the square of rounding.
  double lost = 0.0;
  /// Kinetic energy of the change of velocities [J]: positive, and what it took where nothing is prescribed.
  double velocity_energy = 0.0;
  double shift = 0.0;  ///< largest displacement, angles weighed by a length [m]
};

/// Arrays over all velocities of a model.
struct CAROM_API ClosureMemory {
  explicit ClosureMemory(const Assembly& assembly);

  std::vector<double> of_position;  ///< changes of places that close all [m, rad]
  std::vector<double> of_velocity;  ///< changes of velocities that close all [m/s, rad/s]
  std::vector<double> momentum;     ///< M times `of_velocity`
  std::vector<double> lengths;      ///< Assembly::length_scales()
  std::vector<double> rates;        ///< of the rows of joints
};

/// Finds the changes that close all: `memory` has them then. False where nothing is to be closed.
[[nodiscard]] CAROM_API bool find_closure(const ClosureInput& in, ClosureMemory& memory);

/// Where the first coordinate and the first velocity of a component are written.
struct ClosedPlace {
  double* q = nullptr;
  double* v = nullptr;
};

/// Finds the changes that close all, and writes the state with them; nothing where nothing changes.
/// \param place_of tells where a component is written
CAROM_API Closure close(const ClosureInput& in, FunctionRef<ClosedPlace(Index)> place_of,
                        ClosureMemory& memory);

}  // namespace carom
