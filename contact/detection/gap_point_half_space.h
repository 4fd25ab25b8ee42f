#pragma once

/// \file
/// Narrow phase of a point and a half-space: gap(x) = n.(x - p), with n the unit normal and p a point of the
/// boundary.

#include <carom/core/export.h>
#include <carom/core/ground_shape_kind.h>
#include <carom/core/space.h>

namespace carom {

/// Points of which each is `stride` numbers behind the one before.
struct PointRow {
  const double* points = nullptr;  ///< of the first
  Index stride = 0;                ///< numbers from one to the next
  Index count = 0;                 ///< of points
};

/// Distance of a point from the boundary, and its gradient. \param point D numbers [m]
template <int D>
[[nodiscard]] CAROM_API Gap gap_point_half_space(const double* point, const Vec<D>& origin,
                                                 const Vec<D>& normal);

/// True if the distance of any point is <= `margin` [m].
template <int D>
[[nodiscard]] CAROM_API bool any_point_in_half_space(const PointRow& row, const Vec<D>& origin,
                                                     const Vec<D>& normal, double margin);

}  // namespace carom
