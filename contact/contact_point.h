#pragma once

/// \file
/// Place of a contact, read off its rows.

#include <carom/core/constraint.h>
#include <carom/core/export.h>

#include <array>

namespace carom {

/// Point and normal of a contact. Of a constraint that is none both are 0.
struct PointOfContact {
  std::array<double, 3> point{};   ///< where the first body is touched [m]
  std::array<double, 3> normal{};  ///< unit vector towards it
};

/// Where a contact touches: the lever r of the first body follows from its rows, n x r = -r.t, t x r = r.n.
/// \param centre coordinates of the first body's centre of mass [m]
[[nodiscard]] CAROM_API PointOfContact point_of_contact(const Constraint& at, const double* centre);

}  // namespace carom
