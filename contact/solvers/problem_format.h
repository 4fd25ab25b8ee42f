#pragma once

/// \file
/// Words of the files of contact problems (problem_file.h).

#include <carom/core/row_set.h>

#include <array>
#include <string_view>
#include <utility>

namespace carom::problem_format {

inline constexpr std::string_view label = "contact problem";       ///< in messages
inline constexpr std::string_view name = "carom contact problem";  ///< the format's name, in the file
inline constexpr int version = 1;

/// Names of the sets.
inline constexpr std::array<std::pair<SetKind, std::string_view>, 5> kinds{
    {{SetKind::half_line, "half_line"},
     {SetKind::interval, "interval"},
     {SetKind::bounded_interval, "bounded_interval"},
     {SetKind::bounded_disc, "bounded_disc"},
     {SetKind::proportional, "proportional"}}};

}  // namespace carom::problem_format
