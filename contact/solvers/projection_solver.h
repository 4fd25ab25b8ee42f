#pragma once

/// \file
/// The solver for every set, and the last resort: group after group solved exactly with the others held.

#include <carom/contact/solvers/contact_solver.h>
#include <carom/contact/solvers/newton_polish.h>
#include <carom/contact/solvers/sweep_watch.h>
#include <carom/core/export.h>

#include <span>
#include <utility>
#include <vector>

namespace carom {

/// Most sweeps over all groups before giving up.
inline constexpr int projection_sweeps = 2000;

/// Projected Gauss-Seidel: each sweep visits the groups in order and solves each one exactly for its own
/// impulses (a planar contact by its modes, a lone row and a contact that slips in a known direction by
/// clamping, a disc by its secular equation, alternating with its normal row), the others held. After 10, 30,
/// 100, ... sweeps Newton's method on the modes reached so far tries to finish (newton_polish.h). Converges
/// for most problems met in practice, proves nothing: solved (residual below 1e-12) or not_solved, with the
/// best impulses found.
class CAROM_API ProjectionSolver final : public ContactSolver {
public:
  [[nodiscard]] std::string_view name() const override { return "projection"; }
  [[nodiscard]] SolverAnswer solve(const ContactProblem& problem, std::span<double> impulse) override;
  /// Has every sweep looked at from now on.
  void set_watch(SweepWatch watch) { watch_ = std::move(watch); }

private:
  void visit(const ContactProblem& problem, const RowGroup& group);
  void visit_planar(const ContactProblem& problem, std::size_t row);
  void visit_rows(const ContactProblem& problem, const RowGroup& group);
  void visit_leading(const ContactProblem& problem, const RowGroup& group);
  [[nodiscard]] double velocity(const ContactProblem& problem, std::size_t row) const;

  std::vector<double> impulse_, trial_;
  NewtonPolish polish_;
  SweepWatch watch_;
};

}  // namespace carom
