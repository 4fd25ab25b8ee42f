#pragma once

/// \file
/// The solver for large problems: nonlinear conjugate gradients over projected Gauss-Seidel sweeps (NNCG:
/// M. Silcowitz, S. Niebe, K. Erleben, A nonsmooth nonlinear conjugate gradient method for interactive
/// contact force problems, The Visual Computer 26 (2010) 893), each contact solved on the true law of
/// docs/method.md, section 3.

#include <carom/contact/solvers/contact_solver.h>
#include <carom/contact/solvers/contact_sweeps.h>
#include <carom/contact/solvers/sweep_budget.h>
#include <carom/contact/solvers/sweep_watch.h>
#include <carom/core/export.h>

#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace carom {

/// Sweeps, with g the change of the impulses in a sweep and beta = |g|^2 / |g before|^2: where beta <= 1,
///     P <- P + beta d,   d <- beta d + g
/// without projection, as the next sweep brings P back into its sets; where beta > 1, and at the start, d =
/// g. The residual is looked at right after a sweep, when g has become as small as the residual asked for,
/// every few sweeps, and at the end of the budget; of the impulses that were looked at the best are the
/// answer. Problems in factors only, else not_solved ("not applicable"). Deterministic; allocates only while
/// problems grow.
class CAROM_API NonlinearCgSolver final : public ContactSolver {
public:
  [[nodiscard]] std::string_view name() const override { return "nonlinear CG"; }
  /// Starts from nothing.
  [[nodiscard]] SolverAnswer solve(const ContactProblem& problem, std::span<double> impulse) override;
  /// Starts from the impulses given, which may be outside their sets.
  [[nodiscard]] SolverAnswer improve(const ContactProblem& problem, std::span<double> impulse);

  /// Budget of an answer.
  [[nodiscard]] const SweepBudget& budget() const { return budget_; }
  void set_budget(const SweepBudget& budget) { budget_ = budget; }
  /// Has every sweep looked at from now on.
  void set_watch(SweepWatch watch) { watch_ = std::move(watch); }

private:
  SweepBudget budget_;
  ContactSweeps sweeps_;
  SweepWatch watch_;
  std::vector<double> watched_;
};

}  // namespace carom
