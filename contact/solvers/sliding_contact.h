#pragma once

/// \file
/// One planar contact that slips in a known direction, in closed form: the acceleration level of a sliding
/// contact, with Painlevé's cases (docs/method.md, section 3).

#include <carom/contact/solvers/single_contact.h>
#include <carom/core/export.h>

namespace carom {

/// One contact with P_t = coefficient * P_n: W [1/kg], b [m/s] (or [m/s^2], for forces in place of impulses).
struct SlidingContact {
  double w_nn = 0.0;
  double w_nt = 0.0;
  double w_tt = 0.0;
  double b_n = 0.0;
  double b_t = 0.0;
  double coefficient = 0.0;  ///< -s mu, s = +-1 the direction of slip
};

/// Lists all solutions of  0 <= P_n  _|_  p P_n + b_n >= 0  with p = W_nn + coefficient * W_nt:
///
///            b_n > 0                          b_n = 0                b_n < 0
///     p > 0  open                             open                   slides, P_n = -b_n / p
///     p = 0  open                             any P_n >= 0           no solution
///     p < 0  open, and slides, P_n = -b_n/p   open                   no solution
///
/// Two solutions are `several_solutions`, the open one first. Any P_n is `several_solutions` too, and
/// `forces_not_unique` where it does not change xi_t; P = 0 stands for all of them. Modes: open,
/// sliding_mode().
///
/// Margins, relative: b_n to max(|b_n|, |b_t|), whose rounding it carries; p to W_nn + |coefficient W_nt|.
/// `degenerate` where one of them is below degenerate_margin: rounding may have decided.
[[nodiscard]] CAROM_API PlanarSolutions solve_sliding_contact(const SlidingContact& contact);

}  // namespace carom
