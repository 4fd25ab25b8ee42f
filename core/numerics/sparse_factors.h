#pragma once

/// \file
/// L D L^T of a sparse symmetric matrix whose pattern does not change: analysed once, factorised often,
/// without allocation. Rows with the same pattern are given as blocks, which are dense.

#include <carom/core/export.h>
#include <carom/core/ids.h>
#include <carom/core/numerics/elimination.h>
#include <carom/core/numerics/weak_rows.h>

#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace carom {

/// A row with a pivot below this part of its diagonal follows from others. For the matrix of a mechanism the
/// pivot falls with the square of the distance from a singular position [rad]: within some 3e-5 of one the
/// row is let go. Nearer rounding would be magnified too much, farther away the row is missed.
inline constexpr double dependent_pivot = 1e-9;

/// Where a row is doubtful, those with a pivot below this part of their diagonal are eliminated last.
inline constexpr double weak_pivot = 1e-3;

/// Factors of a symmetric positive semidefinite matrix A. A row that follows from those eliminated before it
/// is left out: for a right side in the range of A the answer is a solution, with zero there. Copies share
/// the pattern.
class CAROM_API SparseFactors {
public:
  static constexpr Index most_rows = 6;  ///< of a block

  /// Where the numbers of a given block stand in values(), row by row.
  struct Place {
    Index first = 0;
    bool transposed = false;  ///< the transpose of the block stands there
  };

  /// Returns the places of the entries.
  /// \param sizes rows of each block, 1 to most_rows
  /// \param entries blocks (row, column) of the lower triangle that are not zero, in any order, each once;
  /// those on the diagonal must be among them, of which the lower triangle is read
  std::vector<Place> analyse(std::span<const Index> sizes, std::span<const std::pair<Index, Index>> entries);
  /// The numbers of the matrix. Memory for numbers is taken when they are first asked for.
  [[nodiscard]] std::vector<double>& values();
  /// Lets factor() decide with care which rows follow from others where some almost do (WeakRows): near a
  /// singular position of a mechanism with redundant rows the order of elimination may magnify rounding until
  /// a redundant row passes for independent. Costs a second factorisation there, and nothing elsewhere.
  void reveal_rank(bool reveals) { reveals_rank_ = reveals; }
  /// Factorises the numbers.
  void factor();
  /// Factorises the numbers where it is known which rows follow from others: these are left out and no other
  /// one, however small its pivot is, but for rounding.
  /// \param left_out by row of the matrix, not 0 where it follows from others
  void factor_without(std::span<const char> left_out);
  /// x becomes a solution of A x = x.
  void solve(double* x);
  /// The combination of rows that vanishes, for given shares of those that were left out.
  /// \param shares by row, zero at rows that were not left out
  void dependence(std::span<const double> shares, std::vector<double>& out);
  /// The combination of rows that vanishes, with share 1 of a row that was left out and 0 of all others.
  void dependence(std::size_t row, std::vector<double>& out) {
    row_.assign(size(), 0.0);
    row_[row] = 1.0;
    dependence(row_, out);
  }
  /// Pivot of a row of the matrix against its diagonal, of the last factorisation; small where the row
  /// follows from others.
  [[nodiscard]] double pivot(std::size_t row) const { return relative_pivot_[row]; }

  /// Rows.
  [[nodiscard]] Index size() const { return pattern_ ? pattern_->row_begin.back() : 0; }
  /// Numbers in the factor below its diagonal.
  [[nodiscard]] std::size_t fill() const { return pattern_ ? pattern_->lower_size + pattern_->own_size : 0; }

private:
  // Places of blocks are those in the factor: in the order of elimination.
  struct Pattern : EliminationPattern {
    std::vector<Index> row_begin;  // first row in the factor, by block
    std::vector<Index> given_row;  // first row in the matrix, by block
    // The matrix by rows of blocks of the permuted lower triangle, diagonal last.
    std::vector<Index> entry_begin, entry_column;
    std::size_t values_size = 0;
    // Where the numbers of the blocks of L begin, by columns.
    std::vector<Index> below_number;
    std::size_t lower_size = 0;
    // Numbers of L within the blocks on the diagonal.
    std::vector<Index> own_begin;
    std::size_t own_size = 0;
    Index most = 1;        // rows of the largest block
    bool uniform = false;  // all have that many

    [[nodiscard]] Index blocks() const { return static_cast<Index>(given_row.size()); }
    [[nodiscard]] Index rows(Index block) const { return row_begin[block + 1] - row_begin[block]; }
    void number_fill();
  };
  template <Index Rows>
  void factor_blocks(double least_pivot, const char* left_out);
  void factor_down_to(double least_pivot, const char* left_out = nullptr);
  [[nodiscard]] bool is_doubtful() const;
  void factor_weak_rows();
  void multiply(const double* x, double* out) const;
  void read_row(std::size_t row, double* out);
  void solve_strong(double* x);
  template <Index Rows>
  void substitute(double* given);
  template <class F>
  void with_rows(F&& f) const;

  std::shared_ptr<const Pattern> pattern_;
  std::vector<double> values_;
  std::vector<double> lower_, own_;     // L, off and in the blocks of the diagonal
  std::vector<double> pivot_;           // by row in the factor; infinite of a row that is left out
  std::vector<double> relative_pivot_;  // by row of the matrix
  std::vector<double> work_;            // zero between calls
  bool reveals_rank_ = false;
  WeakRows weak_;            // empty unless rows are doubtful
  std::vector<double> row_;  // of the matrix
};

}  // namespace carom
