#pragma once

/// \file
/// Interface of contact solvers, and their answers.

#include <carom/contact/solvers/contact_problem.h>
#include <carom/core/constraint.h>
#include <carom/core/export.h>

#include <cstdint>
#include <span>
#include <string_view>

namespace carom {

/// Knowledge of the solutions of a contact problem. Solutions are counted in (P, gamma^+): several P
/// with one gamma^+ are `forces_not_unique`, not `several_solutions`.
enum class Outcome : std::uint8_t {
  solved,             ///< a solution; nothing says that there are others
  several_solutions,  ///< a solution; others with another end velocity exist
  forces_not_unique,  ///< a solution; other impulses give the same end velocities
  no_solution,        ///< proved: there is none
  not_solved,         ///< this solver found none: not applicable, pivot bound, vanishing pivot, ray
  accepted_at_cap     ///< nearly a solution, taken at the end of a budget (sweep_budget.h); see the residual
};

/// Name of an outcome, as used in reports.
[[nodiscard]] CAROM_API std::string_view to_string(Outcome outcome);

/// Answer of a solver.
struct SolverAnswer {
  Outcome outcome = Outcome::not_solved;
  bool degenerate = false;    ///< a margin of the chosen mode is below the solver's threshold
  int iterations = 0;         ///< pivots or sweeps
  std::string_view reason{};  ///< static text: why not solved
};

/// A solver of contact problems. Solvers own reusable workspaces and keep nothing between calls that could
/// change an answer.
class CAROM_API ContactSolver {
public:
  virtual ~ContactSolver() = default;

  /// Name used in reports.
  [[nodiscard]] virtual std::string_view name() const = 0;

  /// Writes the impulses of `problem` (size rows()). They are meaningful unless the outcome is no_solution
  /// or not_solved. The answer is not yet judged: see residual.h.
  [[nodiscard]] virtual SolverAnswer solve(const ContactProblem& problem, std::span<double> impulse) = 0;
};

}  // namespace carom
