#pragma once

/// \file
/// Places of constraints by key, found in a time that does not depend on their number.

#include <carom/core/constraint.h>
#include <carom/core/export.h>
#include <carom/core/ids.h>

#include <cstddef>
#include <span>
#include <vector>

namespace carom {

/// A hash table of keys, each with its place in the order in which they were added. Keeps its memory, and
/// what it knows of the last keys: contacts that last have the same keys step after step, which are compared
/// as they are added, and nothing else is done.
class CAROM_API ConstraintTable {
public:
  /// Forgets all keys.
  void clear() {
    size_ = 0;
    ready_ = false;
  }
  /// Adds a key that is not among them. find() knows it after finish().
  void add(const ConstraintKey& key) {
    ready_ = false;
    if (size_ < keys_.size()) {
      if (keys_[size_] == key) {
        ++size_;
        return;
      }
      keys_.resize(size_);
      filled_ = 0;
    }
    keys_.push_back(key);
    ++size_;
  }
  /// Makes the keys ready to be found, after the last add().
  void finish() {
    if (keys_.size() > size_) {
      keys_.resize(size_);
      filled_ = 0;
    }
    ready_ = size_ > few;
    if (ready_ && filled_ != size_) fill_slots();
  }

  /// All keys, in the order of add().
  [[nodiscard]] std::span<const ConstraintKey> keys() const { return {keys_.data(), size_}; }
  /// Place of a key; `none` if it is not among them.
  [[nodiscard]] Index find(const ConstraintKey& key) const;
  /// Place of a key; `none` if it is not among them. Faster where the key is at the place `likely`.
  [[nodiscard]] Index find(const ConstraintKey& key, Index likely) const {
    return likely < size_ && keys_[likely] == key ? likely : find(key);
  }

private:
  static constexpr std::size_t few = 8;  // keys that are compared one by one sooner than mixed
  void fill_slots();
  [[nodiscard]] std::size_t slot_of(const ConstraintKey& key) const;

  std::vector<ConstraintKey> keys_;  // behind the first `size_` some that may be added again
  std::size_t size_ = 0;
  std::size_t filled_ = 0;    // so many of keys_ the slots were filled for; 0: for others
  std::vector<Index> slots_;  // a power of two of them; none: empty
  bool ready_ = false;        // the slots are those of keys()
};

}  // namespace carom
