#pragma once

/// \file
/// Rows of the constraints of an island as its contact problem has them: the sets that impulses lie in,
/// velocities before, and what of the vector b does not depend on velocities at the end.

#include <carom/contact/contact_velocity.h>
#include <carom/contact/delassus.h>
#include <carom/contact/solvers/sweep_budget.h>
#include <carom/core/constraint.h>
#include <carom/core/row_set.h>

#include <array>
#include <span>
#include <vector>

namespace carom {

/// Rows of some constraints.
struct RowCount {
  int rows = 0;
  bool fits_factors = false;  ///< W may stay in factors: of the plane, several bodies or very many contacts
};

/// Counts rows. \param first_row out, by constraint: its first one
[[nodiscard]] inline RowCount count_rows(std::span<const Constraint> constraints,
                                         std::vector<int>& first_row) {
  first_row.resize(constraints.size());
  int rows = 0;
  bool planar = true, several = false;
  for (std::size_t c = 0; c < constraints.size(); ++c) {
    const Constraint& at = constraints[c];
    first_row[c] = rows;
    rows += at.rows;
    planar = planar && at.rows <= 2 && at.attached == 0;
    several = several || at.bodies > 1 || at.body() != constraints.front().body();
  }
  // One body with a few contacts is worth an exact answer.
  return {rows, planar && (several || constraints.size() > static_cast<std::size_t>(most_exact_contacts))};
}

/// The set that impulses along a row lie in, unless its bound is given. \param bounding the normal row whose
/// impulse bounds those along tangential rows
inline void set_bounded_row(const Constraint& at, int bounding, int row, RowSet& set) {
  set = {};  // a half line
  if (row < at.normals) return;
  set.kind = at.tangents() == 1 ? SetKind::bounded_interval : SetKind::bounded_disc;
  set.bound = bounding;
  set.coefficient = at.friction;
}

/// Where the two rows of a planar contact of an island in factors stand.
struct PlanarRows {
  ImpulseDirection* directions;
  RowSet* sets;
  double *before, *restitution, *given;

  /// The rows of another planar contact, `rows` rows behind these.
  [[nodiscard]] PlanarRows behind(std::size_t rows) const {
    return {directions + rows, sets + rows, before + rows, restitution + rows, given + rows};
  }
};

/// Writes them as those of any constraint, without its cases. \param first number of the first row
inline void write_planar_contact(const Constraint& at, const double* velocity_before, int first,
                                 const PlanarRows& rows) {
  const std::array<double, 2> along = times_both_rows(at, velocity_before);
  const double e_n = at.law.normal_restitution, e_t = at.law.tangential_restitution;
  const double gamma_n = along[0] - at.surface_velocity[0], gamma_t = along[1] - at.surface_velocity[1];
  rows.directions[0] = {&at, 0};
  rows.directions[1] = {&at, 1};
  set_bounded_row(at, first, 0, rows.sets[0]);
  set_bounded_row(at, first, 1, rows.sets[1]);
  rows.before[0] = gamma_n;
  rows.before[1] = gamma_t;
  rows.restitution[0] = e_n;
  rows.restitution[1] = e_t;
  rows.given[0] = e_n * gamma_n + at.allowed_approach - at.surface_velocity_after[0];
  rows.given[1] = e_t * gamma_t - at.surface_velocity_after[1];
}

}  // namespace carom
