#pragma once

/// \file
/// From a contact problem to impulses that have been judged: solvers are tried in turn, each answer is
/// checked by the one residual (residual.h) before it is used, and what happened is reported.

#include <carom/contact/solvers/chain_statistics.h>
#include <carom/contact/solvers/contact_mode.h>
#include <carom/contact/solvers/contact_problem.h>
#include <carom/contact/solvers/contact_report.h>
#include <carom/contact/solvers/contact_solver.h>
#include <carom/contact/solvers/residual.h>
#include <carom/contact/solvers/sweep_budget.h>
#include <carom/contact/solvers/sweep_watch.h>
#include <carom/core/export.h>
#include <carom/core/owner.h>

#include <span>
#include <vector>

namespace carom {

struct ModeEquations;

/// Answer of a contact problem, and what solvers start from in the next one of the same rows.
struct ContactSolution {
  std::vector<double> impulse;     ///< P, by row [N s]
  std::vector<ContactMode> modes;  ///< by group
  ContactReport report;
  /// M^-1 H^T P, three numbers a slot, of a problem in factors whose answer is that of sweeps; else empty.
  std::vector<double> response;
  bool known = false;          ///< a start: an answer, usable or not, to a problem of the same rows
  bool changed_modes = false;  ///< the answer has other modes than what it started from
  /// In: impulses of a problem in full that are not unique are to be basic ones, as pivoting finds them:
  /// those of rows that follow from others are zero. Many contacts take several times as long then.
  bool basic = false;
};

/// Solves contact problems: one contact exactly by its modes, several by principal pivoting (Johansson 1999),
/// then Lemke, then by regular problems nearby, and up to three by enumeration of the modes when all else
/// failed; many contacts, and problems with discs, first by sweeps and Newton's method (exact_solvers.h). Of
/// several solutions of one contact the one with the smallest normal impulse; of several contacts that
/// without impulses where it is one, else it does not look for others (SolutionList does). A problem in
/// factors is left to sweeps (nonlinear_cg_solver.h): `solved` up to the residual of the budget; where they
/// do not reach it a small one is left to the exact solvers (large_problem_solver.h), and a large one is
/// accepted_at_cap or not_solved, with the modes of its answer. Deterministic; keeps nothing between calls
/// but statistics and memory. Allocates only while problems grow. Not for use by two threads at once.
class CAROM_API SolverChain {
public:
  SolverChain();
  ~SolverChain();
  SolverChain(SolverChain&&) noexcept;
  SolverChain& operator=(SolverChain&&) noexcept;
  SolverChain(const SolverChain&) = delete;
  SolverChain& operator=(const SolverChain&) = delete;

  /// Writes the impulses [N s] of `problem` (grouped; size rows()) if the report is usable(), else the best
  /// attempt (zero where it is proved that there is none). The report's residual is that of what was written.
  /// Throws std::invalid_argument when `impulse` has another size or the problem is not grouped.
  [[nodiscard]] ContactReport solve(const ContactProblem& problem, std::span<double> impulse);

  /// Solves `problem` (grouped) from the start `solution` (if `solution.known`), and replaces it by the
  /// answer with its report and modes. Throws std::invalid_argument when the problem is not grouped. Several
  /// contacts keep to the modes of the start as long as they are those of a solution, and solvers are spared;
  /// one contact is asked for its solution first, which costs less. Only solvers can tell that there are
  /// several solutions; the report keeps to their word. Without a solution before, several contacts start
  /// from `solution.impulse` all the same: where that is an answer to rounding (certified_start) no solver is
  /// asked, and sweeps over a problem in factors start from it. \param solution `impulse` sized rows()
  /// \param equations those of the modes of the start, of a problem in factors as it was before, which are
  /// tried first (newton_polish.h); out: those that solved the problem, if any did. Null: none
  void solve(const ContactProblem& problem, ContactSolution& solution, ModeEquations* equations = nullptr);

  /// Solves `problem` by one solver alone and writes `impulse` [N s], polished and judged as in the chain. A
  /// solver that is not made for the problem answers not_solved ("not applicable") with zero impulses. The
  /// statistics are left alone.
  [[nodiscard]] ContactReport solve_with(SolverId solver, const ContactProblem& problem,
                                         std::span<double> impulse);

  /// Sets the budget of problems in factors. Throws std::invalid_argument unless sweeps >= 0, 0 < residual
  /// and 0 <= accepted.
  void set_budget(const SweepBudget& budget);

  /// Has every sweep of `dense_sweeps` and `nonlinear_cg` looked at from now on; empty: no more.
  void set_watch(const SweepWatch& watch);

  /// xi = W P + b of the last answer; gamma^+ = xi - E gamma^-. Valid until the next solve.
  [[nodiscard]] std::span<const double> velocities() const;

  /// Mode of each group of the last answer, by the rule of contact_mode.h. Valid until the next solve.
  [[nodiscard]] std::span<const ContactMode> modes() const;

  /// Counts since construction or reset. Valid until the next call of the chain.
  [[nodiscard]] const ChainStatistics& statistics() const;

  /// Adds the counts to `sum`, and sets them to zero.
  void take_statistics(ChainStatistics& sum);

  /// Sets all counts to zero.
  void reset_statistics();

private:
  void solve(const ContactProblem& problem, std::span<double> impulse, ContactReport& report, bool basic);

  struct Workspace;
  Owner<Workspace> work_;
};

}  // namespace carom
