#pragma once

/// \file
/// Factors of G M^-1 G^T of the joints of one component, and which of its rows follow from others.
///
/// That some rows follow from others is a fact of their geometry, of G alone. The pivots of G M^-1 G^T show
/// it as long as the masses are of one size: a row that differs from others only in what it demands of a
/// heavy body has a pivot as small as the ratio of the masses. Where a pivot is small and masses are uneven,
/// rows are judged by G D G^T, in which all bodies weigh the same, and those of G M^-1 G^T that are
/// independent are all kept.

#include <carom/core/dynamics/joint_pattern.h>
#include <carom/core/export.h>
#include <carom/core/numerics/sparse_factors.h>

#include <span>
#include <vector>

namespace carom {

/// The factors of one component. Copies share the pattern.
class CAROM_API JointFactors {
public:
  /// The factors of G M^-1 G^T, for the analysis of the pattern.
  [[nodiscard]] SparseFactors& by_masses() { return by_masses_; }
  [[nodiscard]] const SparseFactors& by_masses() const { return by_masses_; }
  /// SparseFactors::reveal_rank().
  void reveal_rank(bool reveals) { by_masses_.reveal_rank(reveals); }

  /// Factorises. \param jacobian the numbers of G \param inverse_mass over the velocities of the component,
  /// which begin with `v`
  void factor(const JointPattern& pattern, const double* jacobian, std::span<const double> inverse_mass,
              Index v);
  /// x becomes a solution of G M^-1 G^T x = x, zero in rows that follow from others.
  void solve(double* x) { by_masses_.solve(x); }
  /// True if masses are uneven and a pivot is small: rows are judged by G D G^T.
  [[nodiscard]] bool is_uneven() const { return uneven_; }
  /// True if they are so uneven that solve(), inexact by rounding times their ratio, is to be repeated.
  [[nodiscard]] bool is_inexact() const { return inexact_; }
  /// Where masses are uneven, x becomes a solution of G D G^T x = x, and D is alike(), over the velocities of
  /// the component.
  void solve_alike(double* x) { by_geometry_.front().solve(x); }
  [[nodiscard]] const std::vector<double>& alike() const { return alike_; }
  /// Pivot of a row against its diagonal, below dependent_pivot where it follows from others. Where masses
  /// are uneven it is that of G D G^T.
  [[nodiscard]] double pivot(std::size_t row) const {
    return uneven_ ? by_geometry_.front().pivot(row) : by_masses_.pivot(row);
  }
  /// SparseFactors::dependence(): the combination of rows that vanishes.
  void dependence(std::span<const double> shares, std::vector<double>& out) {
    (uneven_ ? by_geometry_.front() : by_masses_).dependence(shares, out);
  }
  /// The combination of rows that vanishes, with 1 at a row that was left out and 0 at the others.
  void dependence(std::size_t row, std::vector<double>& out) {
    (uneven_ ? by_geometry_.front() : by_masses_).dependence(row, out);
  }

private:
  [[nodiscard]] bool has_small_pivot() const;
  [[nodiscard]] double weigh_alike(const JointPattern& pattern, const double* jacobian,
                                   std::span<const double> inverse_mass, Index v);
  void find_squared_lengths(const JointPattern& pattern, const double* jacobian,
                            std::span<const double> inverse_mass, Index v);

  SparseFactors by_masses_;
  bool uneven_ = false, inexact_ = false;
  std::vector<SparseFactors> by_geometry_;  // none until masses are uneven, then one
  std::vector<double> alike_;               // D, over the velocities of the component
  std::vector<char> left_out_;              // by row
};

}  // namespace carom
