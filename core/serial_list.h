#pragma once

/// \file
/// Serial numbers of the parts of one kind. They grow with the slot and mostly come in unbroken runs, which
/// is how they are stored.

#include <carom/core/export.h>
#include <carom/core/ids.h>

#include <vector>

namespace carom {

/// An increasing list of serial numbers, by slot.
class CAROM_API SerialList {
public:
  /// Number of serial numbers.
  [[nodiscard]] Index size() const { return size_; }
  /// True if there is none.
  [[nodiscard]] bool empty() const { return size_ == 0; }
  /// Serial number at a slot.
  [[nodiscard]] Index operator[](Index slot) const;
  /// Slot of a serial number, `none` if it is not in the list.
  [[nodiscard]] Index find(Index serial) const;

  /// Appends a serial number greater than all in the list.
  void push_back(Index serial);
  /// Removes a slot; later ones move up.
  void erase(Index slot);

private:
  // The first slot of a run and its serial number.
  struct Run {
    Index slot, serial;
  };
  std::vector<Run> runs_;
  Index size_ = 0;
};

}  // namespace carom
