// Problem: which of many boxes overlap one that has just changed.

#include <carom/contact/detection/swept_volumes.h>

#include <bit>
#include <cmath>

namespace carom {

void SweptVolumes::start(Index count, double cell) {
  cell_ = cell;
  constexpr unsigned least = 6;  // 2^6 places
  const unsigned bits = std::max(least, static_cast<unsigned>(std::bit_width(2U * count)));
  shift_ = 64 - static_cast<int>(bits);
  table_.resize(std::size_t{1} << bits);
  for (std::vector<Entry>& entries : table_) entries.clear();
  boxes_.assign(count, {});
  cells_.assign(count, {});
  is_set_.assign(count, 0);
  large_.clear();
  active_.clear();
}

/// None of boxes that meet many.
SweptVolumes::Cells SweptVolumes::cells_of(const Box<2>& box) const {
  constexpr double farthest = 1e15;  // numbers of cells are exact up to there
  const double inverse = 1.0 / cell_;
  const double left = std::floor(box.min[0] * inverse), right = std::floor(box.max[0] * inverse);
  const double bottom = std::floor(box.min[1] * inverse), top = std::floor(box.max[1] * inverse);
  const bool near = std::abs(left) < farthest && std::abs(right) < farthest && std::abs(bottom) < farthest &&
                    std::abs(top) < farthest;
  if (!near || (right - left + 1.0) * (top - bottom + 1.0) > static_cast<double>(most_cells)) return {};
  return {static_cast<std::int64_t>(left), static_cast<std::int64_t>(right),
          static_cast<std::int64_t>(bottom), static_cast<std::int64_t>(top)};
}

void SweptVolumes::remove(Index number) {
  const Cells& cells = cells_[number];
  if (is_large(cells)) {
    large_.erase(std::lower_bound(large_.begin(), large_.end(), number));
    return;
  }
  for (std::int64_t row = cells.bottom; row <= cells.top; ++row) {
    for (std::int64_t column = cells.left; column <= cells.right; ++column) {
      std::vector<Entry>& entries = table_[place(column, row)];
      const auto same = [&](const Entry& entry) {
        return entry.number == number && entry.column == column && entry.row == row;
      };
      const auto found = std::find_if(entries.begin(), entries.end(), same);
      *found = entries.back();
      entries.pop_back();
    }
  }
}

void SweptVolumes::set(Index number, const Box<2>& box) {
  const Cells cells = cells_of(box);
  boxes_[number] = box;
  if (is_set_[number] != 0) {
    if (cells == cells_[number]) return;
    remove(number);
  } else {
    is_set_[number] = 1;
    active_.push_back(number);
  }
  cells_[number] = cells;
  if (is_large(cells)) {
    large_.insert(std::lower_bound(large_.begin(), large_.end(), number), number);
    return;
  }
  for (std::int64_t row = cells.bottom; row <= cells.top; ++row) {
    for (std::int64_t column = cells.left; column <= cells.right; ++column) {
      table_[place(column, row)].push_back({number, column, row});
    }
  }
}

}  // namespace carom
