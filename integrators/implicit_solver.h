#pragma once

/// \file
/// The matrix of a linearised step of one island,
///     A = M - (h/2) C - (h^2/4) K,   K, C the derivatives of the loads by position and velocity,
/// symmetrised: its factors guide an iteration, they do not decide where it ends.

#include <carom/core/assembly.h>
#include <carom/core/export.h>

#include <memory>
#include <vector>

namespace carom {

/// Factors of A. Not for use by two threads at once.
class CAROM_API ImplicitSolver {
public:
  ImplicitSolver();
  ~ImplicitSolver();
  ImplicitSolver(ImplicitSolver&&) noexcept;
  ImplicitSolver& operator=(ImplicitSolver&&) noexcept;
  ImplicitSolver(const ImplicitSolver&) = delete;
  ImplicitSolver& operator=(const ImplicitSolver&) = delete;

  /// What came of factor().
  enum class Outcome { definite, indefinite, singular };

  /// Linearises the loads at a state and factors. The position group of `evaluation` must be up to date. A
  /// matrix that is not definite can be solved with, but not in contact problems.
  [[nodiscard]] Outcome factor(const Assembly& assembly, Index island, const StateView& state,
                               const Evaluation& evaluation, double step);
  /// x = A^-1 x over the velocities of the island, `x` beginning with the first of them.
  void solve(double* x) const;
  /// y += scale K v, arrays over all velocities of the model.
  void add_stiffness_times(double scale, const double* v, double* y) const;
  /// p = M v over the island, arrays over all velocities of the model.
  void apply_mass(const double* v, double* p) const;

private:
  struct Factors;
  std::unique_ptr<Factors> factors_;
};

}  // namespace carom
