#pragma once

/// \file
/// Substitution in factors of blocks of two rows each of which has one block of L below it: those of pins in
/// chains and trees, where it is most of the work of a small mechanism.

#include <carom/core/ids.h>
#include <carom/core/numerics/elimination.h>
#include <carom/core/numerics/pair.h>

#include <algorithm>

namespace carom {

/// Factors L D L^T of such a matrix, by blocks in the order of elimination.
struct PairFactors {
  const Index* given_row;  ///< first row of a block in the matrix
  const Index* below;      ///< block whose rows have the block of L of a column; of all but the last column
  Index blocks;            ///< at least one
  const double* lower;     ///< blocks of L below the diagonal, row by row
  const double* own;       ///< number of L within a block of the diagonal
  const double* pivots;    ///< D
};

/// True if every column of blocks but the last has one block below the diagonal.
inline bool is_chained(const EliminationPattern& pattern) {
  const auto last = static_cast<Index>(pattern.below_begin.size()) - 2;
  bool one_each = pattern.below_row.size() == last;
  for (Index j = 0; j <= last; ++j) one_each = one_each && pattern.below_begin[j] == j;
  return one_each;
}

/// `given` becomes the solution of L D L^T x = given. \param x two numbers a block, zero before and after
inline void substitute_pairs(const PairFactors& at, double* x, double* given) {
  for (Index j = 0; j < at.blocks; ++j) store_pair(x + 2 * j, load_pair(given + at.given_row[j]));
  const Index last = at.blocks - 1;
  for (Index j = 0; j < last; ++j) {
    const double* const l = at.lower + 4 * j;
    const double first = x[2 * j], second = x[2 * j + 1] - at.own[j] * first;
    x[2 * j + 1] = second;
    double* const to = x + 2 * at.below[j];
    store_pair(to, load_pair(to) - (Pair{l[0], l[2]} * both(first) + Pair{l[1], l[3]} * both(second)));
  }
  x[2 * last + 1] -= at.own[last] * x[2 * last];
  for (Index j = at.blocks; j-- > 0;) {
    const double* const l = at.lower + 4 * j;
    Pair mine = load_pair(x + 2 * j) / load_pair(at.pivots + 2 * j);
    if (j < last) {
      const double* const from = x + 2 * at.below[j];
      mine -= load_pair(l) * both(from[0]);
      mine -= load_pair(l + 2) * both(from[1]);
    }
    mine[0] -= at.own[j] * mine[1];
    store_pair(x + 2 * j, mine);
    store_pair(given + at.given_row[j], mine);
  }
  std::fill_n(x, 2 * at.blocks, 0.0);
}

}  // namespace carom
