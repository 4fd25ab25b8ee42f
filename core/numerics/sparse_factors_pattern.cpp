// Problem: order the elimination of a sparse symmetric matrix, and know where its numbers and those of its
// factors stand.

#include <carom/core/numerics/elimination.h>
#include <carom/core/numerics/sparse_factors.h>

#include <algorithm>
#include <numeric>

namespace carom {

std::vector<SparseFactors::Place> SparseFactors::analyse(std::span<const Index> sizes,
                                                         std::span<const std::pair<Index, Index>> entries) {
  const auto blocks = static_cast<Index>(sizes.size());
  auto pattern = std::make_shared<Pattern>();
  const std::vector<Index> order = elimination_order(blocks, entries);
  std::vector<Index> position(blocks), first_row(blocks);
  std::exclusive_scan(sizes.begin(), sizes.end(), first_row.begin(), Index{0});
  pattern->row_begin.assign(1, 0);
  pattern->own_begin.assign(1, 0);
  for (Index i = 0; i < blocks; ++i) {
    const Index size = sizes[order[i]];
    position[order[i]] = i;
    pattern->given_row.push_back(first_row[order[i]]);
    pattern->row_begin.push_back(pattern->row_begin.back() + size);
    pattern->own_begin.push_back(pattern->own_begin.back() + size * (size - 1) / 2);
    pattern->most = std::max(pattern->most, size);
  }
  pattern->own_size = pattern->own_begin.back();
  pattern->uniform = pattern->row_begin.back() == pattern->most * blocks;

  // The permuted lower triangle by rows.
  struct Entry {
    Index row, column, given;
  };
  std::vector<Entry> sorted;
  sorted.reserve(entries.size());
  std::vector<Place> places(entries.size());
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const Index a = position[entries[i].first], b = position[entries[i].second];
    places[i].transposed = a < b;
    sorted.push_back({std::max(a, b), std::min(a, b), static_cast<Index>(i)});
  }
  std::sort(sorted.begin(), sorted.end(), [](const Entry& a, const Entry& b) {
    return a.row < b.row || (a.row == b.row && a.column < b.column);
  });
  pattern->entry_begin.assign(blocks + 1, 0);
  pattern->entry_column.reserve(sorted.size());
  for (const Entry& entry : sorted) {
    places[entry.given].first = static_cast<Index>(pattern->values_size);
    pattern->values_size += std::size_t{pattern->rows(entry.row)} * pattern->rows(entry.column);
    pattern->entry_column.push_back(entry.column);
    ++pattern->entry_begin[entry.row + 1];
  }
  for (Index i = 0; i < blocks; ++i) pattern->entry_begin[i + 1] += pattern->entry_begin[i];
  pattern->number_fill();
  pattern_ = std::move(pattern);
  for (std::vector<double>* const numbers : {&values_, &lower_, &own_, &pivot_, &relative_pivot_, &work_}) {
    numbers->clear();
  }
  return places;
}

/// The fill, and where the numbers of its blocks begin.
void SparseFactors::Pattern::number_fill() {
  find_fill(entry_begin, entry_column);
  below_number.assign(below_row.size(), 0);
  for (Index j = 0; j < blocks(); ++j) {
    for (Index k = below_begin[j]; k < below_begin[j + 1]; ++k) {
      below_number[k] = static_cast<Index>(lower_size);
      lower_size += std::size_t{rows(j)} * rows(below_row[k]);
    }
  }
}

}  // namespace carom
