#pragma once

/// \file
/// A grid with several sizes of cells that finds which boxes overlap.
///
/// Boxes are of all sizes, so one size of cells would put many boxes into one cell or one box into many. Each
/// box stands in one cell of the level whose cells are less than twice as large as it, the cell of its least
/// corner. A box that overlaps it has its corner in the same cell or a neighbour if it is of that level; a
/// smaller box looks up the few cells of each coarser level. Cells are numbered modulo the size of a table,
/// so space has no bounds: boxes far apart may share a place in it, which costs a test and changes nothing.

#include <carom/contact/detection/box.h>
#include <carom/core/export.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace carom {

/// A box with its number.
template <int D>
struct NumberedBox {
  Box<D> box;
  Index number = none;
};

/// Boxes by cell. Built anew in O(N); keeps its memory.
template <int D>
class CAROM_API BoxGrid {
public:
  /// Takes boxes, in any order. \param boxes finite, min <= max
  void build(std::span<const NumberedBox<D>> boxes);

  /// Calls f(i, j) once for every two boxes that overlap, with their numbers, in no particular order.
  template <class F>
  void for_pairs(F&& f) const;

  /// Calls f(i) once for every box that overlaps a given one. \param box finite
  template <class F>
  void for_overlapping(const Box<D>& box, F&& f) const {
    for (const Level& level : levels_) for_overlapping(level, box, f);
  }

private:
  using Cell = std::array<std::int64_t, std::size_t{D}>;
  // Cells of one size, at least that of their boxes.
  struct Level {
    double cell = 0.0, inverse = 0.0;            // size [m]
    Index places = 0;                            // first place in `begin_`
    Index mask = 0;                              // how many places, less one: 2^k - 1
    std::array<Index, std::size_t{D}> stride{};  // places from a cell to the next along each axis
    std::array<Index, D == 2 ? 1 : 4> rows{};    // from a cell to the rows after its own next to it
  };
  static constexpr Index fewest_places = D == 2 ? 64 : 256;  // rows next to each other share none

  void find_levels(std::span<const NumberedBox<D>> boxes);
  void place(std::span<const NumberedBox<D>> boxes);
  static Cell cell_of(const Level& level, const Vec<D>& corner);
  static Index place_of(const Level& level, const Cell& cell);
  // Calls f with the entries of `count` places from one on, which wrap around.
  template <class F>
  void for_places(const Level& level, Index place, Index count, F&& f) const;
  template <class F>
  void for_overlapping(const Level& level, const Box<D>& box, F&& f) const;
  template <class F>
  void for_pairs_in_place(std::size_t level, Index place, F&& f) const;

  std::vector<Level> levels_;            // of the smallest boxes first
  std::vector<NumberedBox<D>> entries_;  // by level and place
  std::vector<Index> begin_;             // of each place: its first entry
  std::vector<Index> place_;             // of each box, in the order of build()
  std::vector<std::uint8_t> level_;      // likewise
};

template <int D>
template <class F>
void BoxGrid<D>::for_places(const Level& level, Index place, Index count, F&& f) const {
  const Index first = place & level.mask, end = first + count, size = level.mask + 1;
  const auto visit = [&](Index from, Index to) {
    const Index last = begin_[level.places + to];
    for (Index e = begin_[level.places + from]; e < last; ++e) f(entries_[e]);
  };
  if (end <= size) return visit(first, end);
  visit(first, size);
  visit(0, end - size);
}

template <int D>
template <class F>
void BoxGrid<D>::for_overlapping(const Level& level, const Box<D>& box, F&& f) const {
  // A box that overlaps has its least corner no farther below this one than it is large. The sum is rounded
  // to the nearest number and cell_of() is monotonic, so no corner is missed.
  Cell low, high;
  Vec<D> least = box.min;
  for (int k = 0; k < D; ++k) least[k] -= level.cell;
  low = cell_of(level, least), high = cell_of(level, box.max);
  bool near = true;
  double rows = 1.0;
  for (std::size_t k = 0; k < D; ++k) {
    near = near && high[k] - low[k] <= 2;
    if (k > 0) rows *= static_cast<double>(high[k] - low[k] + 1);
  }
  const auto test = [&](const NumberedBox<D>& entry) {
    if (overlap(entry.box, box)) f(entry.number);
  };
  const Index entries = begin_[level.places + level.mask + 1] - begin_[level.places];
  const auto wide = static_cast<std::uint64_t>(high[0] - low[0]) >= level.mask;
  if (!near && (wide || rows > static_cast<double>(entries))) {
    return for_places(level, 0, level.mask + 1, test);
  }
  Cell row = low;
  const auto count = static_cast<Index>(high[0] - low[0] + 1);
  // Rows far from each other may share places: an entry counts in the row where it is.
  const auto test_in_row = [&](const NumberedBox<D>& entry) {
    if (!overlap(entry.box, box)) return;
    const Cell at = cell_of(level, entry.box.min);
    for (std::size_t k = 1; k < D; ++k) {
      if (at[k] != row[k]) return;
    }
    f(entry.number);
  };
  for (;;) {
    if (near) {
      for_places(level, place_of(level, row), count, test);
    } else {
      for_places(level, place_of(level, row), count, test_in_row);
    }
    std::size_t k = 1;
    while (k < D && row[k] == high[k]) row[k] = low[k], ++k;
    if (k == D) return;
    ++row[k];
  }
}

template <int D>
template <class F>
void BoxGrid<D>::for_pairs_in_place(std::size_t number, Index place, F&& f) const {
  const Level& level = levels_[number];
  const Index begin = begin_[level.places + place], end = begin_[level.places + place + 1];
  for (Index e = begin; e < end; ++e) {
    const NumberedBox<D>& entry = entries_[e];
    const auto test = [&](const NumberedBox<D>& other) {
      if (overlap(entry.box, other.box)) f(entry.number, other.number);
    };
    for (Index other = e + 1; other < end; ++other) test(entries_[other]);
    for_places(level, place + 1, 1, test);
    for (const Index row : level.rows) for_places(level, place + row - 1, 3, test);
    for (std::size_t coarser = number + 1; coarser < levels_.size(); ++coarser) {
      for_overlapping(levels_[coarser], entry.box, [&](Index other) { f(entry.number, other); });
    }
  }
}

template <int D>
template <class F>
void BoxGrid<D>::for_pairs(F&& f) const {
  for (std::size_t number = 0; number < levels_.size(); ++number) {
    const Level& level = levels_[number];
    for (Index place = 0; place <= level.mask; ++place) {
      if (begin_[level.places + place] != begin_[level.places + place + 1])
        for_pairs_in_place(number, place, f);
    }
  }
}

extern template class BoxGrid<2>;
extern template class BoxGrid<3>;

}  // namespace carom
