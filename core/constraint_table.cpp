#include <carom/core/constraint_table.h>

#include <bit>
#include <cstdint>

namespace carom {

namespace {

std::uint64_t mixed(std::uint64_t hash, std::uint64_t number) {
  constexpr std::uint64_t odd = 0x9e3779b97f4a7c15;  // without a pattern: 2^64 divided by the golden section
  hash = (hash ^ number) * odd;
  return hash ^ (hash >> 32);
}

std::uint64_t mixed(std::uint64_t hash, const FeatureKey& key) {
  const std::uint64_t owner = static_cast<std::uint64_t>(key.owner) << 56;
  return mixed(hash, owner ^ (std::uint64_t{key.feature} << 32) ^ key.serial);
}

}  // namespace

void ConstraintTable::fill_slots() {
  slots_.assign(std::bit_ceil(2 * keys_.size()), none);
  for (Index i = 0; i < keys_.size(); ++i) slots_[slot_of(keys_[i])] = i;
  filled_ = keys_.size();
}

/// The slot of a key, or the empty one where it would be.
std::size_t ConstraintTable::slot_of(const ConstraintKey& key) const {
  const std::size_t last = slots_.size() - 1;
  std::size_t slot = mixed(mixed(0, key.a), key.b) & last;
  while (slots_[slot] != none && keys_[slots_[slot]] != key) slot = (slot + 1) & last;
  return slot;
}

Index ConstraintTable::find(const ConstraintKey& key) const {
  if (ready_) return slots_[slot_of(key)];
  for (Index i = 0; i < size_; ++i) {
    if (keys_[i] == key) return i;
  }
  return none;
}

}  // namespace carom
