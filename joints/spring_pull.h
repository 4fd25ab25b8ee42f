#pragma once

/// \file
/// Pulls of many springs in the plane, four at a time where the processor has 256-bit vectors (AVX2).

#include <carom/core/ids.h>
#include <carom/core/numerics/pair.h>

namespace carom {

/// Neighbouring springs with dashpots between points, whose first coordinates are also the places of their
/// velocities and loads; a property is `*(property + spring * stride)`, stride 0 or 1.
struct PlanarSprings {
  const Index* from = nullptr;          ///< first coordinate of one end
  const Index* to = nullptr;            ///< first coordinate of the other end
  const double* stiffness = nullptr;    ///< [N/m]
  const double* damping = nullptr;      ///< [N s/m]
  const double* free_length = nullptr;  ///< [m]
  Index stiffness_stride = 0;           ///< stride of `stiffness`
  Index damping_stride = 0;             ///< stride of `damping`
  Index free_length_stride = 0;         ///< stride of `free_length`
};

/// Adds the loads of springs to `spring_load` and those of dashpots to `dashpot_load`, or to the first if
/// that is null, and the potentials to `potential` unless null. Goes from spring `first` as far towards
/// `last` as it can four by four; the same bits come out as two by two. Returns the first spring left.
[[nodiscard]] Index pull_by_fours(const PlanarSprings& springs, Index first, Index last, const double* q,
                                  const double* v, double* spring_load, double* dashpot_load,
                                  PairSum* potential);

}  // namespace carom
