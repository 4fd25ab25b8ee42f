#pragma once

/// \file
/// Serial numbers of the parts of one kind. They grow with the slot and mostly come in unbroken runs, which
/// is how they are stored.

#include <carom/core/ids.h>

#include <algorithm>
#include <vector>

namespace carom {

/// An increasing list of serial numbers, by slot.
class SerialList {
public:
  /// Number of serial numbers.
  [[nodiscard]] Index size() const { return size_; }
  /// True if there is none.
  [[nodiscard]] bool empty() const { return size_ == 0; }
  /// Serial number at a slot.
  [[nodiscard]] Index operator[](Index slot) const {
    const Run& run = *(
        std::upper_bound(runs_.begin(), runs_.end(), slot, [](Index s, const Run& r) { return s < r.slot; }) -
        1);
    return run.serial + (slot - run.slot);
  }
  /// Slot of a serial number, `none` if it is not in the list.
  [[nodiscard]] Index find(Index serial) const {
    const auto next = std::upper_bound(runs_.begin(), runs_.end(), serial,
                                       [](Index s, const Run& r) { return s < r.serial; });
    if (next == runs_.begin()) return none;
    const Index slot = (next - 1)->slot + (serial - (next - 1)->serial);
    return slot < (next == runs_.end() ? size_ : next->slot) ? slot : none;
  }

  /// Appends a serial number greater than all in the list.
  void push_back(Index serial) {
    if (runs_.empty() || serial != runs_.back().serial + (size_ - runs_.back().slot)) {
      runs_.push_back({size_, serial});
    }
    ++size_;
  }
  /// Removes a slot; later ones move up.
  void erase(Index slot) {
    SerialList rest;
    for (Index i = 0; i < size_; ++i) {
      if (i != slot) rest.push_back((*this)[i]);
    }
    *this = std::move(rest);
  }

private:
  // The first slot of a run and its serial number.
  struct Run {
    Index slot, serial;
  };
  std::vector<Run> runs_;
  Index size_ = 0;
};

}  // namespace carom
