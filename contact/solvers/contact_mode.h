#pragma once

/// \file
/// Which mode is a contact in: open, stick or slip? Read off a solution (P, xi) by one documented rule, the
/// same for every solver.

#include <carom/contact/solvers/contact_problem.h>
#include <carom/contact/solvers/contact_solver.h>
#include <carom/core/export.h>

#include <cmath>
#include <span>

namespace carom {

/// A quantity this small against its scale counts as zero when the mode of a contact is read off.
inline constexpr double mode_threshold = 1e-11;

/// Mode of one group, from impulses `impulse` [N s] and scaled mean velocities `xi` [m/s] (both rows() long).
///
/// With W_ii the group's block of W, P* = max(|P|, |b| / trace W_ii) and V* = max(|xi|, |b|) of the group:
///  - `open`  where P_n <= mode_threshold * P*, or no impulse acts;
///  - `slip±` (planar) where |xi_t| > mode_threshold * V* and |P_t| >= (1 - mode_threshold) mu P_n, by the
///    sign of xi_t; `slip` for a disc by the same rule with norms;
///  - `stick` otherwise.
/// A contact with a proportional row slips where P_n > 0, in the direction s of coefficient = -s mu.
/// A lone row (stop, torque limit) is `open` without impulse and `stick` with one: it has no direction to
/// slip in. A fixed interval at a bound slips, by the sign of xi. Only the first friction set counts.
[[nodiscard]] CAROM_API ContactMode contact_mode(const ContactProblem& problem, const RowGroup& group,
                                                 std::span<const double> impulse, std::span<const double> xi);

/// Direction of slip of a contact whose tangential row is proportional, P_t = coefficient * P_n with
/// coefficient = -s mu: `slip_positive` for s = 1. Without friction the sign of the zero tells.
[[nodiscard]] inline ContactMode sliding_mode(double coefficient) {
  return std::signbit(coefficient) ? ContactMode::slip_positive : ContactMode::slip_negative;
}

/// A row this near (relative to P*) to the boundary between two modes makes an answer degenerate.
inline constexpr double boundary_threshold = 1e-10;

/// Whether an answer stands at a boundary between modes: with P' = P - rho xi as in residual.h, some row has
/// P' within boundary_threshold * P* of the bound of its set (a friction row only while its normal row
/// carries an impulse; a proportional row never), P* and rho those of its group.
[[nodiscard]] CAROM_API bool at_mode_boundary(const ContactProblem& problem, std::span<const double> impulse,
                                              std::span<const double> xi);

}  // namespace carom
