#pragma once

/// \file
/// From a nearly right answer to one right to rounding: the equations of the modes it stands in, solved.

#include <carom/contact/solvers/contact_problem.h>
#include <carom/contact/solvers/residual.h>
#include <carom/core/export.h>
#include <carom/core/numerics/rank_revealing_qr.h>

#include <span>
#include <vector>

namespace carom {

/// Newton's method on the natural map F(P) = P - proj_C(P - rho xi) of the certificate (residual.h). Each
/// row's linear piece is its present mode (zero, at a bound, free; a sliding disc has a curved one), so that
/// one step solves the system of the modes and further steps change modes. Singular systems (forces not
/// unique) get a basic correction, which keeps the answer near the given one.
class CAROM_API NewtonPolish {
public:
  /// A residual at rounding: further steps only move noise.
  static constexpr double round_off = 1e-16;

  /// Improves `impulse` [N s] by at most `most_steps` steps, fewer where several in a row do not halve the
  /// residual; keeps the best point met, never a worse one.
  /// Returns its residual. `problem` is grouped, `impulse` has size rows().
  Residual improve(const ContactProblem& problem, std::span<double> impulse, int most_steps);

private:
  void linearise(const ContactProblem& problem);
  void linearise_disc(const ContactProblem& problem, std::size_t row, double rho);
  void set_row(const ContactProblem& problem, std::size_t row, double own, double of_xi, double rho);
  void restore_sets(const ContactProblem& problem);
  Residual judge(const ContactProblem& problem, std::span<const double> impulse);

  std::vector<double> trial_, best_, xi_, jacobian_, map_, step_;
  RankRevealingQr qr_;
};

}  // namespace carom
