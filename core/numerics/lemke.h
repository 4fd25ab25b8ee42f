#pragma once

/// \file
/// Lemke's method for any linear complementarity problem.

#include <carom/core/export.h>
#include <carom/core/numerics/lcp.h>
#include <carom/core/numerics/rank_revealing_qr.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace carom {

/// A pivot is taken only from entries above this part of the largest entry of the entering column: what is
/// smaller is the rounding left by entries that cancelled.
inline constexpr double lemke_pivot_threshold = 1e-10;

/// Basic variables that reach zero within this part of the largest basic value (at least max |q|) tie; the
/// lexicographic rule decides among them.
inline constexpr double lemke_tie_threshold = 1e-12;

/// Complementary pivoting after Lemke with the lexicographic rule (Cottle, Pang, Stone, The Linear
/// Complementarity Problem, 1992, algorithms 4.4.1 and 4.4.9; covering vector of ones), on the problem with
/// rows and columns scaled by powers of two.
///
/// The solution is not read from the tableau but solved anew from the final basis and refined, so that it is
/// as good as the basis; so is the ray at which a path ends. Where the tableau has lost its digits, or has
/// pivoted on rounding, the answer is inaccurate, and another problem nearby loses fewer (exact_solvers.h).
/// Finite for exact arithmetic, though some problems take 2^n pivots; contact problems take about n. Keeps
/// its memory between calls.
class CAROM_API Lemke {
public:
  /// Writes z (size n). Statuses: solved (lcp_residual below lcp_accuracy), secondary_ray (one of the problem
  /// to the last digits), pivot_bound, inaccurate; z is the last point reached where it is not solved. The
  /// path ends after `most_pivots` pivots (0: 100 + 30 n).
  [[nodiscard]] LcpAnswer solve(const Lcp& problem, std::span<double> z, int most_pivots = 0);

private:
  LcpStatus follow_path(int most_pivots, int& pivots);
  void start();
  void scale(const Lcp& problem);
  void pivot(std::size_t row, std::size_t column);
  void write_column(std::size_t variable, std::size_t stride, double* out) const;
  bool renew(std::size_t column);
  [[nodiscard]] bool confirms_ray(std::size_t column);
  [[nodiscard]] std::size_t first_row() const;
  [[nodiscard]] std::size_t blocking_row(std::size_t column) const;
  [[nodiscard]] bool lexicographically_less(std::size_t row, std::size_t other, std::size_t column) const;
  [[nodiscard]] double perturbation(std::size_t row, std::size_t index) const;
  void read_solution(const Lcp& problem, std::span<double> z);

  // Variables are numbered w: 0..n-1, z: n..2n-1, z0: 2n. Rows hold basic variables as affine functions
  // of the nonbasic ones:  basic = value + tableau * nonbasic.
  [[nodiscard]] double& entry(std::size_t row, std::size_t column) {
    return tableau_[row * (n_ + 1) + column];
  }
  [[nodiscard]] double entry(std::size_t row, std::size_t column) const {
    return tableau_[row * (n_ + 1) + column];
  }

  // The problem with rows and columns scaled by powers of two; the scales of rows are the covering vector of
  // ones, scaled.
  struct Scaled {
    std::vector<double> m, q;
    std::vector<double> row_scale, column_scale;
  };

  std::size_t n_ = 0, ray_ = 0;  // size; column in which the last path ended at a ray
  Scaled scaled_;
  std::vector<double> tableau_, value_;
  std::vector<std::size_t> basic_, nonbasic_;  // variable in each row, in each column
  std::vector<std::size_t> place_;             // row of a basic variable, n + column of a nonbasic one
  std::vector<double> system_, rhs_, unknown_;
  std::vector<std::size_t> support_;
  RankRevealingQr qr_;
};

}  // namespace carom
