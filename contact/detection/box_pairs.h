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
    count_ = 0;
    begin_.assign(boxes + 1U, 0);
  }
  /// Room for more pairs, to be written in either order of their boxes, each once; take() counts them.
  [[nodiscard]] BoxPair* room(std::size_t more) {
    if (found_.size() < count_ + more) found_.resize(2 * (count_ + more));
    return found_.data() + count_;
  }
  /// Takes the pairs written since room(). \param end after the last
  void take(const BoxPair* end) { count_ = static_cast<std::size_t>(end - found_.data()); }
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
  std::size_t count_ = 0;        // of pairs found
  std::vector<Index> begin_{0};  // of each box: its first partner
  std::vector<Index> partners_;
};

}  // namespace carom
