#pragma once

/// \file
/// How fast does a solver come to its answer? The residual (residual.h) after every sweep, so that solvers,
/// other programs' too, can be compared on the same problem.

#include <carom/contact/solvers/chain_statistics.h>
#include <carom/contact/solvers/contact_problem.h>
#include <carom/contact/solvers/contact_solver.h>
#include <carom/contact/solvers/sweep_budget.h>
#include <carom/core/export.h>

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace carom {

/// State of a solver after some of its work.
struct HistoryPoint {
  int iterations = 0;     ///< sweeps, pivots
  double seconds = 0.0;   ///< that the solver took so far, without those of the residual [s]
  double residual = 0.0;  ///< of the impulses at hand; dimensionless
};

/// The residuals of one solver on one problem, from no impulses on.
struct ResidualHistory {
  std::string_view solver{};  ///< name
  Outcome outcome = Outcome::not_solved;
  std::vector<HistoryPoint> sweeps{};  ///< after each sweep; empty for solvers that do not sweep
  HistoryPoint answer{};               ///< polished and judged, as SolverChain::solve_with() gives it
};

/// Solves a grouped problem by one solver and looks at it after every sweep: of `dense_sweeps` and
/// `nonlinear_cg`; others have an answer only. \param budget of `nonlinear_cg`. Throws std::invalid_argument
/// for a budget that cannot be, as SolverChain::set_budget().
[[nodiscard]] CAROM_API ResidualHistory residual_history(const ContactProblem& problem, SolverId solver,
                                                         const SweepBudget& budget = {});

/// Writes histories as a table of comma-separated values: solver, kind (`sweep`, `answer`), outcome (of an
/// answer), iterations, seconds, residual; numbers with all digits. Throws FileError.
CAROM_API void write_histories(const std::string& path, std::span<const ResidualHistory> histories);

}  // namespace carom
