#include <carom/contact/detection/box_grid.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace carom {

namespace {

// Levels at most. Boxes too small for the last one stand on it.
constexpr int most_levels = 32;

// Size of a box [m], but no less than what its coordinates resolve to some digits, so that numbers of cells
// are exact to 2^-12.
template <int D>
double size_of(const Box<D>& box) {
  double size = 0.0, far = 0.0;
  for (int k = 0; k < D; ++k) {
    size = std::max(size, box.max[k] - box.min[k]);
    far = std::max(far, std::max(std::abs(box.min[k]), std::abs(box.max[k])));
  }
  return std::max(size, far * 0x1p-40);
}

// Sizes on one level differ by a factor of up to 2^octaves. Levels are looked up one by one; boxes smaller
// than the cells of their level are tested in vain, which costs less where they are sparse.
constexpr int most_octaves = 8, fewest_octaves = 2;
// Boxes in the place of a box, on average, from which levels are made narrower.
constexpr double crowd = 8.0;

// Level of a box that is smaller than the largest by a ratio >= 1.
int level_of(double ratio, int octaves) {
  const int exponent = static_cast<int>(std::bit_cast<std::uint64_t>(ratio) >> 52U) - 1023;
  return std::min(exponent / octaves, most_levels - 1);
}

// Writes the pairs of a box with some others; returns the end. The loop has no branch, since no prediction
// would hold.
template <int D>
BoxPair* pair_with(const OwnedBox<D>& box, const OwnedBox<D>* from, const OwnedBox<D>* to, BoxPair* out) {
  const unsigned free = as_bit(box.owner == none);
  for (; from < to; ++from) {
    *out = {box.number, from->number};
    const unsigned found = as_bit(overlap(box.box, from->box)) & (free | as_bit(box.owner != from->owner));
    out += found != 0 ? 1 : 0;
  }
  return out;
}

// Places from a row of cells to the next, odd: rows spread over the table without order.
Index stride_of(double share, Index places) { return static_cast<Index>(share * places) | 1U; }

}  // namespace

template <int D>
typename BoxGrid<D>::Cell BoxGrid<D>::cell_of(const Level& level, const Vec<D>& corner) {
  constexpr double last = 0x1p52;  // no box of the level is as far away
  Cell cell;
  for (std::size_t k = 0; k < D; ++k) {
    const double at = std::clamp(corner[static_cast<int>(k)] * level.inverse, -last, last);
    const auto whole = static_cast<std::int64_t>(at);
    cell[k] = whole - (static_cast<double>(whole) > at ? 1 : 0);
  }
  return cell;
}

template <int D>
Index BoxGrid<D>::place_of(const Level& level, const Cell& cell) {
  auto place = static_cast<Index>(cell[0]);
  for (std::size_t k = 1; k < D; ++k) place += static_cast<Index>(cell[k]) * level.stride[k];
  return place & level.mask;
}

template <int D>
void BoxGrid<D>::find_levels(std::span<const OwnedBox<D>> boxes, int octaves) {
  double largest = 0.0, smallest = std::numeric_limits<double>::infinity();
  size_.resize(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    size_[i] = size_of(boxes[i].box);
    largest = std::max(largest, size_[i]), smallest = std::min(smallest, size_[i]);
  }
  if (largest == 0.0) largest = 1.0;  // all boxes at the origin
  std::array<Index, most_levels> count{};
  std::array<double, most_levels> cell{};
  level_.assign(boxes.size(), 0);
  if (level_of(largest / smallest, octaves) == 0) {
    cell[0] = largest, count[0] = static_cast<Index>(boxes.size());
  } else {
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      const double size = size_[i];
      const auto level = static_cast<std::size_t>(level_of(largest / size, octaves));
      level_[i] = static_cast<std::uint8_t>(level);
      cell[level] = std::max(cell[level], size);
      ++count[level];
    }
  }
  levels_.clear();
  std::array<std::uint8_t, most_levels> position{};
  Index places = 0;
  for (std::size_t l = most_levels; l-- > 0;) {
    if (count[l] == 0) continue;
    position[l] = static_cast<std::uint8_t>(levels_.size());
    const Index size = std::max(fewest_places, std::bit_ceil(count[l]));
    Level level;
    // A little more than the largest box: rounding puts no two that overlap farther apart than one cell.
    level.cell = std::max(cell[l] * (1.0 + 0x1p-10), 1e-290), level.inverse = 1.0 / level.cell;
    level.places = places, level.mask = size - 1, level.stride[0] = 1;
    if constexpr (D == 2) {
      level.stride[1] = stride_of(0.6180339887498949, size);
      level.rows = {level.stride[1]};
    } else {
      level.stride[1] = stride_of(0.7548776662466927, size),
      level.stride[2] = stride_of(0.5698402909980532, size);
      const Index y = level.stride[1], z = level.stride[2];
      level.rows = {y, z - y, z, z + y};
    }
    levels_.push_back(level);
    places += size;
  }
  for (std::uint8_t& level : level_) level = position[level];
  begin_.assign(places + 1, 0);
}

