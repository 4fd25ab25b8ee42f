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

/// Factors of a symmetric positive semidefinite matrix A. Where rows depend on each other a pivot vanishes;
/// the matrix is therefore factorised with its diagonal larger by the part `shift`, and solve() takes the
/// difference out by repeated correction: for a right side in the range of A the answer is a solution.
class CAROM_API SparseFactors {
public:
  /// The part by which the diagonal is raised.
  static constexpr double shift = 1e-13;

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

  [[nodiscard]] Index size() const { return size_; }  ///< rows
  /// Numbers in the factor below its diagonal.
  [[nodiscard]] std::size_t fill() const { return lower_.size(); }
  /// Least pivot against the diagonal it came from, of the last factorisation: near `shift` where rows depend
  /// on each other.
  [[nodiscard]] double least_pivot() const { return least_pivot_; }

private:
  void solve_once(double* x) const;

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
  std::vector<double> work_;
  std::vector<double> right_, answer_;
  double least_pivot_ = 1.0;
};

}  // namespace carom
