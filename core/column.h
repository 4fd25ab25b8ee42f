#pragma once

/// \file
/// One property of many parts. Parts of a kind are often alike: while all values are equal, one value is
/// stored.

#include <carom/core/ids.h>

#include <algorithm>
#include <array>
#include <span>
#include <vector>

namespace carom {

/// Values by slot. `T` is a number or a struct of numbers without padding; values count as equal if all their
/// bits are, so that what comes out is what went in.
template <class T>
class Column {
public:
  /// Number of values.
  [[nodiscard]] Index size() const { return size_; }
  /// True if all values are equal and one is stored.
  [[nodiscard]] bool uniform() const { return values_.empty(); }
  /// Value at a slot.
  [[nodiscard]] const T& operator[](Index slot) const { return uniform() ? common_[0] : values_[slot]; }
  /// Values of neighbouring slots for loops that take them two by two: data()[slot * stride()] and the one
  /// behind it. Uniform columns hold two copies and have stride 0.
  [[nodiscard]] const T* data() const { return uniform() ? common_.data() : values_.data(); }
  /// See data().
  [[nodiscard]] Index stride() const { return uniform() ? 0 : 1; }

  /// Appends a value.
  void push_back(const T& value) {
    if (size_ == 0) common_[0] = common_[1] = value;
    if (uniform() && !same(value, common_[0])) values_.assign(size_, common_[0]);
    ++size_;
    if (!uniform() || !same(value, common_[0])) values_.push_back(value);
  }
  /// Removes a value; later ones move up.
  void erase(Index slot) {
    --size_;
    if (!uniform()) values_.erase(values_.begin() + slot);
  }
  /// Gives back memory that is not in use.
  void shrink() { values_.shrink_to_fit(); }

private:
  static bool same(const T& a, const T& b) {
    const auto first = std::as_bytes(std::span(&a, 1)), second = std::as_bytes(std::span(&b, 1));
    return std::equal(first.begin(), first.end(), second.begin());
  }

  std::vector<T> values_;  // empty while all values are equal
  std::array<T, 2> common_{};
  Index size_ = 0;
};

}  // namespace carom
