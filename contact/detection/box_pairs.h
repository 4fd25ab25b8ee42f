#pragma once

/// \file
/// Pairs of boxes in order: for each box the partners of a higher number.

#include <carom/contact/detection/box.h>
#include <carom/core/export.h>

#include <algorithm>
#include <span>
#include <vector>

namespace carom {

/// Pairs, collected in any order and then arranged by (first, second). Keeps its memory.
class CAROM_API BoxPairs {
public:
  /// Forgets all pairs. \param boxes how many there are
  void start(Index boxes) {
    found_.clear();
    begin_.assign(boxes + 1U, 0);
  }
  /// Adds the pair of two different boxes, once.
  void add(Index a, Index b) {
    const BoxPair pair{std::min(a, b), std::max(a, b)};
    ++begin_[pair.first];
    found_.push_back(pair);
  }
  /// Arranges what was added since start().
  void arrange();

  /// Number of pairs.
  [[nodiscard]] std::size_t size() const { return partners_.size(); }
  /// Number of boxes.
  [[nodiscard]] Index boxes() const { return static_cast<Index>(begin_.size() - 1); }
  /// Partners of a box that have a higher number, ascending.
  [[nodiscard]] std::span<const Index> partners(Index box) const {
    return {partners_.data() + begin_[box], partners_.data() + begin_[box + 1]};
  }

private:
  std::vector<BoxPair> found_;
  std::vector<Index> begin_{0};  // of each box: its first partner
  std::vector<Index> partners_;
};

}  // namespace carom
