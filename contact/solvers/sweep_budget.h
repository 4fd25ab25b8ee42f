#pragma once

/// \file
/// Budget of a large contact problem: its cost, and how exact its answer has to be.

namespace carom {

/// Contacts of a problem in factors up to which exact solvers are asked where sweeps do not end: W in full, a
/// few milliseconds.
inline constexpr int most_exact_contacts = 50;
/// Rows up to which W is made in full: half a gigabyte, of which solvers need several times as much.
inline constexpr int most_dense_rows = 8192;

/// Options of the sweeps over a problem in factors (nonlinear_cg_solver.h).
struct SweepBudget {
  /// Residual (residual.h) at which the sweeps end; the answer is `solved` then.
  double residual = 1e-10;
  /// Most sweeps. A settled pile needs a few in a step; a collapsing one uses all of them up, which for 2,000
  /// discs are about 3 ms.
  /// Where the residual is above `accepted` then, up to ten times as many follow until it is not.
  int sweeps = 80;
  /// Largest residual with which an answer is taken when the sweeps are used up, as `accepted_at_cap`; above
  /// it the problem is `not_solved`. 0: never.
  double accepted = 5e-3;
};

}  // namespace carom
