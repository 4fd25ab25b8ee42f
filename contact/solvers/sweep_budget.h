#pragma once

/// \file
/// What a large contact problem may cost, and how exact its answer has to be.

namespace carom {

/// Options of the sweeps over a problem in factors (nonlinear_cg_solver.h).
struct SweepBudget {
  /// Residual (residual.h) at which the sweeps end; the answer is `solved` then.
  double residual = 1e-8;
  /// Most sweeps. A collapsing pile of 2,000 discs uses them up in every step; a settled one needs a few.
  int sweeps = 60;
  /// Largest residual with which an answer is taken when the sweeps are used up, as `accepted_at_cap`; above
  /// it the problem is `not_solved`. 0: never.
  double accepted = 5e-3;
};

}  // namespace carom
