#pragma once

/// \file
/// Storage of the parts of one role: kinds in the order in which they first came, parts of one kind together.

#include <carom/core/ids.h>

#include <memory>
#include <typeindex>
#include <typeinfo>
#include <utility>
#include <vector>

namespace carom {

/// Kinds of one role and the places of their parts. `K` is the interface of the role (BodyKind, ...).
template <class K>
class Registry {
public:
  /// One kind and the serial numbers of its parts, slot by slot.
  struct Entry {
    std::type_index type;
    std::unique_ptr<K> kind;
    std::vector<Index> serials;
  };
  /// Place of a part.
  struct Place {
    Index entry = none;
    Index slot = none;
  };

  Registry() = default;
  Registry(const Registry& other) : places_(other.places_) {
    entries_.reserve(other.entries_.size());
    for (const Entry& entry : other.entries_)
      entries_.push_back({entry.type, entry.kind->clone(), entry.serials});
  }
  Registry(Registry&&) noexcept = default;
  Registry& operator=(Registry other) noexcept {
    std::swap(entries_, other.entries_);
    std::swap(places_, other.places_);
    return *this;
  }
  ~Registry() = default;

  /// Adds a part to the kind of the given type, which is made if it is new. A part that the kind refuses
  /// changes nothing.
  template <class Concrete, class Description, class Check>
  void add(const Description& part, const Check& check) {
    const std::type_index type = typeid(Concrete);
    Index at = 0;
    while (at < entries_.size() && entries_[at].type != type) ++at;
    if (at < entries_.size()) {
      static_cast<Concrete&>(*entries_[at].kind).add(part, check);
    } else {
      auto kind = std::make_unique<Concrete>();
      kind->add(part, check);
      entries_.push_back({type, std::move(kind), {}});
    }
    std::vector<Index>& serials = entries_[at].serials;
    places_.push_back({at, static_cast<Index>(serials.size())});
    serials.push_back(static_cast<Index>(places_.size() - 1));
  }

  /// Serial number the next part will get.
  [[nodiscard]] Index next_serial() const { return static_cast<Index>(places_.size()); }

  /// True if the part was added and not removed.
  [[nodiscard]] bool contains(Index serial) const {
    return serial < places_.size() && places_[serial].slot != none;
  }
  /// Place of a part that is contained.
  [[nodiscard]] Place place(Index serial) const { return places_[serial]; }
  /// Kind of a part that is contained.
  [[nodiscard]] const K& kind_of(Index serial) const { return *entries_[places_[serial].entry].kind; }

  /// Removes a part that is contained. Its serial number is not used again.
  void remove(Index serial) {
    const Place at = places_[serial];
    Entry& entry = entries_[at.entry];
    entry.kind->remove(at.slot);
    entry.serials.erase(entry.serials.begin() + at.slot);
    for (Index slot = at.slot; slot < entry.serials.size(); ++slot) places_[entry.serials[slot]].slot = slot;
    places_[serial] = {};
  }

  /// Kinds in the order in which they first came.
  [[nodiscard]] const std::vector<Entry>& entries() const { return entries_; }

  /// Serial numbers of all parts, in the order in which they came.
  [[nodiscard]] std::vector<Index> serials() const {
    std::vector<Index> all;
    for (Index serial = 0; serial < places_.size(); ++serial) {
      if (contains(serial)) all.push_back(serial);
    }
    return all;
  }

private:
  std::vector<Entry> entries_;
  std::vector<Place> places_;
};

}  // namespace carom
