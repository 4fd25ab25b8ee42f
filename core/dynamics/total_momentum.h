#pragma once

/// \file
/// Momentum of a whole model.

#include <carom/core/export.h>
#include <carom/core/state.h>

#include <array>

namespace carom {

class Assembly;

/// Sums over all bodies; in the plane x and y of the linear and z of the angular momentum, the others 0.
struct TotalMomentum {
  std::array<double, 3> linear{};   ///< [N s]
  std::array<double, 3> angular{};  ///< about the origin [N m s]
  double linear_scale = 0.0;        ///< largest single term of the linear sums [N s]
  double angular_scale = 0.0;       ///< largest single term of the angular sums [N m s]
};

/// Momentum of `state`. Throws ModelError for a state of another model.
[[nodiscard]] CAROM_API TotalMomentum total_momentum(const Assembly& assembly, const State& state);

}  // namespace carom
