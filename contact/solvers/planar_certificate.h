#pragma once

/// \file
/// The certificate and the mode rule for one planar contact, unrolled: the same formulas as residual.h and
/// contact_mode.h, which call this, at the cost of two divisions.

#include <carom/contact/solvers/contact_mode.h>
#include <carom/contact/solvers/contact_solver.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace carom {

/// Numbers below this have fewer digits than others: a residual is no part of them.
inline constexpr double least_scale =
    std::numeric_limits<double>::min() / std::numeric_limits<double>::epsilon();

/// True if a group is a contact in the plane with friction: in large problems nearly all are.
[[nodiscard]] inline bool is_planar_contact(std::span<const RowSet> sets, const RowGroup& group) {
  const RowSet* const set = sets.data() + group.first;
  return group.size == 2 && set[0].kind == SetKind::half_line && set[1].kind == SetKind::bounded_interval;
}

/// Modes of all groups (contact_mode.h). \param modes out, by group
void contact_modes(const ContactProblem& problem, std::span<const double> impulse, std::span<const double> xi,
                   std::span<ContactMode> modes);

/// Larger of two magnitudes; a NaN counts as infinite, so that it cannot hide in a maximum.
[[nodiscard]] inline double larger_magnitude(double most, double value) {
  const double magnitude = std::abs(value);
  if (magnitude <= most) return most;
  return std::isnan(magnitude) ? std::numeric_limits<double>::infinity() : magnitude;
}

/// Largest trace of W over the rows of a group [1/kg, ...]; infinity where one is no number. Of a problem in
/// factors it is known.
[[nodiscard]] double largest_trace(const ContactProblem& problem);

/// One planar contact with an answer: trace of W [1/kg], b [m/s], coefficient of friction, impulses [N s] and
/// scaled mean velocities [m/s]; rows normal, tangential.
struct PlanarAnswer {
  double trace = 0.0;
  double b_n = 0.0, b_t = 0.0;
  double friction = 0.0;
  double p_n = 0.0, p_t = 0.0;
  double xi_n = 0.0, xi_t = 0.0;
};

/// Relative residual of a problem that consists of this contact (residual.h).
[[nodiscard]] inline double planar_residual(const PlanarAnswer& a) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const double rho = a.trace > 0.0 ? 1.0 / a.trace : 1.0;
  const double limit = a.friction * std::max(a.p_n, 0.0);
  const double moved_n = a.p_n - rho * a.xi_n, moved_t = a.p_t - rho * a.xi_t;
  const double error_n = std::abs(a.p_n - std::max(moved_n, 0.0));
  const double error_t = std::abs(a.p_t - std::min(std::max(moved_t, -limit), limit));
  const double scale =
      std::max(std::max(std::abs(a.p_n), std::abs(a.p_t)), rho * std::max(std::abs(a.b_n), std::abs(a.b_t)));
  // Sums carry a NaN along where maxima may drop it.
  if (!(error_n + error_t + a.p_n + a.p_t + a.b_n + a.b_t < infinity) || !(scale < infinity)) return infinity;
  // W P and b cancel in xi. Of impulses beyond this nothing of b is left but a few digits: where joints let a
  // body go along one line, W has a trifle of rounding across it, which would answer anything.
  constexpr double few_digits = 1e4 * std::numeric_limits<double>::epsilon();
  if (few_digits * scale > rho * std::max(std::abs(a.b_n), std::abs(a.b_t))) return infinity;
  const double error = std::max(error_n, error_t);
  return error > 0.0 ? error / std::max(scale, least_scale) : 0.0;
}

/// Mode of the contact (contact_mode.h).
[[nodiscard]] inline ContactMode planar_mode(const PlanarAnswer& a) {
  const double largest_b = std::max(std::abs(a.b_n), std::abs(a.b_t));
  const double largest_p = std::max(std::abs(a.p_n), std::abs(a.p_t));
  // P_n <= threshold * max(|P|, |b| / trace), without the division.
  if (a.p_n <= mode_threshold * largest_p || a.p_n * a.trace <= mode_threshold * largest_b) {
    return ContactMode::open;
  }
  const double velocity_scale = std::max(std::max(std::abs(a.xi_n), std::abs(a.xi_t)), largest_b);
  if (std::abs(a.xi_t) <= mode_threshold * velocity_scale ||
      std::abs(a.p_t) < (1.0 - mode_threshold) * a.friction * a.p_n) {
    return ContactMode::stick;
  }
  return a.xi_t > 0.0 ? ContactMode::slip_positive : ContactMode::slip_negative;
}

}  // namespace carom
