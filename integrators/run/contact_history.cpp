#include <carom/integrators/run/contact_history.h>

#include <bit>
#include <cstdint>

namespace carom {

namespace {

std::uint64_t mixed(std::uint64_t hash, std::uint64_t number) {
  constexpr std::uint64_t odd = 0x9e3779b97f4a7c15;  // of no pattern: 2^64 divided by the golden section
  hash = (hash ^ number) * odd;
  return hash ^ (hash >> 32);
}

std::uint64_t mixed(std::uint64_t hash, const FeatureKey& key) {
  hash = mixed(hash, static_cast<std::uint64_t>(key.owner) << 32 | key.serial);
  return mixed(hash, key.feature);
}

}  // namespace

void ContactHistory::start(double step) {
  step_ = step;
  entries_.clear();
  slots_.clear();
}

void ContactHistory::add(const ConstraintKey& key, const std::array<double, 2>& impulse) {
  entries_.push_back({key, impulse});
}

void ContactHistory::finish() {
  if (entries_.empty()) return;
  slots_.assign(std::bit_ceil(2 * entries_.size()), none);
  for (Index i = 0; i < entries_.size(); ++i) slots_[slot_of(entries_[i].key)] = i;
}

/// The place of a key, or the empty one where it would be.
std::size_t ContactHistory::slot_of(const ConstraintKey& key) const {
  const std::size_t last = slots_.size() - 1;
  std::size_t slot = mixed(mixed(0, key.a), key.b) & last;
  while (slots_[slot] != none && entries_[slots_[slot]].key != key) slot = (slot + 1) & last;
  return slot;
}

const ContactHistory::Entry* ContactHistory::find(const ConstraintKey& key) const {
  if (slots_.empty()) return nullptr;
  const Index found = slots_[slot_of(key)];
  return found == none ? nullptr : &entries_[found];
}

}  // namespace carom
