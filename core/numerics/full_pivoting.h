#pragma once

/// \file
/// Gauss's elimination with full pivoting of a small dense matrix: a basic solution where rows depend on each
/// other, and the vectors that the matrix maps to zero.

#include <carom/core/export.h>

#include <cstddef>
#include <vector>

namespace carom {

/// Factors of one matrix. Keeps its memory.
class CAROM_API FullPivoting {
public:
  /// Sizes the matrix, whose numbers are then to be written to matrix(). \param n rows and columns
  void reset(std::size_t n);
  /// The matrix, row-major; overwritten by solve().
  [[nodiscard]] double* matrix() { return matrix_.data(); }
  /// Eliminates, and replaces the right side by a solution: unknowns beyond the rank are zero. False if a
  /// number is not finite. \param dependent pivots below this part of the largest are rounding
  [[nodiscard]] bool solve(double dependent, std::vector<double>& right);
  /// Solves with the matrix of the last solve() for another right side, which the solution replaces, to the
  /// bits that solve() would give. That solve() must have succeeded, and matrix() not have been touched
  /// since. False if a number is not finite.
  [[nodiscard]] bool solve_again(std::vector<double>& right);

  /// Number of unknowns.
  [[nodiscard]] std::size_t size() const { return row_order_.size(); }
  /// Number of pivots.
  [[nodiscard]] std::size_t rank() const { return rank_; }
  /// Row of the matrix that was eliminated as the k-th.
  [[nodiscard]] std::size_t row(std::size_t k) const { return row_order_[k]; }
  /// Unknown that was solved for when the k-th row was eliminated.
  [[nodiscard]] std::size_t column(std::size_t k) const { return column_order_[k]; }
  /// Writes the null vector that belongs to a free column. \param free from rank() to size() - 1
  void null_vector(std::size_t free, std::vector<double>& out) const;

private:
  // Columns are moved into the order of elimination, so that rows are read on end; rows stay where they are.
  [[nodiscard]] const double* row_at(std::size_t i) const { return matrix_.data() + row_order_[i] * size(); }
  [[nodiscard]] double entry(std::size_t i, std::size_t j) const { return row_at(i)[j]; }
  [[nodiscard]] bool solve_one(double& right);
  [[nodiscard]] static bool fail(std::vector<double>& right);
  struct Pivot {
    std::size_t row, column;  // in the order of elimination
    double size;
  };
  [[nodiscard]] double largest_from(const double* row, std::size_t column) const;
  [[nodiscard]] Pivot choose_pivot(std::size_t step) const;
  void swap_columns(std::size_t a, std::size_t b);
  [[nodiscard]] bool substitute(std::vector<double>& right);

  std::vector<double> matrix_, work_;
  std::vector<double> row_sizes_;  // largest number that is left, by row
  std::vector<std::size_t> row_order_, column_order_;
  std::size_t rank_ = 0;
};

}  // namespace carom
