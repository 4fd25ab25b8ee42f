#pragma once

/// \file
/// Memory that is soon to be read or written. Thousands of large structures that are gone through once a
/// stage are in no cache near by when their turn comes, and a loop over them waits for memory more than it
/// computes.

#include <cstddef>
#include <span>

namespace carom {

/// Asks for memory that belongs to an element of a list, unless the list is so small that it is near already.
/// Changes nothing. \param of_list bytes of the list \param first,count the memory that is needed [bytes]
inline void fetch_ahead_of_many([[maybe_unused]] std::size_t of_list, [[maybe_unused]] const void* first,
                                [[maybe_unused]] std::size_t count) {
#if defined(__GNUC__)
  constexpr std::size_t near = std::size_t{1} << 18, line = 64;  // bytes
  if (of_list < near) return;
  const auto* const memory = static_cast<const std::byte*>(first);
#pragma GCC unroll 8
  for (std::size_t i = 0; i < count; i += line) __builtin_prefetch(memory + i);
#endif
}

/// Asks for the memory of an element of a list that no near cache holds as a whole. Changes nothing.
/// \param begin,end bytes of the element that are needed
template <class T>
inline void fetch_ahead([[maybe_unused]] std::span<T> list, [[maybe_unused]] std::size_t place,
                        [[maybe_unused]] std::size_t begin = 0,
                        [[maybe_unused]] std::size_t end = sizeof(T)) {
#if defined(__GNUC__)
  if (place >= list.size()) return;
  const auto* const element = reinterpret_cast<const std::byte*>(list.data() + place);
  fetch_ahead_of_many(list.size_bytes(), element + begin, end - begin);
#endif
}

}  // namespace carom
