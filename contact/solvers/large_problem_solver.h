#pragma once

/// \file
/// From a problem in factors to impulses that have been judged.

#include <carom/contact/solvers/contact_problem.h>
#include <carom/contact/solvers/contact_report.h>
#include <carom/contact/solvers/nonlinear_cg_solver.h>
#include <carom/contact/solvers/sweep_budget.h>

#include <span>
#include <vector>

namespace carom {

/// Judges the impulses that it is given, asks for sweeps where they are no answer, and judges again, by the
/// residual of residual.h on the problem itself.
class LargeProblemSolver {
public:
  /// Budget of an answer. Throws std::invalid_argument unless sweeps >= 0, 0 < residual and 0 <=
  /// accepted.
  void set_budget(const SweepBudget& budget);
  /// Improves impulses, and writes xi = W P + b, the modes of the groups and a report. Impulses that are an
  /// answer stay as they are.
  void solve(const ContactProblem& problem, std::span<double> impulse, std::span<double> xi,
             std::span<ContactMode> modes, ContactReport& report);
  /// The solver that is asked.
  [[nodiscard]] NonlinearCgSolver& sweeps() { return sweeps_; }

private:
  NonlinearCgSolver sweeps_;
  std::vector<double> slot_velocity_;
};

}  // namespace carom
