#pragma once

/// \file
/// Place of a contact, read off its rows.

#include <carom/core/constraint.h>

#include <array>

namespace carom {

/// Point and normal of a contact. Of a constraint that is none both are 0.
struct PointOfContact {
  std::array<double, 3> point{};   ///< where the first body is touched [m]
  std::array<double, 3> normal{};  ///< unit vector towards the first body
};

/// Where a contact touches: the lever r of the first body follows from its rows, n x r = -r.t, t x r = r.n.
/// \param centre coordinates of the first body's centre of mass [m] \param point,normal out, zero before;
/// they stay so of a constraint that is no contact
inline void find_point_of_contact(const Constraint& at, const double* centre, std::array<double, 3>& point,
                                  std::array<double, 3>& normal) {
  if (at.rows < 2) return;
  const double *const n = at.row(0), *const t = at.row(1);
  if (at.rows == 2) {
    normal[0] = n[0];
    normal[1] = n[1];
    const bool turns = at.blocks[0].columns == 3;
    point[0] = turns ? centre[0] + (n[2] * t[0] - t[2] * n[0]) : centre[0];
    point[1] = turns ? centre[1] + (n[2] * t[1] - t[2] * n[1]) : centre[1];
    return;
  }
  normal = {n[0], n[1], n[2]};
  point = {centre[0], centre[1], centre[2]};
}

/// Point and normal of a contact, as find_point_of_contact() writes them; zero of a constraint that is no
/// contact.
[[nodiscard]] inline PointOfContact point_of_contact(const Constraint& at, const double* centre) {
  PointOfContact out;
  find_point_of_contact(at, centre, out.point, out.normal);
  return out;
}

}  // namespace carom
