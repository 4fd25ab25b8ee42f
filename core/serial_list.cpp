#include <carom/core/serial_list.h>

#include <algorithm>
#include <utility>

namespace carom {

Index SerialList::operator[](Index slot) const {
  const auto next =
      std::upper_bound(runs_.begin(), runs_.end(), slot, [](Index s, const Run& r) { return s < r.slot; });
  const Run& run = *(next - 1);
  return run.serial + (slot - run.slot);
}

Index SerialList::find(Index serial) const {
  const auto next = std::upper_bound(runs_.begin(), runs_.end(), serial,
                                     [](Index s, const Run& r) { return s < r.serial; });
  if (next == runs_.begin()) return none;
  const Index slot = (next - 1)->slot + (serial - (next - 1)->serial);
  return slot < (next == runs_.end() ? size_ : next->slot) ? slot : none;
}

void SerialList::push_back(Index serial) {
  if (runs_.empty() || serial != runs_.back().serial + (size_ - runs_.back().slot)) {
    runs_.push_back({size_, serial});
  }
  ++size_;
}

void SerialList::erase(Index slot) {
  SerialList rest;
  for (Index i = 0; i < size_; ++i) {
    if (i != slot) rest.push_back((*this)[i]);
  }
  *this = std::move(rest);
}

}  // namespace carom
