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

/// Next step of a path that ends at a ray.
enum class LemkeRay : std::uint8_t {
  repeated,  ///< the second pass: the problem has a solution by theory, so that digits must have been lost
  confirmed  ///< likewise, unless the ray is one in a tableau made anew: the problem need not have a solution
};

/// Complementary pivoting after Lemke with the lexicographic rule (Cottle, Pang, Stone, The Linear
/// Complementarity Problem, 1992, algorithms 4.4.1 and 4.4.9; covering vector of ones), on the problem with
/// rows and columns scaled by powers of two.
///
/// The solution is not read from the tableau but solved anew from the final basis and refined, so that it is
/// as good as the basis. When the tableau's basis turns out wrong, a second pass rebuilds the tableau from
/// the problem's data where it no longer fits them. Finite for exact arithmetic, though some problems take
/// 2^n pivots; contact problems take about n. Keeps its memory between calls.
class CAROM_API Lemke {
public:
  /// Writes z (size n). Statuses: solved (lcp_residual below lcp_accuracy), secondary_ray, pivot_bound,
  /// inaccurate; z is the last point reached where it is not solved. A pass ends after `most_pivots`
  /// pivots (0: 100 + 30 n).
  [[nodiscard]] LcpAnswer solve(const Lcp& problem, std::span<double> z, int most_pivots = 0,
                                LemkeRay ray = LemkeRay::repeated);

private:
  LcpStatus run(bool rebuild, int most_pivots, int& pivots);
  void start();
  void scale(const Lcp& problem);
  void pivot(std::size_t row, std::size_t column);
  void write_column(std::size_t variable, std::size_t stride, double* out) const;
  bool rebuild_tableau(std::size_t first, std::size_t last);
  [[nodiscard]] bool solves_system(std::span<const double> basic, std::span<const double> a);
  [[nodiscard]] bool is_accurate(std::size_t column);
  [[nodiscard]] bool confirms_ray();
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

  std::size_t n_ = 0, ray_ = 0;  // size; column in which the last pass ended at a ray
  Scaled scaled_;
  std::vector<double> tableau_, value_;
  std::vector<std::size_t> basic_, nonbasic_;  // variable in each row, in each column
  std::vector<std::size_t> place_;             // row of a basic variable, n + column of a nonbasic one
  std::vector<double> system_, rhs_, unknown_, entering_, best_;
  std::vector<std::size_t> support_;
  RankRevealingQr qr_;
};

}  // namespace carom
