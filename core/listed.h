#pragma once

/// \file
/// Names in a message.

#include <carom/core/export.h>

#include <cstddef>
#include <span>
#include <string>

namespace carom {

/// "disc 'rim', disc #1 and 7 more". \param most names that are written out
[[nodiscard]] CAROM_API std::string listed(std::span<const std::string> names, std::size_t most);

}  // namespace carom
