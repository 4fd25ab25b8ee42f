#pragma once

/// \file
/// Velocities along the rows of a contact in the plane, both at once.

#include <carom/core/constraint.h>

#include <array>
#include <cmath>

namespace carom {

/// Constraint::times() of row 0 and row 1. Apart, so that the usual cases are short where they are asked for.
[[gnu::noinline]] inline std::array<double, 2> times_row_by_row(const Constraint& at, const double* numbers) {
  return {at.times(0, numbers), at.times(1, numbers)};
}

/// Rows of a planar contact times numbers of its bodies, as Constraint::times() of row 0 and row 1, with the
/// same bits; of bodies that turn without loops: of one on ground, and of two, which is the usual case in a
/// pile.
/// \param at a constraint of two rows \param numbers an array over all velocities
[[nodiscard]] inline std::array<double, 2> times_both_rows(const Constraint& at, const double* numbers) {
  constexpr int of_planar_body = 3;
  if (at.bodies == 1 && at.blocks[0].columns == of_planar_body) {
    const double *const v = numbers + at.blocks[0].v, *const n = at.row(0);
    const double* const t = n + of_planar_body;
    return {0.0 + n[0] * v[0] + n[1] * v[1] + n[2] * v[2], 0.0 + t[0] * v[0] + t[1] * v[1] + t[2] * v[2]};
  }
  if (at.bodies != 2 || at.blocks[0].columns != of_planar_body || at.blocks[1].columns != of_planar_body) {
    return times_row_by_row(at, numbers);
  }
  const double *const a = numbers + at.blocks[0].v, *const b = numbers + at.blocks[1].v;
  const double *const n = at.row(0), *const t = n + 2 * of_planar_body;
  return {n[0] * a[0] + n[1] * a[1] + n[2] * a[2] + n[3] * b[0] + n[4] * b[1] + n[5] * b[2],
          t[0] * a[0] + t[1] * a[1] + t[2] * a[2] + t[3] * b[0] + t[4] * b[1] + t[5] * b[2]};
}

/// Constraint::velocity_after() of all rows [m/s]; numbers beyond the rows are 0. \param after velocities of
/// all bodies
[[nodiscard]] inline std::array<double, 3> velocities_after(const Constraint& at, const double* after) {
  if (at.rows == 2) {
    const std::array<double, 2> both = times_both_rows(at, after);
    return {both[0] - at.surface_velocity_after[0], both[1] - at.surface_velocity_after[1], 0.0};
  }
  std::array<double, 3> all{};
  for (int row = 0; row < at.rows; ++row) {
    all[static_cast<std::size_t>(row)] = at.velocity_after(row, after);
  }
  return all;
}

/// Constraint::speed() of row 0 and row 1 [m/s]. \param velocities of all bodies
[[nodiscard]] inline std::array<double, 2> speeds_of_both_rows(const Constraint& at,
                                                               const double* velocities) {
  constexpr int of_planar_body = 3;
  if (at.bodies != 2 || at.blocks[0].columns != of_planar_body || at.blocks[1].columns != of_planar_body) {
    return {at.speed(0, velocities), at.speed(1, velocities)};
  }
  const double *const a = velocities + at.blocks[0].v, *const b = velocities + at.blocks[1].v;
  std::array<double, 2> sum{std::abs(at.surface_velocity[0]), std::abs(at.surface_velocity[1])};
  const double* h = at.row(0);
  for (double& row : sum) {
    for (int k = 0; k < of_planar_body; ++k) row += std::abs(*h++ * a[k]);
    for (int k = 0; k < of_planar_body; ++k) row += std::abs(*h++ * b[k]);
  }
  return sum;
}

/// Constraint::speed() of the rows of a constraint. \param velocities of all bodies
[[nodiscard]] inline std::array<double, 3> speeds_of_rows(const Constraint& at, const double* velocities) {
  if (at.rows == 2) {
    const std::array<double, 2> both = speeds_of_both_rows(at, velocities);
    return {both[0], both[1], 0.0};
  }
  std::array<double, 3> all{};
  for (int row = 0; row < at.rows; ++row) all[static_cast<std::size_t>(row)] = at.speed(row, velocities);
  return all;
}

}  // namespace carom
