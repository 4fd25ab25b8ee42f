#pragma once

/// \file
/// A grid with several sizes of cells that finds which boxes overlap.
///
/// Boxes are of all sizes, so one size of cells would put many boxes into one cell or one box into many. Each
/// box stands in one cell of a level whose cells are somewhat larger than it, the cell of its least corner. A
/// box that overlaps it has its corner in the same cell or a neighbour if it is of that level; a smaller box
/// looks up the few cells of each coarser level. Cells are numbered modulo the size of a table, so space has
/// no bounds: boxes far apart may share a place in it, which costs a test and changes nothing.

#include <carom/contact/detection/box.h>
#include <carom/contact/detection/box_pairs.h>
#include <carom/core/export.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace carom {

/// A box with its number and owner.
template <int D>
struct OwnedBox {
  Box<D> box;
  Index number = none;
  Index owner = none;  ///< boxes of the same owner do not pair; `none` owns nothing
};

/// Boxes by cell. Built anew in O(N); keeps its memory.
template <int D>
class CAROM_API BoxGrid {
public:
  /// Takes boxes, in any order. \param boxes finite, min <= max
  void build(std::span<const OwnedBox<D>> boxes);

  /// Adds all pairs of boxes that overlap and have different owners.
  void find_pairs(BoxPairs& out) const;

  /// Calls f(entry) once for every box that overlaps a given one. \param box finite
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

  // \param octaves sizes on one level differ by a factor of up to 2^octaves
  void find_levels(std::span<const OwnedBox<D>> boxes, int octaves);
  // Counts the boxes in each place in `begin_`.
  void find_places(std::span<const OwnedBox<D>> boxes);
  // Makes the counts in `begin_` ends of places. Returns how many boxes are where a box is, on average.
  double end_places();
  static Cell cell_of(const Level& level, const Vec<D>& corner);
  static Index place_of(const Level& level, const Cell& cell);
  // Calls f(from, to) with the ranges of entries in `count` places from one on, which wrap around.
  template <class F>
  void for_places(const Level& level, Index place, Index count, F&& f) const;
  // Cells of a level where boxes that overlap a given one have their least corners.
  struct Cells {
    Cell low, high;
    bool few = true;  // three at most along each axis, whose places differ
  };
  static Cells cells_around(const Level& level, const Box<D>& box);
  // Calls f(row) with the first cell of each row of some cells.
  template <class F>
  static void for_rows(const Cells& cells, F&& f);
  template <class F>
  void for_overlapping(const Level& level, const Box<D>& box, F&& f) const;
  void pair_in_place(const Level& level, Index place, BoxPairs& out) const;
  void pair_with_larger(const OwnedBox<D>& entry, const Level& level, BoxPairs& out) const;

  bool is_crowded_ = false;           // levels of few octaves were needed
  std::vector<Level> levels_;         // of the smallest boxes first
  std::vector<OwnedBox<D>> entries_;  // by level and place
  std::vector<Index> begin_;          // of each place: its first entry
  std::vector<Index> place_;          // of each box, in the order of build()
  std::vector<std::uint8_t> level_;   // of each box, in the order of build()
  std::vector<double> size_;          // of each box, in the order of build() [m]
};

template <int D>
template <class F>
void BoxGrid<D>::for_places(const Level& level, Index place, Index count, F&& f) const {
  const Index* begin = begin_.data() + level.places;
  const Index first = place & level.mask, end = first + count, size = level.mask + 1;
  f(begin[first], begin[std::min(end, size)]);
  if (end > size) f(begin[0], begin[end - size]);
}

template <int D>
template <class F>
void BoxGrid<D>::for_rows(const Cells& cells, F&& f) {
  Cell row = cells.low;
  for (;;) {
    f(row);
    std::size_t k = 1;
    while (k < D && row[k] == cells.high[k]) row[k] = cells.low[k], ++k;
    if (k == D) return;
    ++row[k];
  }
}

template <int D>
template <class F>
void BoxGrid<D>::for_overlapping(const Level& level, const Box<D>& box, F&& f) const {
  const Cells cells = cells_around(level, box);
  const auto test = [&](Index from, Index to) {
    for (Index e = from; e < to; ++e) {
      if (overlap(entries_[e].box, box)) f(entries_[e]);
    }
  };
  const auto columns = static_cast<double>(cells.high[0] - cells.low[0] + 1);
  double rows = 1.0;
  for (std::size_t k = 1; k < D; ++k) rows *= static_cast<double>(cells.high[k] - cells.low[k] + 1);
  const Index entries = begin_[level.places + level.mask + 1] - begin_[level.places];
  // More rows than boxes: each box is tested.
  if (!cells.few && (columns > level.mask || rows > entries))
    return for_places(level, 0, level.mask + 1, test);
  for_rows(cells, [&](const Cell& row) {
    // Rows far from each other may share places: a box counts in the row where it is.
    const auto test_in_row = [&](Index from, Index to) {
      for (Index e = from; e < to; ++e) {
        const Cell at = cell_of(level, entries_[e].box.min);
        const bool here = std::equal(at.begin() + 1, at.end(), row.begin() + 1);
        if (here && overlap(entries_[e].box, box)) f(entries_[e]);
      }
    };
    const auto count = static_cast<Index>(columns);
    if (cells.few) {
      for_places(level, place_of(level, row), count, test);
    } else {
      for_places(level, place_of(level, row), count, test_in_row);
    }
  });
}

extern template class BoxGrid<2>;
extern template class BoxGrid<3>;

}  // namespace carom
