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
  std::vector<Index> next_begin_, next_partners_;  // of replace()
};

template <class F>
void BoxPairs::replace(const BoxPairs& fresh, F&& is_replaced) {
  next_begin_.resize(begin_.size());
  if (next_partners_.size() < size() + fresh.size()) next_partners_.resize(2 * (size() + fresh.size()));
  Index* to = next_partners_.data();
  const auto place = [&] { return static_cast<Index>(to - next_partners_.data()); };
  for (Index box = 0; box < boxes(); ++box) {
    next_begin_[box] = place();
    const std::span<const Index> added = fresh.partners(box);
    if (is_replaced(box)) {
      to = std::copy(added.begin(), added.end(), to);
      continue;
    }
    auto next = added.begin();
    for (const Index partner : partners(box)) {
      if (is_replaced(partner)) continue;
      while (next != added.end() && *next < partner) *to++ = *next++;
      *to++ = partner;
    }
    to = std::copy(next, added.end(), to);
  }
  next_begin_.back() = place();
  next_partners_.resize(place());
  begin_.swap(next_begin_), partners_.swap(next_partners_);
}

}  // namespace carom
