#pragma once

/// \file
/// Names of enumerators by their number, safe for values that are none of them.

#include <array>
#include <cstddef>
#include <string_view>

namespace carom {

/// The name at the place of a value; "unknown" for a value that is no enumerator.
template <std::size_t N, class Enum>
[[nodiscard]] constexpr std::string_view enum_name(const std::array<std::string_view, N>& names, Enum value) {
  const auto place = static_cast<std::size_t>(value);
  return place < N ? names[place] : "unknown";
}

}  // namespace carom
