#pragma once

/// \file
/// Substitution in factors of blocks of two rows each of which has one block of L below it: those of pins in
/// chains and trees, where it is most of the work of a small mechanism.

#include <carom/core/ids.h>
#include <carom/core/numerics/elimination.h>
#include <carom/core/numerics/pair.h>

#include <algorithm>

namespace carom {

/// Factors L D L^T of a matrix of blocks of two rows, in the order of elimination.
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
  // In chains one block leads to the next: its numbers go there without a way through memory.
  double first = x[0], second = x[1];
  for (Index j = 0; j < last; ++j) {
    const double* const l = at.lower + 4 * j;
    second -= at.own[j] * first;
    x[2 * j + 1] = second;
    double* const to = x + 2 * at.below[j];
    const double below = to[0] - (l[0] * first + l[1] * second);
    const double next_below = to[1] - (l[2] * first + l[3] * second);
    to[0] = below;
    to[1] = next_below;
    if (at.below[j] == j + 1) {
      first = below;
      second = next_below;
    } else {
      first = x[2 * j + 2];
      second = x[2 * j + 3];
    }
  }
  second -= at.own[last] * first;
  second /= at.pivots[2 * last + 1];
  first = first / at.pivots[2 * last] - at.own[last] * second;
  const auto write = [&](Index j) {
    x[2 * j] = given[at.given_row[j]] = first;
    x[2 * j + 1] = given[at.given_row[j] + 1] = second;
  };
  write(last);
  for (Index j = last; j-- > 0;) {
    const double* const l = at.lower + 4 * j;
    if (at.below[j] != j + 1) {
      first = x[2 * at.below[j]];
      second = x[2 * at.below[j] + 1];
    }
    const double mine = x[2 * j] / at.pivots[2 * j] - l[0] * first - l[2] * second;
    second = x[2 * j + 1] / at.pivots[2 * j + 1] - l[1] * first - l[3] * second;
    first = mine - at.own[j] * second;
    write(j);
  }
  std::fill_n(x, 2 * at.blocks, 0.0);
}

}  // namespace carom
