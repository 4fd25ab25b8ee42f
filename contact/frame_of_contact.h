#pragma once

/// \file
/// Place and directions of a contact, read off its rows.

#include <carom/core/constraint.h>
#include <carom/core/contact_frame.h>

namespace carom {

/// Reads the frame of a contact off its rows. In the plane the lever r of the first body follows from these,
/// n x r = -r.t, t x r = r.n. \param centre coordinates of the first body's centre of mass [m] \param out of
/// a constraint that is no contact its number of directions, and zero
inline void read_contact_frame(const Constraint& at, const double* centre, ContactFrame& out) {
  out.directions = at.rows;
  if (at.rows < 2) {
    out.point = out.normal = {};
    return;
  }
  const double *const n = at.row(0), *const t = at.row(1);
  if (at.rows == 2) {
    out.normal = {n[0], n[1], 0.0};
    const bool turns = at.blocks[0].columns == 3;
    out.point = {turns ? centre[0] + (n[2] * t[0] - t[2] * n[0]) : centre[0],
                 turns ? centre[1] + (n[2] * t[1] - t[2] * n[1]) : centre[1], 0.0};
    return;
  }
  out.normal = {n[0], n[1], n[2]};
  out.point = {centre[0], centre[1], centre[2]};
}

/// Frame of a contact; zero of a constraint that is no contact. \param centre coordinates of the first body's
/// centre of mass [m]
[[nodiscard]] inline ContactFrame frame_of_contact(const Constraint& at, const double* centre) {
  ContactFrame out;
  read_contact_frame(at, centre, out);
  return out;
}

}  // namespace carom
