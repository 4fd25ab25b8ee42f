#pragma once

/// \file
/// The pivoting methods as contact solvers.

#include <carom/contact/solvers/contact_solver.h>
#include <carom/contact/solvers/lcp_forms.h>
#include <carom/core/export.h>
#include <carom/core/numerics/lcp.h>
#include <carom/core/numerics/lemke.h>
#include <carom/core/numerics/principal_pivoting.h>

#include <span>
#include <vector>

namespace carom {

/// The paper's way: its form of the LCP and its scan (Johansson 1999, section 3). Not applicable where the
/// tangential block of W is singular, and for discs. Contacts that slip in a known direction (proportional
/// rows) can spoil the P-matrix: it then may end at the bound on pivots.
class CAROM_API PrincipalPivotingSolver final : public ContactSolver {
public:
  [[nodiscard]] std::string_view name() const override { return "principal pivoting"; }
  [[nodiscard]] SolverAnswer solve(const ContactProblem& problem, std::span<double> impulse) override;

private:
  PaperForm form_;
  PrincipalPivoting method_;
  Lcp lcp_;
  std::vector<double> z_;
};

/// Lemke's method on the copositive form. Not applicable for discs. Ends at a ray only where contacts jam
/// with unequal restitution or surfaces that move, or with contacts that slip in a known direction
/// (proportional rows: the matrix need not be copositive; docs/method.md section 3); without friction a ray
/// proves that there is no solution, since W is then copositive-plus.
class CAROM_API LemkeSolver final : public ContactSolver {
public:
  [[nodiscard]] std::string_view name() const override { return "Lemke"; }
  [[nodiscard]] SolverAnswer solve(const ContactProblem& problem, std::span<double> impulse) override;

private:
  CopositiveForm form_;
  Lemke method_;
  Lcp lcp_;
  std::vector<double> z_;
};

}  // namespace carom
