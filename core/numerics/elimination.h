#pragma once

/// \file
/// Elimination of a sparse matrix with a symmetric pattern before its numbers are known: an
/// order with little fill, and the pattern of the triangle that comes out.

#include <carom/core/export.h>
#include <carom/core/ids.h>

#include <span>
#include <utility>
#include <vector>

namespace carom {

/// Rows in the order of their elimination, by approximate minimum degree. \param entries (row, column) of one
/// triangle or of both, repeated or not
[[nodiscard]] CAROM_API std::vector<Index> elimination_order(
    Index rows, std::span<const std::pair<Index, Index>> entries);

/// The lower triangle L of a matrix whose rows are in the order of elimination, off its diagonal.
struct CAROM_API EliminationPattern {
  std::vector<Index> left_begin, left_column;  ///< by rows, columns ascending
  std::vector<Index> left_place;               ///< where those stand in the lists by columns
  std::vector<Index> below_begin, below_row;   ///< by columns, rows ascending

  /// Finds it. \param entry_begin,entry_column the matrix' lower triangle by rows; numbers on and above the
  /// diagonal are passed over
  void find_fill(std::span<const Index> entry_begin, std::span<const Index> entry_column);
};

}  // namespace carom
