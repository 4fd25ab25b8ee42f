#pragma once

/// \file
/// A list that is made anew again and again, of elements that cost more to clear than to write.

#include <cstddef>
#include <span>
#include <vector>

namespace carom {

/// Elements in a row, behind which those of longer lists before are kept. Asks for memory where it becomes
/// longer than it ever was.
template <class T>
class KeptList {
public:
  /// Number of elements.
  [[nodiscard]] std::size_t size() const { return count_; }
  /// Forgets all of them, and keeps their memory and what is in it.
  void clear() { count_ = 0; }
  /// One more: as made by default, or as an element of a list before was left. Whoever takes it writes
  /// whatever may differ between the two.
  [[nodiscard]] T& next() {
    if (count_ == elements_.size()) elements_.emplace_back();
    return elements_[count_++];
  }
  /// All elements. Valid until next().
  [[nodiscard]] std::span<T> all() { return std::span(elements_).first(count_); }

private:
  std::vector<T> elements_;
  std::size_t count_ = 0;
};

}  // namespace carom
