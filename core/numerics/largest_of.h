#pragma once

/// \file
/// The largest of numbers that are calculated from arrays, two at a time.

#include <carom/core/ids.h>
#include <carom/core/numerics/pair.h>

#include <algorithm>

namespace carom {

/// Largest of f over `range`, at least 0; what is no number is passed over. \param f f(at) gives two
/// neighbouring ones, where at(array) are their numbers in an array that `range` indexes
template <class F>
[[nodiscard]] double largest_of(Range range, F&& f) {
  Pair most{};
  Index i = range.begin;
  for (; i + 1 < range.end; i += 2) {
    most = larger(f([i](const double* array) { return load_pair(array + i); }), most);
  }
  if (i < range.end) most = larger(f([i](const double* array) { return Pair{array[i], 0.0}; }), most);
  return std::max(most[0], most[1]);
}

}  // namespace carom
