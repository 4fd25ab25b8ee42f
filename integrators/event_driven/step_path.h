#pragma once

/// \file
/// The motion within a step by its ends alone. The interpolation of a flow evaluates loads within the step:
/// it has traces of an element that is entered and left there.

#include <carom/core/export.h>

#include <cstddef>
#include <span>
#include <vector>

namespace carom {

/// One coordinate at one time, with its rate and acceleration.
struct CoordinateMotion {
  double place = 0.0, rate = 0.0, acceleration = 0.0;
};
/// A coordinate within a step, as a polynomial of degree 5 that has the motions at both ends. \param length
/// of the step [s] \param tau part of it that is over
[[nodiscard]] CAROM_API CoordinateMotion motion_between(const CoordinateMotion& from,
                                                        const CoordinateMotion& to, double length,
                                                        double tau);

/// One end of a step.
struct PathEnd {
  double time = 0.0;                 ///< [s]
  std::vector<double> y;             ///< unknowns of a component: q, v and others
  std::vector<double> acceleration;  ///< dv/dt
};

/// Writes the unknowns at a time within a step, of which the first `count` are coordinates, the next `count`
/// their rates: coordinates by motion_between(), everything else linear in time.
CAROM_API void follow_path(const PathEnd& from, const PathEnd& to, std::size_t count, double time,
                           std::span<double> y, double* acceleration);

}  // namespace carom
