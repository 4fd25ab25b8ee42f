#include <carom/contact/detection/box_grid.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace carom {

namespace {

// Levels at most. Boxes smaller than the largest by more than 2^63 stand on the last one.
constexpr int most_levels = 64;

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

// floor(log2(x)) of x >= 1, at most that of the last level.
int level_of(double ratio) {
  const int exponent = static_cast<int>(std::bit_cast<std::uint64_t>(ratio) >> 52U) - 1023;
  return std::min(exponent, most_levels - 1);
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
  Index place = static_cast<Index>(cell[0]);
  for (std::size_t k = 1; k < D; ++k) place += static_cast<Index>(cell[k]) * level.stride[k];
  return place & level.mask;
}

template <int D>
void BoxGrid<D>::find_levels(std::span<const NumberedBox<D>> boxes) {
  double largest = 0.0;
  for (const NumberedBox<D>& entry : boxes) largest = std::max(largest, size_of(entry.box));
  if (largest == 0.0) largest = 1.0;  // all boxes at the origin
  std::array<Index, most_levels> count{};
  std::array<double, most_levels> cell{};
  level_.resize(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const double size = size_of(boxes[i].box);
    const auto level = static_cast<std::size_t>(level_of(largest / size));
    level_[i] = static_cast<std::uint8_t>(level);
    cell[level] = std::max(cell[level], size);
    ++count[level];
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
void BoxGrid<D>::place(std::span<const NumberedBox<D>> boxes) {
  place_.resize(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const Level& level = levels_[level_[i]];
    place_[i] = level.places + place_of(level, cell_of(level, boxes[i].box.min));
    ++begin_[place_[i]];
  }
  Index end = 0;
  for (Index& entry : begin_) end += entry, entry = end;
  entries_.resize(boxes.size());
  for (std::size_t i = boxes.size(); i-- > 0;) entries_[--begin_[place_[i]]] = boxes[i];
}

template <int D>
void BoxGrid<D>::build(std::span<const NumberedBox<D>> boxes) {
  find_levels(boxes);
  place(boxes);
}

template class BoxGrid<2>;
template class BoxGrid<3>;

}  // namespace carom
