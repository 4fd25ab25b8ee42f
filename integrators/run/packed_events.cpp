// Problem: a run has more events than anybody looks at, and each record is large.

#include <carom/integrators/run/packed_events.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <type_traits>

namespace carom {

namespace {

using Word = std::uint64_t;
static_assert(std::is_trivially_copyable_v<EventRecord> && sizeof(EventRecord) % sizeof(Word) == 0);
constexpr std::size_t record_words = sizeof(EventRecord) / sizeof(Word);
constexpr std::size_t mask_bits = 64, mask_words = (record_words + mask_bits - 1) / mask_bits;
using Words = std::array<Word, record_words>;

/// The words of a record, but for what heads have.
Words words_of(const EventRecord& event) {
  EventRecord rest = event;
  rest.time = 0.0;
  rest.instant = 0;
  Words words;
  std::memcpy(words.data(), &rest, sizeof rest);
  return words;
}

const Words& empty_words() {
  static const Words words = words_of(EventRecord{});
  return words;
}

}  // namespace

/// The first words of a packed record; then come the words that its mask names.
struct PackedEvents::Head {
  double time;
  std::int64_t instant;
  std::array<Word, mask_words> mask;  // bit i: word i is not that of an empty record

  static constexpr std::size_t words = 2 + mask_words;
  [[nodiscard]] static Head read(const Word* packed) {
    Head head;
    std::memcpy(&head, packed, sizeof head);
    return head;
  }
  [[nodiscard]] std::size_t size() const {
    std::size_t count = words;
    for (const Word bits : mask) count += static_cast<std::size_t>(std::popcount(bits));
    return count;
  }
};

double PackedEvents::time(std::size_t i) const { return std::bit_cast<double>(places_[i][0]); }

std::int64_t PackedEvents::instant(std::size_t i) const { return std::bit_cast<std::int64_t>(places_[i][1]); }

void PackedEvents::set_instant(std::size_t i, std::int64_t instant) {
  places_[i][1] = std::bit_cast<Word>(instant);
}

EventRecord PackedEvents::record(std::size_t i) const {
  const Head head = Head::read(places_[i]);
  const Word* next = places_[i] + Head::words;
  Words words = empty_words();
  for (std::size_t m = 0; m < mask_words; ++m) {
    for (Word bits = head.mask[m]; bits != 0; bits &= bits - 1) {
      words[m * mask_bits + static_cast<std::size_t>(std::countr_zero(bits))] = *next++;
    }
  }
  EventRecord event;
  std::memcpy(static_cast<void*>(&event), words.data(), sizeof event);
  event.time = head.time;
  event.instant = head.instant;
  return event;
}

/// Memory for the words of one record: blocks grow with the list, and none is ever copied into another.
Word* PackedEvents::take(std::size_t words) {
  constexpr std::size_t least = 512, most = 32768;
  while (block_ < blocks_.size() && used_ + words > blocks_[block_].size) ++block_, used_ = 0;
  if (block_ == blocks_.size()) {
    const std::size_t size = blocks_.empty() ? least : std::min(2 * blocks_.back().size, most);
    blocks_.push_back({std::make_unique_for_overwrite<Word[]>(size), size});
  }
  Word* const taken = blocks_[block_].words.get() + used_;
  used_ += words;
  return taken;
}

void PackedEvents::pack(const Word* packed, std::size_t words) {
  places_.reserve(places_.size() + 1 > places_.capacity() ? 2 * places_.size() + 8 : places_.size());
  places_.push_back(std::copy_n(packed, words, take(words)) - words);
}

void PackedEvents::append(const EventRecord& event) {
  const Words words = words_of(event);
  const Words& empty = empty_words();
  Head head{event.time, event.instant, {}};
  std::array<Word, Head::words + record_words> packed;
  std::size_t count = Head::words;
  for (std::size_t i = 0; i < record_words; ++i) {
    const bool differs = words[i] != empty[i];
    packed[count] = words[i];
    count += differs ? 1 : 0;
    head.mask[i / mask_bits] |= Word{differs} << (i % mask_bits);
  }
  std::memcpy(packed.data(), &head, sizeof head);
  pack(packed.data(), count);
}

void PackedEvents::append(const PackedEvents& other) {
  for (const Word* const packed : other.places_) pack(packed, Head::read(packed).size());
}

void PackedEvents::order(OrderMemory& memory) {
  const auto earlier = [](const Word* a, const Word* b) {
    return std::bit_cast<double>(a[0]) < std::bit_cast<double>(b[0]);
  };
  if (std::is_sorted(places_.begin(), places_.end(), earlier)) return;
  // Times side by side: records are far apart.
  memory.times.clear();
  for (std::size_t i = 0; i < places_.size(); ++i) memory.times.emplace_back(time(i), i);
  std::sort(memory.times.begin(), memory.times.end());
  memory.ordered.assign(places_.begin(), places_.end());
  for (std::size_t i = 0; i < places_.size(); ++i) places_[i] = memory.ordered[memory.times[i].second];
}

/// Memory is given back when as many are gone as are left.
void PackedEvents::drop_first(std::size_t count) {
  places_.erase(places_.begin(), places_.begin() + static_cast<std::ptrdiff_t>(count));
  dropped_ += count;
  if (dropped_ <= places_.size()) return;
  PackedEvents kept;
  kept.append(*this);
  *this = std::move(kept);
}

void PackedEvents::clear() {
  places_.clear();
  block_ = used_ = dropped_ = 0;
}

}  // namespace carom
