#pragma once

/// \file
/// L U of a sparse matrix that need not be symmetric, though its pattern is taken so: analysed once,
/// factorised often, without allocation. Pivots stay on the diagonal, in an order that is chosen once.

#include <carom/core/export.h>
#include <carom/core/ids.h>
#include <carom/core/numerics/elimination.h>

#include <span>
#include <utility>
#include <vector>

namespace carom {

/// Factors of a matrix A. Rows may have nothing on the diagonal (multipliers of constraints) if they are said
/// to be late: they are eliminated behind all others that they have entries with, which give them a pivot.
/// For a matrix [S B; C 0] near one with S positive definite and C = B^T of full rank no pivot is zero.
class CAROM_API SparseLu {
public:
  /// Chooses the order and finds the fill. Returns the place of each entry in values(); an entry that is
  /// given twice has one place. \param entries (row, column) of all numbers that are not zero \param late by
  /// row; entries of two late rows are none
  std::vector<Index> analyse(std::span<const std::pair<Index, Index>> entries, std::span<const char> late);
  /// The numbers of the matrix.
  [[nodiscard]] std::vector<double>& values() { return values_; }
  /// Factorises the numbers. False where a pivot is zero, or so small against the numbers it came from that
  /// no digits would be left.
  [[nodiscard]] bool factor();
  /// x becomes the solution of A x = x.
  void solve(double* x);

  /// Rows.
  [[nodiscard]] Index size() const { return static_cast<Index>(order_.size()); }
  /// Numbers in the factors.
  [[nodiscard]] std::size_t fill() const { return lower_.size() + upper_.size() + order_.size(); }

private:
  std::vector<Index> order_;                       // rows of the matrix in the order of elimination
  std::vector<Index> entry_begin_, entry_column_;  // the permuted matrix by rows, columns ascending
  EliminationPattern pattern_;
  std::vector<double> values_;
  std::vector<double> lower_;  // L by rows, 1 on the diagonal
  std::vector<double> upper_;  // U by rows: as many numbers in row j as L has in column j
  std::vector<double> pivot_;  // inverse
  std::vector<double> work_;   // zero between calls
};

}  // namespace carom
