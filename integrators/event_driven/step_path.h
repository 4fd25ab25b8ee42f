#pragma once

/// \file
/// The motion within a step by its ends alone. The interpolation of a flow evaluates loads within the step:
/// it has traces of an element that is entered and left there.

#include <carom/core/export.h>

#include <cstddef>
#include <span>
#include <vector>

namespace carom {

/// One end of a step.
struct PathEnd {
  double time = 0.0;                 ///< [s]
  std::vector<double> y;             ///< unknowns of a component: q, v and others
  std::vector<double> acceleration;  ///< dv/dt
};

/// Writes the unknowns at a time within a step, of which the first `count` are coordinates, the next `count`
/// their rates: coordinates as polynomials of degree 5 with both ends' rates and accelerations, the rates and
/// accelerations of these, everything else linear in time.
CAROM_API void follow_path(const PathEnd& from, const PathEnd& to, std::size_t count, double time,
                           std::span<double> y, double* acceleration);

}  // namespace carom
