// Problem: a run has more events than anybody looks at, and each record is large.

#include <carom/integrators/run/packed_events.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstring>
#include <type_traits>

namespace carom {

namespace {

using Word = std::uint64_t;
static_assert(std::is_trivially_copyable_v<EventRecord> && sizeof(EventRecord) % sizeof(Word) == 0);
// Words are compared so many at a time.
constexpr std::size_t group_words = 8;
constexpr std::size_t record_words =
    (sizeof(EventRecord) / sizeof(Word) + group_words - 1) / group_words * group_words;
constexpr std::size_t mask_bits = 64, mask_words = (record_words + mask_bits - 1) / mask_bits;
using Words = std::array<Word, record_words>;

/// Place of a member in a record, in bytes.
template <class T>
std::size_t place_of(const EventRecord& event, const T& member) {
  return static_cast<std::size_t>(reinterpret_cast<const std::byte*>(&member) -
                                  reinterpret_cast<const std::byte*>(&event));
}

/// The words of a record, but for what heads have. Bytes between members are zero, whatever they were.
Words words_of(const EventRecord& event) {
  Words words{};
  auto* const bytes = reinterpret_cast<std::byte*>(words.data());
  std::memcpy(bytes, &event, sizeof event);
  const auto clear = [&](std::size_t begin, std::size_t end) { std::memset(bytes + begin, 0, end - begin); };
  const auto clear_between = [&](const auto& before, const auto& after) {
    clear(place_of(event, before) + sizeof before, place_of(event, after));
  };
  const FeatureKey &a = event.contact.a, &b = event.contact.b;
  clear_between(a.owner, a.serial);
  clear_between(b.owner, b.serial);
  clear_between(event.outcome, event.residual);
  clear_between(event.cut_sequence, event.rolling_moment);
  clear_between(event.directions, event.time);
  clear_between(event.kind, event.velocity_before);
  clear(place_of(event, event.time), place_of(event, event.time) + sizeof event.time);
  clear(place_of(event, event.instant), place_of(event, event.instant) + sizeof event.instant);
  return words;
}

const Words& empty_words() {
  static const Words words = words_of(EventRecord{});
  return words;
}

/// True if so many words are those of an empty record.
bool are_empty(const Word* words, const Word* empty) {
  Word differ = 0;
  for (std::size_t i = 0; i < group_words; ++i) differ |= words[i] ^ empty[i];
  return differ == 0;
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

std::size_t PackedEvents::bytes(std::size_t i) const { return Head::read(places_[i]).size() * sizeof(Word); }

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
  for (std::size_t first = 0; first < record_words; first += group_words) {
    if (are_empty(words.data() + first, empty.data() + first)) continue;
    Word differing = 0;
    for (std::size_t i = first; i < first + group_words; ++i) {
      const bool differs = words[i] != empty[i];
      packed[count] = words[i];
      count += differs ? 1 : 0;
      differing |= Word{differs} << (i - first);
    }
    head.mask[first / mask_bits] |= differing << (first % mask_bits);
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
