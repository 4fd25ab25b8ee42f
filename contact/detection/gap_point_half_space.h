#pragma once

/// \file
/// Narrow phase of a point and a half-space: gap(x) = n.(x - p), with n the unit normal and p a point of the
/// boundary.

#include <carom/core/export.h>
#include <carom/core/ground_shape_kind.h>
#include <carom/core/space.h>

#include <cstdint>

namespace carom {

/// Distance of a point from the boundary, and its gradient. \param point D numbers [m]
template <int D>
[[nodiscard]] CAROM_API Gap gap_point_half_space(const double* point, const Vec<D>& origin,
                                                 const Vec<D>& normal);

/// Which of up to 64 points have a distance <= `margin` [m], or one that is no number: bit i of the point
/// number i.
template <int D>
[[nodiscard]] CAROM_API std::uint64_t points_in_half_space(const PointRow& row, const Vec<D>& origin,
                                                           const Vec<D>& normal, double margin);

}  // namespace carom
