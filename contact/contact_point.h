#pragma once

/// \file
/// Place of a contact, read off its rows.

#include <carom/core/constraint.h>

#include <array>

namespace carom {

/// Point and normal of a contact. Of a constraint that is none both are 0.
struct PointOfContact {
  std::array<double, 3> point{};   ///< where the first body is touched [m]
  std::array<double, 3> normal{};  ///< unit vector towards it
};

/// Where a contact touches: the lever r of the first body follows from its rows, n x r = -r.t, t x r = r.n.
/// \param centre coordinates of the first body's centre of mass [m]
[[nodiscard]] inline PointOfContact point_of_contact(const Constraint& at, const double* centre) {
  PointOfContact out;
  if (at.type != ConstraintType::contact) return out;
  const double *const n = at.row(0), *const t = at.row(1);
  if (at.rows == 2) {
    out.normal = {n[0], n[1], 0.0};
    out.point = {centre[0], centre[1], 0.0};
    if (at.blocks[0].columns != 3) return out;
    out.point[0] += n[2] * t[0] - t[2] * n[0];
    out.point[1] += n[2] * t[1] - t[2] * n[1];
    return out;
  }
  out.normal = {n[0], n[1], n[2]};
  out.point = {centre[0], centre[1], centre[2]};
  return out;
}

}  // namespace carom
