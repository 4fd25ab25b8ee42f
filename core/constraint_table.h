#pragma once

/// \file
/// Places of constraints by key, found in a time that does not depend on their number.

#include <carom/core/constraint.h>
#include <carom/core/export.h>
#include <carom/core/ids.h>

#include <vector>

namespace carom {

/// A hash table of keys, each with its place in the order in which they were added. Keeps its memory.
class CAROM_API ConstraintTable {
public:
  /// Forgets all keys.
  void clear();
  /// Adds a key that is not among them. find() knows it after finish().
  void add(const ConstraintKey& key) { keys_.push_back(key); }
  /// Makes the keys ready to be found, after the last add().
  void finish();

  /// All, in the order of add().
  [[nodiscard]] const std::vector<ConstraintKey>& keys() const { return keys_; }
  /// Place of a key; `none` if it is not among them.
  [[nodiscard]] Index find(const ConstraintKey& key) const;

private:
  [[nodiscard]] std::size_t slot_of(const ConstraintKey& key) const;

  std::vector<ConstraintKey> keys_;
  std::vector<Index> slots_;  // their number is a power of two; none: empty
};

}  // namespace carom
