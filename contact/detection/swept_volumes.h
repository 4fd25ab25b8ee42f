#pragma once

/// \file
/// Boxes around what moving bodies cover for a while, each changed on its own, and which of them overlap.
///
/// Bodies have clocks of their own: the volume of one is changed many times while those of all others stay.
/// A grid of one size of cells serves that; each box is listed in all cells that it meets, but for boxes that
/// meet many, which are listed apart. Cells are numbered modulo the size of a table, so space has no bounds.

#include <carom/contact/detection/box.h>
#include <carom/core/export.h>
#include <carom/core/ids.h>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace carom {

/// Boxes by number. Memory grows with the number of cells that they meet at a time.
class CAROM_API SweptVolumes {
public:
  /// Forgets all boxes. \param count numbers are below it \param cell size of cells, > 0 [m]
  void start(Index count, double cell);
  /// Sets the box of a number. \param box min <= max
  void set(Index number, const Box<2>& box);
  /// The box of a number that was set.
  [[nodiscard]] const Box<2>& box(Index number) const { return boxes_[number]; }
  /// Size of cells [m].
  [[nodiscard]] double cell() const { return cell_; }

  /// Calls f(number) once for every other box that overlaps that of a number. Boxes must not be set
  /// meanwhile.
  template <class F>
  void for_overlapping(Index number, F&& f) const;

private:
  // Cells that a box meets, both ends included.
  struct Cells {
    std::int64_t left = 0, right = -1, bottom = 0, top = -1;
    friend bool operator==(const Cells&, const Cells&) = default;
  };
  struct Entry {
    Index number;
    std::int64_t column, row;
  };
  static constexpr std::int64_t most_cells = 64;

  [[nodiscard]] Cells cells_of(const Box<2>& box) const;
  [[nodiscard]] static bool is_large(const Cells& cells) { return cells.right < cells.left; }
  [[nodiscard]] std::size_t place(std::int64_t column, std::int64_t row) const {
    const std::uint64_t mixed = static_cast<std::uint64_t>(column) * 0x9E3779B97F4A7C15ULL +
                                static_cast<std::uint64_t>(row) * 0xC2B2AE3D27D4EB4FULL;
    return static_cast<std::size_t>(mixed >> shift_);
  }
  void remove(Index number);

  double cell_ = 1.0;
  int shift_ = 0;                          // of a hash to a place in the table
  std::vector<std::vector<Entry>> table_;  // 2^k places
  std::vector<Box<2>> boxes_;
  std::vector<Cells> cells_;   // of each box
  std::vector<char> is_set_;   // by number
  std::vector<Index> large_;   // boxes that meet many cells, ascending
  std::vector<Index> active_;  // all that were set, in the order in which they were first
};

template <class F>
void SweptVolumes::for_overlapping(Index number, F&& f) const {
  const Box<2>& box = boxes_[number];
  const auto test = [&](Index other) {
    if (other != number && overlap(boxes_[other], box)) f(other);
  };
  const Cells& own = cells_[number];
  if (is_large(own)) {
    for (const Index other : active_) test(other);
    return;
  }
  for (const Index other : large_) test(other);
  for (std::int64_t row = own.bottom; row <= own.top; ++row) {
    for (std::int64_t column = own.left; column <= own.right; ++column) {
      for (const Entry& entry : table_[place(column, row)]) {
        if (entry.column != column || entry.row != row) continue;
        // Two boxes may meet in several cells: the first one counts.
        const Cells& other = cells_[entry.number];
        if (std::max(own.left, other.left) == column && std::max(own.bottom, other.bottom) == row)
          test(entry.number);
      }
    }
  }
}

}  // namespace carom
