#include <carom/core/numerics/elimination.h>

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>

#include <algorithm>

namespace carom {

std::vector<Index> elimination_order(Index rows, std::span<const std::pair<Index, Index>> entries) {
  using Matrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;
  std::vector<Eigen::Triplet<double>> triplets;
  triplets.reserve(2 * entries.size());
  for (const auto& [row, column] : entries) {
    triplets.emplace_back(static_cast<int>(row), static_cast<int>(column), 1.0);
    if (row != column) triplets.emplace_back(static_cast<int>(column), static_cast<int>(row), 1.0);
  }
  Matrix matrix(static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(rows));
  matrix.setFromTriplets(triplets.begin(), triplets.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> permutation;
  Eigen::AMDOrdering<int> ordering;
  ordering(matrix, permutation);
  std::vector<Index> order(rows);
  // The ordering tells the row that comes i-th.
  for (Index i = 0; i < rows; ++i) {
    order[i] = static_cast<Index>(permutation.indices()[static_cast<Eigen::Index>(i)]);
  }
  return order;
}

/// Rows of L by the elimination tree, and its columns.
void EliminationPattern::find_fill(std::span<const Index> entry_begin, std::span<const Index> entry_column) {
  const auto rows = static_cast<Index>(entry_begin.size() - 1);
  std::vector<Index> parent(rows, none), mark(rows, none), counts(rows, 0);
  left_begin.assign(1, 0);
  left_column.clear();
  std::vector<Index> row;
  for (Index i = 0; i < rows; ++i) {
    row.clear();
    mark[i] = i;
    for (Index p = entry_begin[i]; p < entry_begin[i + 1]; ++p) {
      if (entry_column[p] >= i) continue;
      for (Index j = entry_column[p]; mark[j] != i; j = parent[j]) {
        mark[j] = i;
        row.push_back(j);
        if (parent[j] == none) parent[j] = i;
      }
    }
    std::sort(row.begin(), row.end());
    for (const Index j : row) ++counts[j];
    left_column.insert(left_column.end(), row.begin(), row.end());
    left_begin.push_back(static_cast<Index>(left_column.size()));
  }
  left_column.shrink_to_fit();
  below_begin.assign(rows + 1, 0);
  for (Index j = 0; j < rows; ++j) below_begin[j + 1] = below_begin[j] + counts[j];
  below_row.assign(left_column.size(), 0);
  left_place.assign(left_column.size(), 0);
  std::vector<Index> next(below_begin.begin(), below_begin.end() - 1);
  for (Index i = 0; i < rows; ++i) {
    for (Index p = left_begin[i]; p < left_begin[i + 1]; ++p) {
      const Index place = next[left_column[p]]++;
      below_row[place] = i;
      left_place[p] = place;
    }
  }
}

}  // namespace carom
