#pragma once

/// \file
/// From a contact problem to impulses that have been judged: solvers are tried in turn, each answer is
/// checked by the one residual (residual.h) before it is used, and what happened is reported.

#include <carom/contact/solvers/chain_statistics.h>
#include <carom/contact/solvers/contact_mode.h>
#include <carom/contact/solvers/contact_problem.h>
#include <carom/contact/solvers/contact_solver.h>
#include <carom/contact/solvers/residual.h>
#include <carom/core/export.h>

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

namespace carom {

/// An answer with a residual up to this is taken at once. Direct solvers reach 1e-15 to 1e-13; the rest is
/// room for problems of condition 1e3 more.
inline constexpr double accepted_residual = 1e-12;

/// When no solver came below accepted_residual, the best answer is taken if its residual is up to this.
/// The iterative last resort stops there; 1e-10 of the impulse scale is still far below any step's error.
inline constexpr double tolerated_residual = 1e-10;

/// Report on one contact problem, solved or not.
struct ContactReport {
  Outcome outcome = Outcome::not_solved;
  bool degenerate = false;  ///< the answer stands at a boundary between modes
  double residual = std::numeric_limits<double>::infinity();  ///< relative, of the impulses (residual.h)
  int worst_group = -1;                                       ///< group where the residual is taken
  int iterations = 0;                                         ///< pivots and sweeps of all solvers tried
  std::uint8_t tried = 0;                                     ///< bit i: SolverId i was tried
  std::string_view solver{};  ///< whose answer or proof it is; empty only for a problem without rows
  std::string_view reason{};  ///< static text: why not solved

  /// Whether the impulses may be used: every outcome but no_solution and not_solved.
  [[nodiscard]] bool usable() const {
    return outcome != Outcome::no_solution && outcome != Outcome::not_solved;
  }
  /// Whether a solver was tried.
  [[nodiscard]] bool was_tried(SolverId id) const { return (tried >> static_cast<unsigned>(id) & 1u) != 0; }
};

/// Answer of a contact problem, and what solvers start from in the next one of the same rows.
struct ContactSolution {
  std::vector<double> impulse;     ///< P, by row [N s]
  std::vector<ContactMode> modes;  ///< by group
  ContactReport report;
  bool known = false;          ///< a start: an answer, usable or not, to a problem of the same rows
  bool changed_modes = false;  ///< the answer has other modes than what it started from
};

/// Solves contact problems: one contact exactly by its modes, then Lemke, then projection; several contacts
/// by principal pivoting (Johansson 1999), then Lemke, then projection, and up to three by enumeration of
/// the modes when all else failed. Of several solutions of one contact the one with the smallest normal
/// impulse; for several contacts it does not look for others (SolutionList does). Deterministic; keeps
/// nothing between calls but statistics and memory. Allocates only while problems grow. Not for use by two
/// threads at once.
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

  /// Likewise from a start (if `solution.known`), which it replaces. Several contacts keep to the modes of
  /// the start as long as they are those of a solution, and solvers are spared; one contact is asked for its
  /// solution first, which costs less. Only solvers can tell that there are several solutions; the report
  /// keeps to their word. \param solution `impulse` sized rows()
  void solve(const ContactProblem& problem, ContactSolution& solution);

  /// The same by one solver alone, polished and judged as in the chain. A solver that is not made for the
  /// problem answers not_solved ("not applicable") with zero impulses. The statistics are left alone.
  [[nodiscard]] ContactReport solve_with(SolverId solver, const ContactProblem& problem,
                                         std::span<double> impulse);

  /// xi = W P + b of the last answer; gamma^+ = xi - E gamma^-. Valid until the next solve.
  [[nodiscard]] std::span<const double> velocities() const;

  /// Mode of each group of the last answer, by the rule of contact_mode.h. Valid until the next solve.
  [[nodiscard]] std::span<const ContactMode> modes() const;

  /// Counts since construction or reset.
  [[nodiscard]] const ChainStatistics& statistics() const;

  /// Sets all counts to zero.
  void reset_statistics();

private:
  void solve(const ContactProblem& problem, std::span<double> impulse, ContactReport& report);

  struct Workspace;
  std::unique_ptr<Workspace> work_;
};

}  // namespace carom
