#include <carom/core/sparse_factors.h>

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>

#include <algorithm>
#include <limits>

namespace carom {

void SparseFactors::analyse(Index size, std::span<const std::pair<Index, Index>> entries) {
  size_ = size;
  // Order of elimination: by minimum degree.
  std::vector<Index> position(size);
  order_.resize(size);
  {
    using Matrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;
    std::vector<Eigen::Triplet<double>> triplets;
    triplets.reserve(2 * entries.size());
    for (const auto& [row, column] : entries) {
      triplets.emplace_back(static_cast<int>(row), static_cast<int>(column), 1.0);
      if (row != column) triplets.emplace_back(static_cast<int>(column), static_cast<int>(row), 1.0);
    }
    Matrix matrix(static_cast<Eigen::Index>(size), static_cast<Eigen::Index>(size));
    matrix.setFromTriplets(triplets.begin(), triplets.end());
    Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> permutation;
    Eigen::AMDOrdering<int> ordering;
    ordering(matrix, permutation);
    for (Index i = 0; i < size; ++i) {
      // The ordering tells the row that comes i-th.
      order_[i] = static_cast<Index>(permutation.indices()[static_cast<Eigen::Index>(i)]);
      position[order_[i]] = i;
    }
  }

  // The permuted lower triangle by rows.
  struct Entry {
    Index row, column, given;
  };
  std::vector<Entry> sorted;
  sorted.reserve(entries.size());
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const Index a = position[entries[i].first], b = position[entries[i].second];
    sorted.push_back({std::max(a, b), std::min(a, b), static_cast<Index>(i)});
  }
  std::sort(sorted.begin(), sorted.end(), [](const Entry& a, const Entry& b) {
    return a.row < b.row || (a.row == b.row && a.column < b.column);
  });
  row_begin_.assign(size + 1, 0);
  column_.clear();
  places_.assign(entries.size(), 0);
  for (const Entry& entry : sorted) {
    places_[entry.given] = static_cast<Index>(column_.size());
    column_.push_back(entry.column);
    ++row_begin_[entry.row + 1];
  }
  for (Index i = 0; i < size; ++i) row_begin_[i + 1] += row_begin_[i];
  values_.assign(column_.size(), 0.0);

  // Rows of L: by the elimination tree.
  std::vector<Index> parent(size, none), mark(size, none);
  std::vector<Index> counts(size, 0);
  pattern_begin_.assign(1, 0);
  pattern_column_.clear();
  std::vector<Index> row;
  for (Index i = 0; i < size; ++i) {
    row.clear();
    mark[i] = i;
    for (Index p = row_begin_[i]; p < row_begin_[i + 1]; ++p) {
      for (Index j = column_[p]; mark[j] != i; j = parent[j]) {
        mark[j] = i;
        row.push_back(j);
        if (parent[j] == none) parent[j] = i;
      }
    }
    std::sort(row.begin(), row.end());
    for (const Index j : row) {
      pattern_column_.push_back(j);
      ++counts[j];
    }
    pattern_begin_.push_back(static_cast<Index>(pattern_column_.size()));
  }
  column_begin_.assign(size + 1, 0);
  for (Index j = 0; j < size; ++j) column_begin_[j + 1] = column_begin_[j] + counts[j];
  lower_row_.assign(pattern_column_.size(), 0);
  lower_.assign(pattern_column_.size(), 0.0);
  pattern_place_.assign(pattern_column_.size(), 0);
  std::vector<Index> next(column_begin_.begin(), column_begin_.end() - 1);
  for (Index i = 0; i < size; ++i) {
    for (Index p = pattern_begin_[i]; p < pattern_begin_[i + 1]; ++p) {
      const Index place = next[pattern_column_[p]]++;
      lower_row_[place] = i;
      pattern_place_[p] = place;
    }
  }
  pivot_.assign(size, 1.0);
  relative_pivot_.assign(size, 1.0);
  work_.assign(size, 0.0);
  answer_.assign(size, 0.0);
}

void SparseFactors::factor() {
  double* const y = work_.data();
  for (Index i = 0; i < size_; ++i) {
    const Index last = row_begin_[i + 1] - 1;
    for (Index p = row_begin_[i]; p < last; ++p) y[column_[p]] = values_[p];
    const double diagonal = values_[last];
    double pivot = diagonal;
    for (Index p = pattern_begin_[i]; p < pattern_begin_[i + 1]; ++p) {
      const Index j = pattern_column_[p], place = pattern_place_[p];
      const double value = y[j];
      y[j] = 0.0;
      for (Index k = column_begin_[j]; k < place; ++k) y[lower_row_[k]] -= lower_[k] * value;
      const double factor = value / pivot_[j];
      pivot -= factor * value;
      lower_[place] = factor;
    }
    relative_pivot_[order_[i]] = diagonal > 0.0 ? pivot / diagonal : 0.0;
    // With an infinite pivot nothing comes from the row and nothing goes to it.
    pivot_[i] = pivot > dependent_pivot * diagonal ? pivot : std::numeric_limits<double>::infinity();
  }
}

void SparseFactors::substitute(double* x) const {
  for (Index j = 0; j < size_; ++j) {
    const double value = x[j];
    for (Index p = column_begin_[j]; p < column_begin_[j + 1]; ++p) x[lower_row_[p]] -= lower_[p] * value;
  }
  for (Index j = size_; j-- > 0;) {
    double value = x[j] / pivot_[j];
    for (Index p = column_begin_[j]; p < column_begin_[j + 1]; ++p) value -= lower_[p] * x[lower_row_[p]];
    x[j] = value;
  }
}

void SparseFactors::solve(double* x) {
  for (Index i = 0; i < size_; ++i) answer_[i] = x[order_[i]];
  substitute(answer_.data());
  for (Index i = 0; i < size_; ++i) x[order_[i]] = answer_[i];
}

void SparseFactors::dependence(std::size_t row, std::vector<double>& out) {
  Index at = 0;
  while (order_[at] != row) ++at;
  std::fill(answer_.begin(), answer_.end(), 0.0);
  for (Index i = 0; i < size_; ++i) {
    for (Index p = row_begin_[i]; p < row_begin_[i + 1]; ++p) {
      if (i == at) answer_[column_[p]] = values_[p];
      if (column_[p] == at) answer_[i] = values_[p];
    }
  }
  substitute(answer_.data());
  out.assign(size_, 0.0);
  for (Index i = 0; i < size_; ++i) out[order_[i]] = i == at ? 1.0 : -answer_[i];
}

}  // namespace carom
