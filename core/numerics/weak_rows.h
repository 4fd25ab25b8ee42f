#pragma once

/// \file
/// Rows of a positive semidefinite matrix that almost follow from others, or do. Eliminated in a fixed order
/// they magnify rounding: a row that follows from a pivot p gets a pivot of rounding/p and may pass for
/// independent. Left to the end, with the largest remaining pivot first, they do not.

#include <carom/core/export.h>
#include <carom/core/ids.h>

#include <cstddef>
#include <span>
#include <vector>

namespace carom {

/// L D L^T, with diagonal pivoting, of what a matrix A has left of its weak rows when its strong ones are
/// eliminated (their Schur complement S). For each weak row w the combination c_w of rows is kept, 1 at w and
/// 0 at other weak rows, that vanishes at strong rows; then S = C^T A C.
class CAROM_API WeakRows {
public:
  /// Beyond that many the dense numbers would outgrow the sparse ones.
  static constexpr std::size_t most = 256;

  /// No rows.
  void clear() { rows_.clear(); }
  /// True if there are none.
  [[nodiscard]] bool empty() const { return rows_.empty(); }
  /// Takes the rows whose pivots are no larger than `weak`. \param pivots of all rows, against their diagonal
  void assign(std::span<const double> pivots, double weak);
  /// Rows that are weak.
  [[nodiscard]] std::span<const std::size_t> rows() const { return rows_; }
  /// The combination of a weak row, by its place among them; to be filled in.
  [[nodiscard]] double* combination(std::size_t weak) { return combination_.data() + weak * size_; }
  [[nodiscard]] const double* combination(std::size_t weak) const {
    return combination_.data() + weak * size_;
  }
  /// A number of S; to be filled in, both triangles.
  [[nodiscard]] double& at(std::size_t row, std::size_t column) {
    return schur_[row * rows_.size() + column];
  }
  /// Diagonal of A at a weak row; to be filled in.
  [[nodiscard]] double& whole(std::size_t weak) { return whole_[weak]; }
  /// Factorises S. A row whose pivot falls to `dependent` of its diagonal in A, or below, follows from others
  /// and is left out.
  void factor(double dependent);
  /// Pivot of a weak row against its diagonal in A; of one that is left out, what would have been it.
  [[nodiscard]] double relative_pivot(std::size_t weak) const { return relative_pivot_[weak]; }
  /// Finds the share of the weak rows in a solution of A x = r.
  void take(const double* right);
  /// Adds that share to the solution by strong rows alone, which is zero at weak ones.
  void add_to(double* x) const;

private:
  std::vector<std::size_t> rows_;
  std::size_t size_ = 0;
  std::vector<double> combination_;  // by weak row, over all rows
  std::vector<double> schur_;        // S, then D on its diagonal and L, a later row at an earlier column
  std::vector<std::size_t> order_;   // places in rows_, as eliminated
  std::size_t rank_ = 0;
  std::vector<double> whole_, relative_pivot_, share_;  // by weak row
};

}  // namespace carom
