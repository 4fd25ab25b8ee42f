#pragma once

/// \file
/// A list of pairs of boxes in order.

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
  /// Adds a pair of two different boxes, once.
  void add(Index a, Index b) {
    BoxPair* pair = room(1);
    *pair = {a, b};
    take(pair + 1);
  }
  /// Arranges what was added since start().
  void arrange();
  /// Replaces all pairs with at least one of some boxes. \param fresh their pairs, arranged
  /// \param is_replaced is_replaced(box): whether a box is among them
  template <class F>
  void replace(const BoxPairs& fresh, F&& is_replaced);

  /// The pairs that were arranged, sorted by (first, second).
  [[nodiscard]] std::span<const BoxPair> list() const { return pairs_; }

private:
  std::vector<BoxPair> found_;
  std::size_t count_ = 0;        // of pairs found
  std::vector<Index> begin_{0};  // of each box: its first pair
  std::vector<BoxPair> pairs_;
  std::vector<BoxPair> next_;  // of replace()
};

template <class F>
void BoxPairs::replace(const BoxPairs& fresh, F&& is_replaced) {
  const std::span<const BoxPair> added = fresh.list();
  next_.resize(std::max(next_.size(), pairs_.size() + added.size()));
  BoxPair* to = next_.data();
  auto next = added.begin();
  for (const BoxPair& pair : pairs_) {
    if (is_replaced(pair.first) || is_replaced(pair.second)) continue;
    while (next != added.end() && *next < pair) *to++ = *next++;
    *to++ = pair;
  }
  to = std::copy(next, added.end(), to);
  next_.resize(static_cast<std::size_t>(to - next_.data()));
  pairs_.swap(next_);
}

}  // namespace carom
