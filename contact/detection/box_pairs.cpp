#include <carom/contact/detection/box_pairs.h>

namespace carom {

namespace {

// Sorts few numbers where they stand.
void sort_few(Index* begin, Index* end) {
  constexpr std::ptrdiff_t few = 16;
  if (end - begin > few) return std::sort(begin, end);
  for (Index* at = begin; at < end; ++at) {
    const Index value = *at;
    Index* to = at;
    for (; to > begin && to[-1] > value; --to) *to = to[-1];
    *to = value;
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
  partners_.resize(count_);
  for (const BoxPair& pair : found) partners_[--begin_[pair.first]] = pair.second;
  for (Index box = 0; box < boxes(); ++box) {
    sort_few(partners_.data() + begin_[box], partners_.data() + begin_[box + 1]);
  }
}

}  // namespace carom