template <int D>
void BoxGrid<D>::find_places(std::span<const OwnedBox<D>> boxes) {
  place_.resize(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const Level& level = levels_[level_[i]];
    place_[i] = level.places + place_of(level, cell_of(level, boxes[i].box.min));
    ++begin_[place_[i]];
  }
}

template <int D>
double BoxGrid<D>::end_places() {
  Index end = 0;
  double crowding = 0.0;
  for (Index& entry : begin_) {
    crowding += static_cast<double>(entry) * entry;
    end += entry, entry = end;
  }
  return crowding / static_cast<double>(end);
}

template <int D>
void BoxGrid<D>::build(std::span<const OwnedBox<D>> boxes) {
  find_levels(boxes, is_crowded_ ? fewest_octaves : most_octaves);
  find_places(boxes);
  if (end_places() > crowd && !is_crowded_) {
    is_crowded_ = true;
    find_levels(boxes, fewest_octaves);
    find_places(boxes);
    end_places();
  }
  entries_.resize(boxes.size());
  for (std::size_t i = boxes.size(); i-- > 0;) entries_[--begin_[place_[i]]] = boxes[i];
}

template <int D>
typename BoxGrid<D>::Cells BoxGrid<D>::cells_around(const Level& level, const Box<D>& box) {
  // A box that overlaps has its least corner no farther below this one than it is large. The difference is
  // rounded to the nearest number and cell_of() is monotonic, so no corner is missed.
  const Vec<D> least = box.min.array() - level.cell;
  Cells cells{cell_of(level, least), cell_of(level, box.max)};
  for (std::size_t k = 0; k < D; ++k) cells.few = cells.few && cells.high[k] - cells.low[k] <= 2;
  return cells;
}

template <int D>
void BoxGrid<D>::pair_in_place(const Level& level, Index place, BoxPairs& out) const {
  const Index begin = begin_[level.places + place], end = begin_[level.places + place + 1];
  const OwnedBox<D>* entries = entries_.data();
  const auto pair_all = [&](Index from, Index to) {
    if (from == to) return;
    BoxPair* found = out.room(std::size_t{end - begin} * (to - from));
    for (Index e = begin; e < end; ++e) found = pair_with(entries[e], entries + from, entries + to, found);
    out.take(found);
  };
  for (Index e = begin; e + 1 < end; ++e) {
    out.take(pair_with(entries[e], entries + e + 1, entries + end, out.room(end - e)));
  }
  for_places(level, place + 1, 1, pair_all);
  for (const Index row : level.rows) for_places(level, place + row - 1, 3, pair_all);
}

template <int D>
void BoxGrid<D>::pair_with_larger(const OwnedBox<D>& entry, const Level& level, BoxPairs& out) const {
  const Cells cells = cells_around(level, entry.box);
  const auto count = static_cast<Index>(cells.high[0] - cells.low[0] + 1);
  for_rows(cells, [&](const Cell& row) {
    for_places(level, place_of(level, row), count, [&](Index from, Index to) {
      if (from == to) return;
      out.take(pair_with(entry, entries_.data() + from, entries_.data() + to, out.room(to - from)));
    });
  });
}

template <int D>
void BoxGrid<D>::find_pairs(BoxPairs& out) const {
  for (std::size_t number = 0; number < levels_.size(); ++number) {
    const Level& level = levels_[number];
    for (Index place = 0; place <= level.mask; ++place) {
      if (begin_[level.places + place] != begin_[level.places + place + 1]) pair_in_place(level, place, out);
    }
    for (std::size_t larger = number + 1; larger < levels_.size(); ++larger) {
      for (Index e = begin_[level.places]; e < begin_[level.places + level.mask + 1]; ++e) {
        pair_with_larger(entries_[e], levels_[larger], out);
      }
    }
  }
}

template class BoxGrid<2>;
template class BoxGrid<3>;

}  // namespace carom
