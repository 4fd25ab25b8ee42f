#pragma once

/// \file
/// Places of constraints by key, found in a time that does not depend on their number.

#include <carom/core/constraint.h>
#include <carom/core/export.h>
#include <carom/core/ids.h>

#include <cstddef>
#include <vector>

namespace carom {

/// A hash table of keys, each with its place in the order in which they were added. Keeps its memory.
class CAROM_API ConstraintTable {
public:
  /// Forgets all keys.
  void clear() {
    keys_.clear();
    slots_.clear();
  }
  /// Adds a key that is not among them. find() knows it after finish().
  void add(const ConstraintKey& key) { keys_.push_back(key); }
  /// Makes the keys ready to be found, after the last add().
  void finish() {
    if (keys_.size() > few) fill_slots();
  }

  /// All, in the order of add().
  [[nodiscard]] const std::vector<ConstraintKey>& keys() const { return keys_; }
  /// Place of a key; `none` if it is not among them.
  [[nodiscard]] Index find(const ConstraintKey& key) const;

private:
  static constexpr std::size_t few = 8;  // keys that are compared one by one sooner than mixed
  void fill_slots();
  [[nodiscard]] std::size_t slot_of(const ConstraintKey& key) const;

  std::vector<ConstraintKey> keys_;
  std::vector<Index> slots_;  // a power of two of them, none where keys are few; none: empty
};

}  // namespace carom
