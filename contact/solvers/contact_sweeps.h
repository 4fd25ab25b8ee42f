#pragma once

/// \file
/// Sweeps over a large contact problem: every contact in turn solved exactly for its own impulses with the
/// others held (projected Gauss-Seidel), the velocities of the bodies kept up to date, and steps along a
/// direction.

#include <carom/contact/solvers/contact_problem.h>
#include <carom/contact/solvers/sweep_packs.h>

#include <span>
#include <vector>

namespace carom {

/// Change g of all impulses in a sweep.
struct ImpulseChange {
  double square = 0.0;   ///< |g|^2 [N^2 s^2]
  double largest = 0.0;  ///< |g|_inf [N s]
};

/// One problem with its impulses P and velocities u = M^-1 H^T P. Reuse it: its memory is kept.
class ContactSweeps {
public:
  /// Takes a problem in factors and impulses to start from.
  void begin(const ContactProblem& problem, std::span<const double> impulse);
  /// Solves all contacts one after the other. P is in its sets afterwards.
  [[nodiscard]] ImpulseChange sweep();
  /// d = g, the direction that the next steps begin with.
  void restart();
  /// P += beta d and u with it, d = beta d + g: the step of nonlinear conjugate gradients.
  void step(double beta);
  /// Residual (residual.h) of the impulses at hand, from velocities that are made anew from them, so that the
  /// rounding of the sweeps does not add up; infinity where a number is not finite.
  [[nodiscard]] double judge();
  /// Scale P* of the residual last asked for [N s].
  [[nodiscard]] double scale() const { return scale_; }
  /// Writes the impulses, by row of the problem given to begin().
  void write(const ContactProblem& problem, std::span<double> impulse) const {
    packs_.write(problem, impulse);
  }

private:
  void make_velocities();

  SweepPacks packs_;
  std::vector<SlotVelocity> velocity_, before_, direction_;  // u, u before the sweep, M^-1 H^T d
  double scale_ = 0.0;
  bool made_anew_ = false;  // velocities are those of the impulses, without rounding of sweeps
};

}  // namespace carom
