#pragma once

/// \file
/// Small dense linear systems that may be singular: the basis of a pivoting method, the system of a set of
/// modes, the tangential block of W.

#include <carom/core/export.h>

#include <cstddef>
#include <span>
#include <vector>

namespace carom {

/// Householder factorisation A P = Q R with column pivoting of a rows x columns matrix, row-major. Keeps its
/// memory between factorisations. Results are basic solutions: unknowns beyond the rank are zero.
class CAROM_API RankRevealingQr {
public:
  /// Factors a copy of `a` (rows * columns entries). Columns are first scaled to the same length, so that
  /// the rank does not depend on units of the unknowns. A pivot below `tolerance` times the largest one ends
  /// the rank.
  void factor(std::span<const double> a, std::size_t rows, std::size_t columns, double tolerance);

  /// Rank found.
  [[nodiscard]] std::size_t rank() const { return rank_; }

  /// Smallest pivot kept over the largest one: an estimate of 1 / cond(A), 0 for an empty matrix.
  [[nodiscard]] double reciprocal_condition() const;

  /// x (columns) with least |A x - b| (rows), then refined with residuals in twofold precision until they
  /// stop shrinking: forward error of a few roundings for cond(A) below about 1e14.
  void solve(std::span<const double> b, std::span<double> x);

  /// x (columns) with least |A x - b| (rows), as the factors alone give it: for whoever corrects x against
  /// another matrix, near to A.
  void solve_by_factors(std::span<const double> b, std::span<double> x);

  /// Basis vector number `index` < columns - rank of the null space of A, not normalised.
  void null_vector(std::size_t index, std::span<double> x);

private:
  // Longest of the columns left.
  [[nodiscard]] std::size_t longest_column(std::size_t k) const;
  // Reflector I - tau v v^T with v_k = 1, the rest of v stored below the diagonal.
  void reflect(std::size_t k, double length);
  void solve_once(std::span<double> x);
  void back_substitute(std::span<double> x);

  struct Column {
    double tau = 0.0;       // of the reflector at its place
    double scale = 1.0;     // of the column of A, wherever it went
    std::size_t place = 0;  // column of A that stands here
    double square = 0.0;    // of the length of what is left of it,
    double measured = 0.0;  // and when it was last measured

    void measure(const double* column, std::size_t size);
  };
  std::size_t rows_ = 0, columns_ = 0, rank_ = 0;
  std::vector<double> a_, r_, work_, correction_;
  std::vector<Column> column_;
};

}  // namespace carom
