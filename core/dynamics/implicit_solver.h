#pragma once

/// \file
/// The matrix of a linearised step of one component,
///     A = M - (h/2) C - (h^2/4) K,   K, C the derivatives of the loads by position and velocity,
/// symmetrised: its factors guide an iteration, they do not decide where it ends. Where joints bind bodies,
/// with rows G at the end of the step and those along which they push, Gm, it is bordered by them,
///     (A - R) x - Gm^T l = f,   (G + B) x = -r,
/// with R and B by which reactions and conditions change as the rows turn, if that is asked for.

#include <carom/core/assembly.h>
#include <carom/core/dynamics/joint_constraints.h>
#include <carom/core/export.h>

#include <memory>
#include <span>
#include <vector>

namespace carom {

/// A number of a matrix.
struct MatrixNumber {
  Index row = 0, column = 0;  ///< place in the matrix
  double number = 0.0;        ///< value at that place
};

/// Factors of A. Not for use by two threads at once.
class CAROM_API ImplicitSolver {
public:
  ImplicitSolver();
  ~ImplicitSolver();
  ImplicitSolver(ImplicitSolver&&) noexcept;
  ImplicitSolver& operator=(ImplicitSolver&&) noexcept;
  ImplicitSolver(const ImplicitSolver&) = delete;
  ImplicitSolver& operator=(const ImplicitSolver&) = delete;

  /// The rows of joints at the end of the step, and those along which they push.
  struct Border {
    const JointConstraints& held;
    const JointConstraints& pushing;
    std::span<const MatrixNumber> of_reactions{};   ///< R, by velocities of the model
    std::span<const MatrixNumber> of_conditions{};  ///< B, by rows and velocities of the model
  };
  /// Result of factor().
  enum class Outcome { definite, indefinite, singular };

  /// Linearises the loads at a state and factors. The position group of `evaluation` must be up to date. A
  /// matrix A that is not definite can be solved with, but not in contact problems.
  /// \param joints of the component, both placed; null: none
  /// \param make_definite add as much of the mass matrix to A as makes it definite
  [[nodiscard]] Outcome factor(const Assembly& assembly, Index component, const StateView& state,
                               const Evaluation& evaluation, double step, const Border* joints,
                               bool make_definite = false);
  /// f becomes x over the velocities of the component, `f` beginning with the first of them.
  /// \param r of the joints; null: zero \param l out: multipliers of the joints; null: not wanted
  void solve(double* f, const double* r = nullptr, double* l = nullptr) const;
  /// y += scale K v, arrays over all velocities of the model.
  void add_stiffness_times(double scale, const double* v, double* y) const;
  /// p = M v over the component, arrays over all velocities of the model.
  void apply_mass(const double* v, double* p) const;
  /// p -= A v over the component, arrays over all velocities of the model.
  void subtract_matrix(const double* v, double* p) const;

private:
  struct Factors;
  std::unique_ptr<Factors> factors_;
};

}  // namespace carom
