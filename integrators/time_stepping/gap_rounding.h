#pragma once

/// \file
/// Gaps that are rounding in time stepping.

#include <carom/integrators/run/time_stepping.h>

namespace carom {

/// A body that was hit where a gap closed, or was moved out of the ground, stands on it to rounding: on
/// either side of it, by up to this [m]. It is what positions are iterated to, TimeStepping::tolerance, so
/// that it has the size of the model as that has; 1e-12 m where that is 0.
[[nodiscard]] inline double gap_rounding(const TimeStepping& options) {
  constexpr double usual = 1e-12;
  return options.tolerance > 0.0 ? options.tolerance : usual;
}

}  // namespace carom
