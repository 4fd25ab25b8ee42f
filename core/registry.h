#pragma once

/// \file
/// Storage of the parts of one role: kinds in the order in which they first came, parts of one kind together.

#include <carom/core/ids.h>
#include <carom/core/part_type.h>
#include <carom/core/serial_list.h>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <typeindex>
#include <utility>
#include <vector>

namespace carom {

/// Kinds of one role and the places of their parts. `K` is the interface of the role (BodyKind, ...).
template <class K>
class Registry {
public:
  /// One kind and the serial numbers of its parts, slot by slot; `given` has those of removed parts too.
  struct Entry {
    std::type_index type;
    std::unique_ptr<K> kind;
    SerialList serials;
    SerialList given;
  };
  /// Place of a part.
  struct Place {
    Index entry = none;
    Index slot = none;
  };

  /// Copies own their kinds.
  Registry() = default;
  Registry(const Registry& other) : next_serial_(other.next_serial_) {
    entries_.reserve(other.entries_.size());
    for (const Entry& entry : other.entries_)
      entries_.push_back({entry.type, copy_of(*entry.kind), entry.serials, entry.given});
  }
  Registry(Registry&&) noexcept = default;
  Registry& operator=(Registry other) noexcept {
    std::swap(entries_, other.entries_);
    std::swap(next_serial_, other.next_serial_);
    return *this;
  }
  ~Registry() = default;

  /// Adds a part to the kind of its type, which is made if it is new. A part that the kind refuses changes
  /// nothing.
  void add(const PartType<K>& type, const void* part, const PartCheck& check) {
    const std::type_index kind_type = *type.kind;
    Index at = 0;
    while (at < entries_.size() && entries_[at].type != kind_type) ++at;
    if (at < entries_.size()) {
      type.store(*entries_[at].kind, part, check);
    } else {
      std::unique_ptr<K> kind = type.make_kind();
      type.store(*kind, part, check);
      entries_.push_back({kind_type, std::move(kind), {}, {}});
    }
    entries_[at].serials.push_back(next_serial_);
    entries_[at].given.push_back(next_serial_++);
  }

  /// Serial number the next part will get.
  [[nodiscard]] Index next_serial() const { return next_serial_; }

  /// True if the part was added and not removed.
  [[nodiscard]] bool contains(Index serial) const { return place(serial).slot != none; }
  /// Place of a part; `none` if it is not contained.
  [[nodiscard]] Place place(Index serial) const {
    for (Index entry = 0; entry < entries_.size(); ++entry) {
      const Index slot = entries_[entry].serials.find(serial);
      if (slot != none) return {entry, slot};
    }
    return {};
  }
  /// Kind of a part that is contained or was removed; null if no part ever had this serial number.
  [[nodiscard]] const K* kind_ever(Index serial) const {
    for (const Entry& entry : entries_) {
      if (entry.given.find(serial) != none) return entry.kind.get();
    }
    return nullptr;
  }
  /// Kind of a part that is contained.
  [[nodiscard]] const K& kind_of(Index serial) const { return *entries_[place(serial).entry].kind; }

  /// Removes a part that is contained. Its serial number is not used again.
  void remove(Index serial) {
    const Place at = place(serial);
    entries_[at.entry].kind->remove(at.slot);
    entries_[at.entry].serials.erase(at.slot);
  }

  /// Kinds in the order in which they first came.
  [[nodiscard]] const std::vector<Entry>& entries() const { return entries_; }

  /// Serial numbers of all parts, in the order in which they came.
  [[nodiscard]] std::vector<Index> serials() const {
    std::vector<Index> all;
    for (const Entry& entry : entries_) {
      const auto middle = static_cast<std::ptrdiff_t>(all.size());
      for (Index slot = 0; slot < entry.serials.size(); ++slot) all.push_back(entry.serials[slot]);
      std::inplace_merge(all.begin(), all.begin() + middle, all.end());
    }
    return all;
  }

private:
  // A copy is of the type of the original, also where clone() is that of a wider interface.
  static std::unique_ptr<K> copy_of(const K& kind) {
    return std::unique_ptr<K>(static_cast<K*>(kind.clone().release()));
  }

  std::vector<Entry> entries_;
  Index next_serial_ = 0;
};

}  // namespace carom
