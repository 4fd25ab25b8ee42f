#pragma once

/// \file
/// Sets of numbers that are joined pair by pair.

#include <carom/core/ids.h>

#include <algorithm>
#include <numeric>
#include <vector>

namespace carom {

/// The numbers 0 to size - 1, each in a set of its own until sets are joined.
class DisjointSets {
public:
  explicit DisjointSets(Index size) : parent_(size) { std::iota(parent_.begin(), parent_.end(), Index{0}); }

  /// Smallest number of the set of i.
  [[nodiscard]] Index find(Index i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  /// Joins two sets. The smaller number names the new one, so that the order of joins does not matter.
  void join(Index a, Index b) {
    a = find(a);
    b = find(b);
    if (a != b) parent_[std::max(a, b)] = std::min(a, b);
  }

private:
  std::vector<Index> parent_;
};

}  // namespace carom
