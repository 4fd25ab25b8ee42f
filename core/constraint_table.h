#pragma once

/// \file
/// Places of constraints by key, found in a time that does not depend on their number.

#include <carom/core/constraint.h>
#include <carom/core/export.h>
#include <carom/core/ids.h>

#include <cstddef>
#include <vector>

namespace carom {

/// A hash table of keys, each with its place in the order in which they were added. Keeps its memory, and
/// what it knows of the last keys: contacts that last have the same keys step after step.
class CAROM_API ConstraintTable {
public:
  /// Forgets all keys.
  void clear() {
    if (ready_) keys_.swap(keys_of_slots_);
    ready_ = false;
    keys_.clear();
  }
  /// Adds a key that is not among them. find() knows it after finish().
  void add(const ConstraintKey& key) {
    if (ready_) keys_of_slots_.clear();
    ready_ = false;
    keys_.push_back(key);
  }
  /// Makes the keys ready to be found, after the last add().
  void finish() {
    if (keys_.size() <= few || ready_) return;
    if (keys_ != keys_of_slots_) fill_slots();  // what they were filled for is known by the next clear()
    ready_ = true;
  }

  /// All, in the order of add().
  [[nodiscard]] const std::vector<ConstraintKey>& keys() const { return keys_; }
  /// Place of a key; `none` if it is not among them.
  [[nodiscard]] Index find(const ConstraintKey& key) const;
  /// Likewise, sooner where it is at a place that is likely.
  [[nodiscard]] Index find(const ConstraintKey& key, Index likely) const {
    return likely < keys_.size() && keys_[likely] == key ? likely : find(key);
  }

private:
  static constexpr std::size_t few = 8;  // keys that are compared one by one sooner than mixed
  void fill_slots();
  [[nodiscard]] std::size_t slot_of(const ConstraintKey& key) const;

  std::vector<ConstraintKey> keys_;
  std::vector<ConstraintKey> keys_of_slots_;  // for which the slots were filled, unless ready_: keys_
  std::vector<Index> slots_;                  // a power of two of them; none: empty
  bool ready_ = false;                        // the slots are those of keys_
};

}  // namespace carom
