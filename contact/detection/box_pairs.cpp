#include <carom/contact/detection/box_pairs.h>

#include <cstdint>

namespace carom {

namespace {

// Sorts by insertion, for pairs of which few stand far from their place.
void insert_each(std::span<BoxPair> pairs) {
  const auto rank = [](const BoxPair& pair) { return std::uint64_t{pair.first} << 32U | pair.second; };
  for (std::size_t i = 1; i < pairs.size(); ++i) {
    const BoxPair pair = pairs[i];
    std::size_t to = i;
    for (; to > 0 && rank(pairs[to - 1]) > rank(pair); --to) pairs[to] = pairs[to - 1];
    pairs[to] = pair;
  }
}

}  // namespace

void BoxPairs::arrange() {
  const std::span<BoxPair> found(found_.data(), count_);
  for (BoxPair& pair : found) {
    pair = {std::min(pair.first, pair.second), std::max(pair.first, pair.second)};
    ++begin_[pair.first];
  }
  Index end = 0;
  for (Index& entry : begin_) end += entry, entry = end;
  pairs_.resize(count_);
  for (const BoxPair& pair : found) pairs_[--begin_[pair.first]] = pair;
  // By the first box now.
  constexpr Index few = 16;
  for (std::size_t box = 0; box + 1 < begin_.size(); ++box) {
    if (begin_[box + 1] - begin_[box] > few) {
      std::sort(pairs_.begin() + begin_[box], pairs_.begin() + begin_[box + 1]);
    }
  }
  insert_each(pairs_);
}

}  // namespace carom
