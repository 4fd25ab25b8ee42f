#pragma once

/// \file
/// Sets of numbers that are joined two by two, each named by its least member (union-find). Costs as much as
/// there is to join: the rest of the numbers are not looked at.

#include <carom/core/export.h>
#include <carom/core/ids.h>

#include <vector>

namespace carom {

/// Disjoint sets of the numbers 0 to size - 1. Keeps its memory.
class CAROM_API UnionFind {
public:
  /// Parts all that was joined; every number is a set of its own. \param size numbers there are
  void start(Index size);
  /// Joins the sets of two numbers.
  void join(Index a, Index b);
  /// The least number of the set.
  [[nodiscard]] Index find(Index number);

private:
  std::vector<Index> parent_;   // never above the number itself
  std::vector<Index> touched_;  // numbers whose parent is another one
};

}  // namespace carom
