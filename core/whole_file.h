#pragma once

/// \file
/// Files read and written as a whole.

#include <carom/core/export.h>

#include <string>
#include <string_view>

namespace carom {

/// The content of a file. Throws FileError "<what> '<path>': cannot be read".
[[nodiscard]] CAROM_API std::string read_file(const std::string& path, std::string_view what);

/// Writes a file; an existing one is replaced only when the new one is complete. Throws FileError
/// "<what> '<path>': cannot be written".
CAROM_API void write_file(const std::string& path, std::string_view content, std::string_view what);

}  // namespace carom
