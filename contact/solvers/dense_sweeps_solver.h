#pragma once

/// \file
/// The solver of dense problems with discs (friction in space) or of many rows: group after group solved
/// exactly with the others held, then Newton's method on the modes.

#include <carom/contact/solvers/contact_solver.h>
#include <carom/contact/solvers/newton_polish.h>
#include <carom/contact/solvers/sweep_watch.h>
#include <carom/core/export.h>

#include <span>
#include <utility>
#include <vector>

namespace carom {

/// Most sweeps over all groups of a problem with discs before giving up.
inline constexpr int most_dense_sweeps = 2000;

/// Most sweeps over all groups of a problem without discs, which pivoting solves too.
inline constexpr int most_planar_sweeps = 90;

/// Rows from which on a problem without discs is swept: pivoting is faster up to here. Eight contacts of the
/// plane.
inline constexpr int swept_rows = 16;

/// Projected Gauss-Seidel for problems of several groups with a disc among their sets, which no pivoting
/// method takes, or with swept_rows rows; else not_solved ("not applicable"). Each sweep visits the groups in
/// order and solves each one for its own impulses (a lone row and a contact that slips in a known direction
/// by clamping, a disc by its secular equation, alternating with its normal row), the others held. After 10,
/// 30, 100, ... sweeps Newton's method on the modes reached so far tries to finish (newton_polish.h).
/// Converges for most problems met in practice, proves nothing: solved (residual below 1e-12, without discs
/// below certified_start) or not_solved,
/// with the best impulses found.
class CAROM_API DenseSweepsSolver final : public ContactSolver {
public:
  [[nodiscard]] std::string_view name() const override { return "dense sweeps"; }
  [[nodiscard]] SolverAnswer solve(const ContactProblem& problem, std::span<double> impulse) override;
  /// Has every sweep looked at from now on.
  void set_watch(SweepWatch watch) { watch_ = std::move(watch); }

private:
  void visit(const ContactProblem& problem, const RowGroup& group);
  void visit_leading(const ContactProblem& problem, const RowGroup& group);
  [[nodiscard]] double velocity(const ContactProblem& problem, std::size_t row) const;

  std::vector<double> impulse_, trial_;
  NewtonPolish polish_;
  SweepWatch watch_;
};

}  // namespace carom
