#pragma once

/// \file
/// A list that needs memory only where it is long: for the few things near one body.

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace carom {

/// Up to N things stand in the list itself, more of them on the heap.
template <class T, std::size_t N>
class ShortList {
public:
  /// Makes it `size` members long. Nothing that stood in it is kept.
  void reset(std::size_t size) {
    size_ = size;
    if (size > N) heap_.resize(size);
  }
  /// Appends a member.
  void push_back(const T& value) {
    if (size_ == N) heap_.assign(few_.begin(), few_.end());
    if (size_ < N) {
      few_[size_] = value;
    } else {
      heap_.resize(size_);
      heap_.push_back(value);
    }
    ++size_;
  }
  /// All members.
  [[nodiscard]] std::span<T> all() { return {size_ > N ? heap_.data() : few_.data(), size_}; }
  [[nodiscard]] std::span<const T> all() const { return {size_ > N ? heap_.data() : few_.data(), size_}; }

private:
  std::array<T, N> few_{};
  std::vector<T> heap_;
  std::size_t size_ = 0;
};

}  // namespace carom
