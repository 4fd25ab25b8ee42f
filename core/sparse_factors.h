#pragma once

/// \file
/// L D L^T of a sparse symmetric matrix whose pattern does not change: analysed once, factorised often,
/// without allocation.

#include <carom/core/export.h>
#include <carom/core/ids.h>

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace carom {

/// A row with a pivot below this part of its diagonal follows from others. For the matrix of a mechanism the
/// pivot falls with the square of the distance from a singular position [rad]: within some 3e-5 of one the
/// row is let go. Nearer rounding would be magnified too much, farther away the row is missed.
inline constexpr double dependent_pivot = 1e-9;

/// Factors of a symmetric positive semidefinite matrix A. A row that follows from those eliminated before it
/// is left out: for a right side in the range of A the answer is a solution, with zero there.
class CAROM_API SparseFactors {
public:
  /// \param size rows
  /// \param entries places (row, column) of the lower triangle that are not zero, in any order, each once;
  /// the diagonal must be among them
  void analyse(Index size, std::span<const std::pair<Index, Index>> entries);
  /// Place of the number of an entry in values(), by its place in `entries`.
  [[nodiscard]] Index place(std::size_t entry) const { return places_[entry]; }
  /// The numbers of the matrix.
  [[nodiscard]] std::vector<double>& values() { return values_; }
  /// Factorises the numbers.
  void factor();
  /// x becomes a solution of A x = x.
  void solve(double* x);
  /// The combination of rows that vanishes, for one that was left out: 1 there.
  void dependence(std::size_t row, std::vector<double>& out);
  /// Pivot of a row of the matrix against its diagonal, of the last factorisation; small where the row
  /// follows from others.
  [[nodiscard]] double pivot(std::size_t row) const { return relative_pivot_[row]; }

  [[nodiscard]] Index size() const { return size_; }  ///< rows
  /// Numbers in the factor below its diagonal.
  [[nodiscard]] std::size_t fill() const { return lower_.size(); }

private:
  void substitute(double* x) const;

  Index size_ = 0;
  std::vector<Index> order_;   // row of the matrix by place in the factor
  std::vector<Index> places_;  // by given entry
  // The matrix, by rows of the permuted lower triangle, diagonal last.
  std::vector<Index> row_begin_, column_;
  std::vector<double> values_;
  // Pattern of the rows of L, columns ascending, with their places in lower_; L itself by columns.
  std::vector<Index> pattern_begin_, pattern_column_, pattern_place_;
  std::vector<Index> column_begin_, lower_row_;
  std::vector<double> lower_, pivot_;
  std::vector<double> relative_pivot_;  // by row of the matrix
  std::vector<double> work_, answer_;
};

}  // namespace carom
