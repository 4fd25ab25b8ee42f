#pragma once

/// \file
/// Workspace of everything derived from a state, in groups by what it depends on. Refilled, not reallocated.

#include <carom/core/export.h>

#include <vector>

namespace carom {

/// Where loads are booked, generalised forces by cause [N, N m], arrays over all velocities. The three may
/// be one array where nobody asks for the causes: elements add and never read.
struct Loads {
  double* conservative = nullptr;  ///< minus the gradient of a potential
  double* dissipative = nullptr;   ///< loads that only take energy out
  double* external = nullptr;      ///< prescribed loads
};

/// Derived quantities of one state.
struct Evaluation {
  // depends on position
  std::vector<double> rotation;  ///< rotations of oriented bodies, at BodySlot::rotation
  /// By component, the time of the state that its bodies stand in [s]. Empty where all stand in one.
  std::vector<double> placed_at;

  // depends on position, velocity and time
  std::vector<double> force;  ///< sum of all loads, over all velocities [N, N m]
};

}  // namespace carom
