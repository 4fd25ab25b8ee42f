#include <carom/core/numerics/sparse_lu.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace carom {

namespace {

using Entry = std::pair<Index, Index>;

// A pivot below this part of the largest number that was added up to it is rounding.
constexpr double lost = 64.0 * std::numeric_limits<double>::epsilon();

/// The order of elimination: by minimum degree of what a matrix without its late rows would be after their
/// elimination, each late row behind the last of its neighbours.
std::vector<Index> order_of(std::span<const Entry> entries, std::span<const char> late) {
  const auto rows = static_cast<Index>(late.size());
  std::vector<Index> number(rows, none), early;
  for (Index i = 0; i < rows; ++i) {
    if (late[i] != 0) continue;
    number[i] = static_cast<Index>(early.size());
    early.push_back(i);
  }
  std::vector<Entry> graph, ties;  // ties: (late row, a neighbour)
  for (const auto& [row, column] : entries) {
    if (late[row] == 0 && late[column] == 0) {
      graph.emplace_back(number[row], number[column]);
    } else if (late[row] != late[column]) {
      ties.emplace_back(late[row] != 0 ? row : column, late[row] != 0 ? column : row);
    }
  }
  std::sort(ties.begin(), ties.end());
  ties.erase(std::unique(ties.begin(), ties.end()), ties.end());
  for (std::size_t first = 0, last = 0; first < ties.size(); first = last) {
    while (last < ties.size() && ties[last].first == ties[first].first) ++last;
    for (std::size_t i = first; i < last; ++i) {
      for (std::size_t j = first; j < i; ++j) {
        graph.emplace_back(number[ties[i].second], number[ties[j].second]);
      }
    }
  }
  const std::vector<Index> of_early = elimination_order(static_cast<Index>(early.size()), graph);
  std::vector<Index> position(rows, none);
  for (Index i = 0; i < early.size(); ++i) position[early[of_early[i]]] = i;
  // Late rows by the last of their neighbours; those without any come first and have no pivot.
  std::vector<Entry> behind;
  for (Index i = 0; i < rows; ++i) {
    if (late[i] != 0) position[i] = 0;
  }
  for (const auto& [row, neighbour] : ties) position[row] = std::max(position[row], position[neighbour] + 1);
  for (Index i = 0; i < rows; ++i) {
    if (late[i] != 0) behind.emplace_back(position[i], i);
  }
  std::sort(behind.begin(), behind.end());
  std::vector<Index> order;
  order.reserve(rows);
  auto next = behind.begin();
  for (Index i = 0; i <= early.size(); ++i) {
    for (; next != behind.end() && next->first == i; ++next) order.push_back(next->second);
    if (i < early.size()) order.push_back(early[of_early[i]]);
  }
  return order;
}

}  // namespace

std::vector<Index> SparseLu::analyse(std::span<const Entry> entries, std::span<const char> late) {
  order_ = order_of(entries, late);
  std::vector<Index> position(order_.size());
  for (Index i = 0; i < size(); ++i) position[order_[i]] = i;
  std::vector<Entry> sorted;
  sorted.reserve(entries.size());
  for (const auto& [row, column] : entries) sorted.emplace_back(position[row], position[column]);
  const std::vector<Entry> permuted = sorted;
  std::sort(sorted.begin(), sorted.end());
  sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
  std::vector<Index> places;
  places.reserve(entries.size());
  for (const Entry& entry : permuted) {
    const auto found = std::lower_bound(sorted.begin(), sorted.end(), entry);
    places.push_back(static_cast<Index>(found - sorted.begin()));
  }
  const auto by_rows = [&](const std::vector<Entry>& list, std::vector<Index>& begin,
                           std::vector<Index>& columns) {
    begin.assign(order_.size() + 1, 0);
    columns.clear();
    for (const auto& [row, column] : list) {
      ++begin[row + 1];
      columns.push_back(column);
    }
    for (std::size_t i = 0; i < order_.size(); ++i) begin[i + 1] += begin[i];
  };
  by_rows(sorted, entry_begin_, entry_column_);
  std::vector<Entry> lower;
  for (const auto& [row, column] : sorted) {
    if (row != column) lower.emplace_back(std::max(row, column), std::min(row, column));
  }
  std::sort(lower.begin(), lower.end());
  std::vector<Index> begin, columns;
  by_rows(lower, begin, columns);
  pattern_.find_fill(begin, columns);
  values_.assign(sorted.size(), 0.0);
  lower_.assign(pattern_.left_column.size(), 0.0);
  upper_.assign(pattern_.left_column.size(), 0.0);
  pivot_.assign(order_.size(), 0.0);
  work_.assign(order_.size(), 0.0);
  return places;
}

bool SparseLu::factor() {
  double* const work = work_.data();
  const Index* const below = pattern_.below_row.data();
  bool regular = true;
  for (Index i = 0; i < size(); ++i) {
    for (Index p = entry_begin_[i]; p < entry_begin_[i + 1]; ++p) work[entry_column_[p]] = values_[p];
    double largest = std::abs(work[i]);
    for (Index p = pattern_.left_begin[i]; p < pattern_.left_begin[i + 1]; ++p) {
      const Index j = pattern_.left_column[p], place = pattern_.left_place[p];
      const double factor = work[j] * pivot_[j];
      work[j] = 0.0;
      lower_[p] = factor;
      if (factor == 0.0) continue;
      const double* const upper = upper_.data();
      for (Index k = pattern_.below_begin[j]; k < pattern_.below_begin[j + 1]; ++k) {
        work[below[k]] -= factor * upper[k];
      }
      largest = std::max(largest, std::abs(factor * upper[place]));
    }
    for (Index k = pattern_.below_begin[i]; k < pattern_.below_begin[i + 1]; ++k) {
      upper_[k] = work[below[k]];
      work[below[k]] = 0.0;
    }
    const double pivot = work[i];
    work[i] = 0.0;
    // Written so that what is not a number is refused; the work is zeroed all the same.
    if (!(std::abs(pivot) > lost * largest)) regular = false;
    pivot_[i] = 1.0 / pivot;
  }
  return regular;
}

void SparseLu::solve(double* x) {
  double* const y = work_.data();
  for (Index i = 0; i < size(); ++i) {
    double sum = x[order_[i]];
    for (Index p = pattern_.left_begin[i]; p < pattern_.left_begin[i + 1]; ++p) {
      sum -= lower_[p] * y[pattern_.left_column[p]];
    }
    y[i] = sum;
  }
  for (Index i = size(); i-- > 0;) {
    double sum = y[i];
    for (Index k = pattern_.below_begin[i]; k < pattern_.below_begin[i + 1]; ++k) {
      sum -= upper_[k] * y[pattern_.below_row[k]];
    }
    y[i] = sum * pivot_[i];
  }
  for (Index i = 0; i < size(); ++i) {
    x[order_[i]] = y[i];
    y[i] = 0.0;
  }
}

}  // namespace carom
